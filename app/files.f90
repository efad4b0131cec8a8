!> The files of a case: their names, what a killed run has left there, and writing them; and the
!> plain numbers of `--print`
module vcor_app_files
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_app_cli, only : request_t
   use vcor_case_case, only : case_t
   use vcor_case_grid, only : grid_t
   use vcor_error, only : error_t, error_usage, raise
   use vcor_io_csv, only : write_csv, write_rows
   use vcor_io_hdf5, only : write_hdf5
   use vcor_io_path, only : anything_at, directory_exists, folder_of, join_path, make_directory
   use vcor_io_restart, only : raise_unfinished
   use vcor_io_table, only : place_in_table, table_t
   use vcor_text, only : name_flaw, printable
   implicit none
   private

   public :: files_t, name_files, claim_files, write_files, write_numbers, remark

   !> Length of the longest ending
   integer, parameter :: longest_ending = 24
   !> Endings of the file names of run
   character(len=*), parameter :: run_endings(4) = [character(len=longest_ending) :: &
      '_summary.csv', '_bounces.csv', '.csv', '.h5']
   !> Endings of the file names of material
   character(len=*), parameter :: material_endings(4) = [character(len=longest_ending) :: &
      '_material.csv', '_material_relaxation.csv', '_material_dynamic.csv', '_material.h5']

   !> The files of a case
   type :: files_t
      !> Directory and stem
      character(len=:), allocatable :: path
      !> Endings of the names
      character(len=longest_ending), allocatable :: endings(:)
      !> Whether each is written, in the order of `endings`
      logical, allocatable :: writes(:)
      !> Path of the file of an unfinished sweep; empty if there is none
      character(len=:), allocatable :: part
      !> Whether a time history is written, and a table of bounces
      logical :: history = .true.
      logical :: bounces = .false.
   contains
      procedure :: name, written, directory
   end type files_t

contains

   !> Name of a file
   pure function name(self, i)
      class(files_t), intent(in) :: self
      integer, intent(in) :: i
      !> The name; empty if the file is not written
      character(len=:), allocatable :: name

      name = ''
      if (self%writes(i)) name = self%path//trim(self%endings(i))
   end function name

   !> Names of the written files, one per line of the screen
   pure function written(self) result(text)
      class(files_t), intent(in) :: self
      character(len=:), allocatable :: text

      integer :: i

      text = ''
      do i = 1, size(self%endings)
         if (self%writes(i)) text = text//'  written '//self%name(i)//new_line('a')
      end do
   end function written

   !> Find which files a case writes, and where
   subroutine name_files(request, case, grid, is_alone, files, error)
      type(request_t), intent(in) :: request
      !> A case that was read
      type(case_t), intent(in) :: case
      !> Its points
      type(grid_t), intent(in) :: grid
      !> Whether it is the only case
      logical, intent(in) :: is_alone
      type(files_t), intent(out) :: files
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: directory, stem
      integer :: count
      logical :: csv, hdf5

      call case%get('output', 'directory', directory)
      if (allocated(request%directory)) directory = request%directory
      call case%get('output', 'stem', stem)
      call check_name(case, 'directory', directory, error)
      if (.not. allocated(error)) call check_name(case, 'stem', stem, error)
      if (allocated(error)) return
      files%path = join_path(directory, stem)
      call case%get('output', 'csv', csv)
      call case%get('output', 'hdf5', hdf5)
      call case%get('output', 'history', files%history)
      call case%get('impact', 'bounces', count)
      ! only a single impact has a time history and a table of bounces
      files%history = files%history .and. size(grid%axes) == 0
      files%bounces = count > 1 .and. size(grid%axes) == 0
      if (request%command == 'material') then
         files%endings = material_endings
         files%writes = [csv, csv, csv, hdf5]
      else
         files%endings = pack(run_endings, [.true., files%bounces, .true., .true.])
         files%writes = pack([csv, csv, csv .and. files%history, hdf5], &
            [.true., files%bounces, .true., .true.])
      end if
      ! plain numbers are for scripts, which do not expect files
      if (size(request%names) > 0 .and. .not. allocated(request%directory)) files%writes = .false.
      if (request%command == 'verify') files%writes = .false.
      files%history = files%history .and. any(files%writes)
      if (is_alone) call take_file_name(request, files)
      files%part = ''
      if (request%command == 'run' .and. size(grid%axes) > 0 .and. any(files%writes)) &
         files%part = files%path//'.part'
      if (request%resume .and. .not. any(files%writes)) call raise(error, error_usage, &
         '--resume: no file is written that could be resumed; --print needs --output for it')
   end subroutine name_files

   !> Check a name under which files are written
   subroutine check_name(case, key, name, error)
      type(case_t), intent(in) :: case
      !> Key of &output
      character(len=*), intent(in) :: key
      !> Its value, or the option in its place
      character(len=*), intent(in) :: name
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: flaw

      flaw = name_flaw(name)
      if (flaw /= '') call case%refuse('output', key, 1, 'output.'//key//": the name '" &
         //printable(name)//"' "//flaw//', expected another name', error)
   end subroutine check_name

   !> Take the value of --output as the name of the file if a single file is written and the value
   !> has its ending
   subroutine take_file_name(request, files)
      type(request_t), intent(in) :: request
      !> The files; path and ending change
      type(files_t), intent(inout) :: files

      character(len=:), allocatable :: directory, extension, name
      integer :: one, last
      logical :: is_file

      if (.not. allocated(request%directory) .or. count(files%writes) /= 1) return
      one = findloc(files%writes, .true., dim=1)
      extension = trim(files%endings(one)(index(files%endings(one), '.'):))
      directory = folder_of(request%directory)
      name = request%directory(len(directory) + 1:)
      last = len(name) - len(extension)
      is_file = .not. directory_exists(request%directory)
      if (is_file .and. last > 0) is_file = name(last + 1:) == extension
      if (is_file .and. last > 0) then
         files%path = directory//name(:last)
         files%endings(one) = extension
      end if
   end subroutine take_file_name

   !> Directory of the files
   pure function directory(self)
      class(files_t), intent(in) :: self
      !> Its path; empty for the current one
      character(len=:), allocatable :: directory

      integer :: slash

      slash = index(self%path, '/', back=.true.)
      if (slash > 1) slash = slash - 1
      directory = self%path(:slash)
   end function directory

   !> Make sure, before the work begins, that a run may write its files: their folder exists, and no
   !> sweep that writes them is unfinished, or it is to be resumed
   subroutine claim_files(files, resume, unfinished, error)
      type(files_t), intent(in) :: files
      logical, intent(in) :: resume
      !> Whether there is an unfinished sweep to continue
      logical, intent(out) :: unfinished
      !> Error of code `error_file`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      unfinished = .false.
      if (.not. any(files%writes)) return
      if (files%part /= '') unfinished = anything_at(files%part)
      if (unfinished .and. .not. resume) then
         call raise_unfinished(files%part, error)
      else
         call make_directory(files%directory(), error)
      end if
   end subroutine claim_files

   !> Write the files of a case: a CSV file per table, then all tables as HDF5
   subroutine write_files(files, tables, lines, error, threads)
      type(files_t), intent(in) :: files
      !> Tables in the order of the files, shape (n)
      type(table_t), intent(in) :: tables(:)
      !> Written files, one per line of the screen
      character(len=:), allocatable, intent(out) :: lines
      type(error_t), allocatable, intent(out) :: error
      !> Threads that convert numbers to text; absent: 1
      integer, intent(in), optional :: threads

      integer :: i

      lines = ''
      if (.not. any(files%writes)) return
      call make_directory(files%directory(), error)
      do i = 1, size(tables)
         if (files%writes(i) .and. .not. allocated(error)) &
            call write_csv(files%name(i), tables(i), error, threads)
      end do
      i = size(files%writes)
      if (files%writes(i) .and. .not. allocated(error)) &
         call write_hdf5(files%name(i), tables, error)
      if (.not. allocated(error)) lines = files%written()
   end subroutine write_files

   !> Write plain numbers for --print, a line per impact
   subroutine write_numbers(request, summary, error)
      type(request_t), intent(in) :: request
      type(table_t), intent(in) :: summary
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      call write_rows(summary, [(place_in_table(summary, request%names(i)%text), &
         i=1, size(request%names))], error)
   end subroutine write_numbers

   !> Write a note to stderr
   subroutine remark(text)
      !> The note; ignored if empty
      character(len=*), intent(in) :: text

      if (len(text) == 0) return
      write (error_unit, '(a)') 'vcor: note: '//text
   end subroutine remark

end module vcor_app_files
