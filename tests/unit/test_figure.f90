!> Figures: contours, labels, the text of scripts, and reading the files that they are made of
program test_figure
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only : c_associated
   use vcor_error, only : error_file, error_input, error_t
   use vcor_figure_label, only : is_geometric, number_text, parameter_label, quantity_label, &
      suit_unit, with_unit
   use vcor_io_table, only : add_column, add_dimension, add_fact, column_of, &
      integer_column, new_table, real_column, table_t, text_column, text_value
   use vcor_io_figure, only : add_curve, add_note, figure_t, line_ghost, line_solid, new_figure, &
      note_right, note_top, plain
   use vcor_io_file, only : write_file
   use vcor_io_gnuplot, only : data_text, script_text
   use vcor_io_gnuplot_axis, only : in_quotes, number
   use vcor_io_hdf5, only : write_hdf5
   use vcor_io_hdf5_reader, only : close_hdf5, dataset_t, list_members, member_t, &
      number_attribute, open_hdf5, read_column, read_dataset, reader_t, text_attribute
   use vcor_text, only : integer_text
   use vcor_io_path, only : join_path, quoted_path
   use vcor_io_posix, only : c_mkdtemp, c_text
   use vcor_kinds, only : wp
   use vcor_numeric_contour, only : find_loops, loop_t
   use vcor_test, only : check, check_close, check_contains, check_relative, check_text, finish, &
      suite
   implicit none

   !> What rounding leaves of sums of some hundred terms
   real(wp), parameter :: rounding = 1.0e-12_wp
   !> Folder for the files of this test, removed at its end
   character(len=:), allocatable :: folder

   call suite('figure')
   call make_folder()
   call test_plane()
   call test_circle()
   call test_hole()
   call test_saddle()
   call test_nesting()
   call test_units()
   call test_numbers()
   call test_labels()
   call test_quotes()
   call test_script()
   call test_reading()
   call test_what_is_no_file()
   call execute_command_line('rm -rf '//quoted_path(folder))
   call finish()

contains

   !> A folder of our own
   subroutine make_folder()
      character(len=1000) :: parent
      character(len=:), allocatable :: template
      integer :: status

      call get_environment_variable('TMPDIR', parent, status=status)
      if (status /= 0 .or. len_trim(parent) == 0) parent = '/tmp'
      template = c_text(join_path(parent, 'vcor figure XXXXXX'))
      call check(c_associated(c_mkdtemp(template)), 'the folder of the test can be made')
      folder = template(:len(template) - 1)
   end subroutine make_folder

   !> Contours of a plane are straight: the area above one is that of a trapezoid
   subroutine test_plane()
      type(loop_t), allocatable :: loops(:)
      real(wp) :: x(4), y(3), z(4, 3)
      integer :: i, j

      x = [0.0_wp, 1.0_wp, 3.0_wp, 4.0_wp]
      y = [0.0_wp, 0.5_wp, 2.0_wp]
      do j = 1, 3
         do i = 1, 4
            z(i, j) = x(i) + y(j)
         end do
      end do
      call find_loops(x, y, z, 2.5_wp, loops)
      call check(size(loops) == 1, 'one line around what is above a plane')
      ! x + y >= 2.5: the rectangle of 8 without the trapezoid with the sides 2.5 and 0.5, 2 high
      call check_relative(loops(1)%area, 8.0_wp - 0.5_wp*(2.5_wp + 0.5_wp)*2.0_wp, rounding, &
         'area above the plane')
      do i = 1, size(loops(1)%x)
         if (loops(1)%on_edge(i)) cycle
         call check_relative(loops(1)%x(i) + loops(1)%y(i), 2.5_wp, rounding, &
            'points of the line are at the level')
      end do
      call find_loops(x, y, z, -huge(1.0_wp), loops)
      call check(size(loops) == 1, 'one line around the whole map')
      call check_relative(loops(1)%area, 8.0_wp, rounding, 'area of the map')
      call check(all(loops(1)%on_edge), 'that line is the edge')
      call find_loops(x, y, z, 6.5_wp, loops)
      call check(size(loops) == 0, 'no line above everything')
   end subroutine test_plane

   !> Grid of a function of the distance from the middle
   subroutine make_bowl(n, x, z)
      !> Points along a side
      integer, intent(in) :: n
      !> Coordinates from -1 to 1, the same in both directions
      real(wp), allocatable, intent(out) :: x(:)
      !> The distance squared
      real(wp), allocatable, intent(out) :: z(:, :)

      integer :: i, j

      x = [(-1.0_wp + 2.0_wp*real(i - 1, wp)/real(n - 1, wp), i=1, n)]
      allocate (z(n, n))
      do j = 1, n
         do i = 1, n
            z(i, j) = x(i)**2 + x(j)**2
         end do
      end do
   end subroutine make_bowl

   !> A circle comes out with an error of second order; its inside is an outside here
   subroutine test_circle()
      type(loop_t), allocatable :: loops(:)
      real(wp), allocatable :: x(:), z(:, :)
      real(wp) :: error(2), outer, inner
      real(wp), parameter :: pi = acos(-1.0_wp), radius = 0.7_wp
      integer :: k

      do k = 1, 2
         call make_bowl(20*k + 1, x, z)
         call find_loops(x, x, z, radius**2, loops)
         call check(size(loops) == 2, 'the edge of the map and the circle')
         outer = maxval(loops%area)
         inner = minval(loops%area)
         call check_relative(outer, 4.0_wp, rounding, 'area within the edge of the map')
         error(k) = abs(-inner - pi*radius**2)
      end do
      ! Linear interpolation of r^2 on an edge is off by at most h^2/4, the line thus by h^2/(8 R),
      ! and the chord of a cell, not longer than sqrt(2) h, by h^2/(4 R); times the circumference
      call check(error(2) < 0.75_wp*pi*0.05_wp**2, 'the circle has the area of a circle')
      call check(error(1)/error(2) > 3.0_wp, 'its error is of second order')
   end subroutine test_circle

   !> What is not finite is a hole, whose edge belongs to the map
   subroutine test_hole()
      type(loop_t), allocatable :: loops(:)
      real(wp) :: x(5), z(5, 5)
      integer :: i

      x = [(real(i, wp), i=0, 4)]
      z = 1.0_wp
      z(3, 3) = ieee_value(1.0_wp, ieee_quiet_nan)
      call find_loops(x, x, z, 0.5_wp, loops)
      call check(size(loops) == 2, 'the edge and the hole')
      call check_relative(maxval(loops%area), 16.0_wp, rounding, 'area with the hole')
      call check(minval(loops%area) < 0.0_wp, 'the hole is enclosed')
      call check(all(loops(1)%on_edge) .and. all(loops(2)%on_edge), 'both are edges')
      z = ieee_value(1.0_wp, ieee_quiet_nan)
      call find_loops(x, x, z, 0.5_wp, loops)
      call check(size(loops) == 0, 'nothing but a hole')
   end subroutine test_hole

   !> In a saddle the mean decides whether two corners are joined
   subroutine test_saddle()
      type(loop_t), allocatable :: loops(:)
      real(wp) :: x(2), z(2, 2)

      x = [0.0_wp, 1.0_wp]
      z = reshape([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [2, 2])
      call find_loops(x, x, z, 0.6_wp, loops)
      call check(size(loops) == 2, 'two corners above the mean are apart')
      call check_relative(sum(loops%area), 0.16_wp, rounding, 'area of two corners')
      call find_loops(x, x, z, 0.4_wp, loops)
      call check(size(loops) == 1, 'two corners below the mean are joined')
      call check_relative(sum(loops%area), 1.0_wp - 0.16_wp, rounding, 'area of what joins them')
   end subroutine test_saddle

   !> The areas of rising levels lie in each other, and the sum of what is between them is the map
   subroutine test_nesting()
      type(loop_t), allocatable :: loops(:)
      real(wp), allocatable :: x(:), z(:, :)
      real(wp) :: above, before
      integer :: i, j, k

      allocate (z(31, 31))
      x = [(real(i, wp)/30.0_wp, i=0, 30)]
      do j = 1, 31
         do i = 1, 31
            z(i, j) = sin(7.0_wp*x(i))*cos(9.0_wp*x(j)) + x(i)*x(j)
         end do
      end do
      before = 1.0_wp
      do k = -9, 18
         call find_loops(x, x, z, 0.1_wp*real(k, wp), loops)
         above = sum(loops%area)
         call check(above <= before + rounding, 'areas fall with the level')
         before = above
      end do
      call check_close(before, 0.0_wp, 0.1_wp, 'little is above the highest level')
   end subroutine test_nesting

   !> Units that suit the numbers
   subroutine test_units()
      call unit_of('s', 1.3e-3_wp, 'ms', 1.0e3_wp)
      call unit_of('s', 7.6e-4_wp, 'ms', 1.0e3_wp)
      call unit_of('s', 7.6e-5_wp, 'µs', 1.0e6_wp)
      call unit_of('s', 2.0_wp, 's', 1.0_wp)
      call unit_of('s', 5000.0_wp, 's', 1.0_wp)
      call unit_of('m', 0.01_wp, 'mm', 1.0e3_wp)
      call unit_of('m', 3.0e-5_wp, 'µm', 1.0e6_wp)
      call unit_of('N', 999.0_wp, 'N', 1.0_wp)
      call unit_of('N', 1000.0_wp, 'kN', 1.0e-3_wp)
      call unit_of('Pa', 6.8e8_wp, 'MPa', 1.0e-6_wp)
      call unit_of('Pa', 2.1e11_wp, 'GPa', 1.0e-9_wp)
      call unit_of('J', 0.793_wp, 'J', 1.0_wp)
      call unit_of('J', 0.0793_wp, 'mJ', 1.0e3_wp)
      call unit_of('J', 3.0e-12_wp, 'pJ', 1.0e12_wp)
      call unit_of('kg', 0.0327_wp, 'g', 1.0e3_wp)
      call unit_of('kg', 4.0_wp, 'kg', 1.0_wp)
      call unit_of('rad/s', 12000.0_wp, 'rad/s', 1.0_wp)
      call unit_of('1', 12000.0_wp, '1', 1.0_wp)
      call unit_of('m', 0.0_wp, 'm', 1.0_wp)
      call unit_of('m', ieee_value(1.0_wp, ieee_quiet_nan), 'm', 1.0_wp)
   end subroutine test_units

   !> Check one unit
   subroutine unit_of(unit, largest, expected, expected_factor)
      !> SI unit
      character(len=*), intent(in) :: unit
      !> Largest number
      real(wp), intent(in) :: largest
      !> Unit that suits it
      character(len=*), intent(in) :: expected
      !> Factor
      real(wp), intent(in) :: expected_factor

      character(len=:), allocatable :: name
      real(wp) :: factor

      call suit_unit(unit, largest, factor, name)
      call check_text(name, expected, 'unit that suits some '//unit)
      call check_relative(factor, expected_factor, rounding, 'factor for '//expected)
   end subroutine unit_of

   !> Numbers as figures show them
   subroutine test_numbers()
      call check_text(number_text(0.43131583_wp, 4), '0.4313', 'four digits')
      call check_text(number_text(1.3415_wp, 2), '1.3', 'two digits')
      call check_text(number_text(4683.55_wp, 4), '4684', 'no decimals')
      call check_text(number_text(600.0_wp, 6), '600', 'zeros before the point stay')
      call check_text(number_text(0.5_wp, 6), '0.5', 'zeros after the point go')
      call check_text(number_text(0.99999_wp, 3), '1', 'rounded up')
      call check_text(number_text(-0.0123_wp, 3), '-0.0123', 'negative')
      call check_text(number_text(1.25e-7_wp, 4), '1.25×10^{-7}', 'small')
      call check_text(number_text(6.0e9_wp, 4), '6×10^{9}', 'large')
      call check_text(number_text(0.0_wp, 4), '0', 'zero')
      call check_text(number_text(ieee_value(1.0_wp, ieee_quiet_nan), 4), 'none', 'no number')
   end subroutine test_numbers

   !> Labels of axes
   subroutine test_labels()
      call check_text(with_unit('time', 'ms'), 'time [ms]', 'label with a unit')
      call check_text(with_unit('ratio', '1'), 'ratio', 'label of a pure number')
      call check_text(parameter_label('sls_rubber.beta'), 'sls rubber beta', 'path of a parameter')
      call check_text(parameter_label('a_rubber_with_a_very_long_name.beta'), 'beta', 'long path')
      call check_text(quantity_label('cor', 'coefficient of restitution, relative velocity'), &
         'coefficient of restitution', 'short label')
      call check_text(quantity_label('cor_sphere', 'coefficient of restitution, sphere alone'), &
         'coefficient of restitution, sphere alone', 'label that the comma belongs to')
      call check_text(quantity_label('my_number', ''), 'my number', 'label without a meaning')
      call check(is_geometric([1.0_wp, 10.0_wp, 100.0_wp]), 'decades are geometric')
      call check(is_geometric([8.0_wp, 4.0_wp, 2.0_wp]), 'falling too')
      call check(.not. is_geometric([1.0_wp, 2.0_wp, 3.0_wp]), 'equal steps are not')
      call check(.not. is_geometric([1.0_wp, 2.0_wp]), 'two values say nothing')
      call check(.not. is_geometric([-1.0_wp, 1.0_wp, -1.0_wp]), 'negative ones are not')
      call check(.not. is_geometric([2.0_wp, 2.0_wp, 2.0_wp]), 'equal ones are not')
   end subroutine test_labels

   !> What others wrote has no meaning to gnuplot
   subroutine test_quotes()
      call check_text(plain('a_b {c} E^2'), 'a\_b \{c\} E\^2', 'marks lose their meaning')
      call check_text(in_quotes('plain'), "'plain'", 'a text in quotes')
      call check_text(in_quotes("it's"), "'it'."//'"'//"'"//'"'//".'s'", 'a quote in quotes')
      call check_text(in_quotes('`ls` $x "y"'), "'"//'`ls` $x "y"'//"'", 'nothing is replaced')
      call check_text(number(0.1_wp + 0.2_wp), '0.3', 'ten digits')
      call check_text(number(ieee_value(1.0_wp, ieee_quiet_nan)), 'NaN', 'no number')
   end subroutine test_quotes

   !> Script and data of a figure
   subroutine test_script()
      type(figure_t) :: figure
      character(len=:), allocatable :: text
      integer :: i

      call new_figure(figure, 'two panels', panels=2, columns=2)
      do i = 1, 20
         call add_curve(figure%panels(1), [0.0_wp, 1.0_wp], [real(i, wp), 0.5_wp], &
            merge(line_ghost, line_solid, i > 10), modulo(i, 8) + 1, title='c'//integer_text(i))
      end do
      call add_curve(figure%panels(2), [1.0_wp, 1000.0_wp], [1.0_wp, 2.0_wp], line_solid, 1)
      figure%panels(1)%x%label = 'time [ms]'
      figure%panels(2)%x%is_log = .true.
      do i = 1, 6
         call add_note(figure%panels(1), note_right, 0.5_wp, real(i, wp), 'note '//integer_text(i))
      end do
      call add_note(figure%panels(2), note_top, 10.0_wp, 0.0_wp, 'here')

      text = script_text(figure, 'name', 'pdf')
      call check_contains(text, new_line('a')//'set terminal pdfcairo', 'the format asked for')
      call check_contains(text, new_line('a')//'# set terminal svg', 'other formats as remarks')
      call check_contains(text, "set output here.'name.pdf'", 'name of the figure')
      call check_contains(text, "data = here.'name.dat'", 'name of the data')
      call check_contains(text, "title 'c20'", 'a curve beyond the first room for them')
      call check_contains(text, 'data index 20 using', 'curves are counted through all panels')
      call check_contains(text, "'note 6'", 'a note beyond the first room for them')
      call check_contains(text, "'here' at first 10.0, graph 1", 'note above a panel')
      call check_contains(text, 'set logscale x', 'logarithmic axis')
      text = data_text(figure)
      call check_contains(text, '# 0: time [ms]', 'head of the first curve')
      call check_contains(text, '# 20: ', 'head of the last curve')
      call check_contains(text, new_line('a')//'1000.0 2.0'//new_line('a'), 'a point')
   end subroutine test_script

   !> What is written to a file is read back
   subroutine test_reading()
      type(table_t) :: summary, history
      type(table_t) :: more
      type(reader_t) :: reader
      type(member_t), allocatable :: members(:)
      type(dataset_t) :: set
      type(error_t), allocatable :: error
      character(len=:), allocatable :: path
      integer :: i

      call new_table(summary, 'summary', 'Stoß', '&case'//new_line('a')//'/')
      call add_dimension(summary, column_of('impact.velocity', [1.0_wp, 2.0_wp], 'm/s', 'velocity'))
      call add_dimension(summary, column_of('sphere.radius', [0.1_wp, 0.2_wp, 0.3_wp], 'm', &
         'radius'))
      call add_column(summary, column_of('cor', [(0.1_wp*real(i, wp), i=1, 6)], '1', 'restitution'))
      call add_column(summary, column_of('steps', [(10*i, i=1, 6)], '1', 'steps'))
      call add_column(summary, column_of('status', [character(len=9) :: 'separated', 'sticks', &
         'α', '', 'x', &
         'y'], '', 'status'))
      call new_table(history, 'history', 'Stoß', '')
      call add_dimension(history, column_of('time', [0.0_wp, 1.0_wp], 's', 'time'))
      call add_column(history, column_of('force', [3.0_wp, 4.0_wp], 'N', 'force'))
      call new_table(more, 'more', 'Stoß', '')
      call add_fact(more, 'contact_time', 1.5e-3_wp, 's', 'contact time')
      call add_dimension(more, column_of('time', [0.0_wp], 's', 'time'))
      call add_column(more, column_of('force', [3.0_wp], 'N', 'force'))
      path = join_path(folder, 'round trip é.h5')
      call write_hdf5(path, [summary, history, more], error)
      call check(.not. allocated(error), 'the file is written')

      call open_hdf5(reader, path, error)
      call check(.not. allocated(error), 'the file is opened')
      call check_text(text_attribute(reader, '/', 'title'), 'Stoß', 'title')
      call check_text(text_attribute(reader, '/', 'case'), '&case'//new_line('a')//'/', 'case')
      call check_text(text_attribute(reader, '/', 'no such'), '', 'attribute that is not there')
      call check_text(text_attribute(reader, '/none', 'title'), '', 'object that is not there')
      call check_relative(number_attribute(reader, 'more', 'contact_time'), 1.5e-3_wp, rounding, &
         'a number as attribute')
      call check(ieee_is_nan(number_attribute(reader, 'more', 'none')), 'no such number')
      call check(ieee_is_nan(number_attribute(reader, 'none', 'none')), 'no such group')

      call list_members(reader, '/', members, error)
      call check(size(members) == 3, 'groups')
      call check(all(members%is_group), 'they are groups')
      call check_text(members(1)%name//' '//members(2)%name, 'summary history', 'in their order')
      call list_members(reader, 'summary', members, error)
      call check(size(members) == 5, 'dimensions and columns')
      call check(.not. any(members%is_group), 'they are no groups')
      call check_text(members(1)%name, 'impact.velocity', 'the first dimension comes first')
      call check_text(members(5)%name, 'status', 'the last column comes last')
      call list_members(reader, 'none', members, error)
      call check(allocated(error), 'no such group')

      call read_dataset(reader, 'summary/sphere.radius', set, error)
      call check(set%is_scale, 'a dimension is a scale')
      call check_text(set%column%unit, 'm', 'its unit')
      call check_text(set%column%long_name, 'radius', 'its meaning')
      call read_dataset(reader, 'summary/cor', set, error)
      call check(.not. set%is_scale .and. set%column%kind == real_column, 'a column of numbers')
      call check(size(set%lengths) == 2, 'a column of two dimensions')
      call check(all(set%lengths == [2, 3]), 'the slowest dimension comes first')
      call check_relative(set%column%reals, [(0.1_wp*real(i, wp), i=1, 6)], rounding, 'values')
      call read_dataset(reader, 'summary/steps', set, error)
      call check(set%column%kind == integer_column, 'a column of whole numbers')
      call check(all(set%column%integers == [(10*i, i=1, 6)]), 'whole numbers')
      call read_dataset(reader, 'summary/status', set, error)
      call check(set%column%kind == text_column, 'a column of text')
      call check_text(text_value(set%column, 2), 'sticks', 'text')
      call check_text(text_value(set%column, 3), 'α', 'text beyond ASCII')
      call check_text(text_value(set%column, 4), '', 'empty text')
      call read_dataset(reader, 'summary/none', set, error)
      call check(allocated(error), 'no such dataset')
      call check_contains(error%message, 'summary/none', 'which is named')

      call read_column(reader, 'summary/cor', real_column, 6, set, error)
      call check_relative(set%column%reals, [(0.1_wp*real(i, wp), i=1, 6)], rounding, 'a column')
      call read_column(reader, 'summary/cor', real_column, 5, set, error)
      call check(allocated(error), 'a column of another length')
      call check_contains(error%message, "found 6 values in 'summary/cor', expected 5", 'lengths')
      call read_column(reader, 'summary/status', integer_column, 6, set, error)
      call check(allocated(error), 'text is no numbers')
      call check_contains(error%message, "'summary/status' cannot be read as numbers", 'text')
      call close_hdf5(reader)
      call close_hdf5(reader)
   end subroutine test_reading

   !> What is no file of results
   subroutine test_what_is_no_file()
      type(error_t), allocatable :: error

      call write_file(join_path(folder, 'text.h5'), 'text', error)
      call refused(join_path(folder, 'text.h5'), error_input, 'no HDF5 file')
      call refused(join_path(folder, 'none.h5'), error_file, 'no such file')
      call refused(folder, error_file, 'directory')
      call refused('', error_file, 'empty')
   end subroutine test_what_is_no_file

   !> Check that a file is refused
   subroutine refused(path, code, says)
      !> Path of the file
      character(len=*), intent(in) :: path
      !> Code of the error
      integer, intent(in) :: code
      !> What the message says
      character(len=*), intent(in) :: says

      type(reader_t) :: reader
      type(error_t), allocatable :: error

      call open_hdf5(reader, path, error)
      call check(allocated(error), 'a file that cannot be opened is refused')
      if (.not. allocated(error)) return
      call check(error%code == code, 'code of the error: '//says)
      call check_contains(error%message, says, 'message of the error')
   end subroutine refused

end program test_figure
