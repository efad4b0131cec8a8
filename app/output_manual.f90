!> Page of the manual on the output, from the tables of columns, statuses and exit codes
module vcor_app_output_manual
   use vcor_app_markup, only : markup_t, new_page
   use vcor_error, only : code_meanings, code_names
   use vcor_io_number, only : integer_text
   use vcor_sweep_quantity, only : history_quantities, quantities, quantity_t, statuses
   use vcor_version, only : version
   implicit none
   private

   public :: output_manual, put_exit_codes

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Longest text of a cell of a table [characters]
   integer, parameter :: cell = 100

contains

   !> Files that a run writes: their columns, from the tables of quantities, and their form
   subroutine output_manual(page, man)
      !> The page
      type(markup_t), intent(out) :: page
      !> Whether it is for man
      logical, intent(in) :: man

      character(len=cell) :: cells(3)
      integer :: i

      call new_page(page, man, 'vcor-output', '5', 'Output reference', 'result files of vcor', &
         version)
      call page%heading(1, 'Files')
      call page%paragraph('For a case file STEM.nml `vcor run` writes to the current directory, ' &
         //'to `directory` of `&output`, or to `--output DIR`:')
      call page%item('STEM_summary.csv', 'a row per impact with its outcome.')
      call page%item('STEM.csv', 'the time history, of a single impact only.')
      call page%item('STEM.h5', 'both, as HDF5.')
      call page%paragraph('`&output` switches parts off (`csv`, `hdf5`, `history`) and has ' &
         //'another name in place of STEM (`stem`). A file appears under its name only when it ' &
         //'is complete, with the permissions that the umask leaves; until then it is in a ' &
         //'private folder `.vcor-XXXXXX` beside it. A killed run may leave such a ' &
         //'folder, which can be removed. The same case gives the same bytes, whatever the ' &
         //'number of threads.')

      call page%heading(1, 'Summary')
      call page%paragraph('The columns, which are also the names for `--print`. A sweep has its ' &
         //'parameters before them, under their paths (`impact.velocity`, `rubber.beta`: the ' &
         //'name of a material in lower case, with `_` for blanks). Where an impact has no ' &
         //'result its numbers are `nan`.')
      call put_quantities(page, quantities)
      call put_quantity(page, quantity_t('steps', '', '1', 'number of time steps'))
      call put_quantity(page, quantity_t('status', '', '', 'how the contact ended'))
      call page%paragraph('`inelasticity` is 0 without waves and for a modulus that is infinite ' &
         //'at time zero. Below `min_frequency` the material plays no part. `energy_imbalance` ' &
         //'is the initial energy less the energy left to the sphere, `hysteresis_energy` and ' &
         //'`wave_energy`.')
      call page%aside('The two coefficients of restitution are explained with ' &
         //'[plate and contact](impact.md#two-coefficients), their estimated errors with ' &
         //'[solver and accuracy](accuracy.md).')

      call page%heading(1, 'Status')
      call page%table([character(len=cell) :: 'status', 'meaning', 'what to do'])
      do i = 1, size(statuses)
         associate (status => statuses(i))
            if (.not. man) then
               cells(1) = '`'//trim(status%name)//'`'
               cells(2) = status%meaning
               cells(3) = status%advice
               call page%row(cells)
            else if (status%advice == '') then
               call page%item(trim(status%name), trim(status%meaning)//'.')
            else
               call page%item(trim(status%name), trim(status%meaning)//'. What to do: ' &
                  //trim(status%advice)//'.')
            end if
         end associate
      end do

      call page%heading(1, 'History')
      call page%paragraph('A row per time, 501 of them in equal steps (the solver''s own steps ' &
         //'with method `direct`); the largest force among them is a little below `max_force`, ' &
         //'which is the true one.')
      call put_quantities(page, history_quantities)

      call put_csv(page)
      call put_hdf5(page)
      call put_exit_codes(page)
      if (man) then
         call page%heading(1, 'See also')
         call page%paragraph('`vcor`(1), `vcor-input`(5)')
      end if
   end subroutine output_manual

   !> Columns of a file
   subroutine put_quantities(page, list)
      !> The page
      type(markup_t), intent(inout) :: page
      !> The columns, shape (n)
      type(quantity_t), intent(in) :: list(:)

      integer :: i

      call page%table([character(len=cell) :: 'column', 'symbol', 'unit', 'meaning'])
      do i = 1, size(list)
         call put_quantity(page, list(i))
      end do
   end subroutine put_quantities

   !> A column of a file
   subroutine put_quantity(page, quantity)
      !> The page
      type(markup_t), intent(inout) :: page
      !> The column
      type(quantity_t), intent(in) :: quantity

      character(len=:), allocatable :: unit
      character(len=cell) :: cells(4)

      if (page%man) then
         unit = ''
         if (quantity%unit /= '') unit = ' ['//trim(quantity%unit)//']'
         call page%item(trim(quantity%name), trim(quantity%meaning)//unit)
      else
         cells(1) = '`'//trim(quantity%name)//'`'
         cells(2) = quantity%symbol
         cells(3) = quantity%unit
         cells(4) = quantity%meaning
         call page%row(cells)
      end if
   end subroutine put_quantity

   !> Form of the text files
   subroutine put_csv(page)
      !> The page
      type(markup_t), intent(inout) :: page

      call page%heading(1, 'CSV files')
      call page%paragraph('Lines that begin with `#` come first: version, title, the columns ' &
         //'with their units, and the full case with every default, so that a result can be ' &
         //'repeated: what stands after `# case:`, without the first two characters of each ' &
         //'line, is a case file. Then follow one line with the names of the columns and the ' &
         //'rows, separated by commas. Numbers have 17 digits, from which every reader gets the ' &
         //'same bits back, and a decimal point; texts stand in double quotes where they have to.')
      call page%block('python', 'import pandas'//nl//nl &
         //'summary = pandas.read_csv("sls_summary.csv", comment="#")'//nl)
   end subroutine put_csv

   !> Layout of the HDF5 files
   subroutine put_hdf5(page)
      !> The page
      type(markup_t), intent(inout) :: page

      call page%heading(1, 'HDF5 files')
      call page%item('/', 'attributes `program`, `version`, `title` and `case`, the full case as ' &
         //'text.')
      call page%item('/summary', 'a dataset per column of the summary. Those of a single impact ' &
         //'have one element and the dimension `impact`. Those of a sweep have a dimension per ' &
         //'parameter, the first `&sweep` group first, and a dataset of the same name holds its ' &
         //'values: a labelled cube.')
      call page%item('/history', 'a dataset per column of the history, of a single impact only; ' &
         //'the dimension is `time`.')
      call page%paragraph('Every dataset has the attributes `units` (1 for a pure number; none ' &
         //'for texts) and `long_name`. Dimensions are dimension scales, which h5py, xarray ' &
         //'(with h5netcdf), netCDF-4 and h5dump show as named axes. Numbers are binary64 or ' &
         //'32-bit integers, little endian; texts are UTF-8 of variable length. More than 50,000 ' &
         //'numbers most of which repeat the one before are compressed (deflate); as many texts ' &
         //'that are all the same are not stored but read as the fill value of their dataset.')
      call page%block('python', 'import xarray'//nl//nl &
         //'summary = xarray.open_dataset("sls.h5", group="summary", engine="h5netcdf")'//nl)
      call page%paragraph('Behind what HDF5 reads, each file ends with a check sum (CRC-32) of ' &
         //'all its bytes. vcor compares it before it reads anything else: a damaged file is an ' &
         //'error of one line, exit code 4. A program that changes the file, such as h5py, ' &
         //'takes the check sum off. vcor reads such a file too, but then HDF5 is on its own: a ' &
         //'file that somebody has made for the purpose can crash the HDF5 library, or keep it ' &
         //'in an endless loop. Do not open HDF5 files from people you do not trust.')
   end subroutine put_hdf5

   !> Exit codes and where messages go
   subroutine put_exit_codes(page)
      !> The page
      type(markup_t), intent(inout) :: page

      integer :: i

      call page%heading(1, 'Exit status')
      do i = lbound(code_names, 1), ubound(code_names, 1)
         call page%item(integer_text(i), trim(code_names(i))//': '//trim(code_meanings(i))//'.')
      end do
      call page%paragraph('An error is one line on stderr that begins with `vcor: error:`, names ' &
         //'file and line where there is one, and says what was found and what is expected.')
   end subroutine put_exit_codes

end module vcor_app_output_manual
