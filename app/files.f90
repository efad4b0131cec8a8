!> The files of a case: their names, previous results in their place, and writing them; and the
!> plain numbers of `--print`
module vcor_app_files
   use, intrinsic :: iso_fortran_env, only : error_unit, int64
   use vcor_app_cli, only : request_t
   use vcor_case_case, only : case_t
   use vcor_case_grid, only : grid_t
   use vcor_error, only : error_file, error_t, error_usage, raise
   use vcor_io_csv, only : write_csv, write_rows
   use vcor_io_file, only : write_stdout
   use vcor_io_hdf5, only : write_hdf5
   use vcor_io_hdf5_reader, only : close_hdf5, find_dataset, open_hdf5, reader_t
   use vcor_io_identity, only : check_same, identity_t, read_csv, read_identity
   use vcor_io_path, only : directory_exists, folder_of, join_path, make_directory, &
      plain_file_exists, quoted_path
   use vcor_io_table, only : place_in_table, table_t
   use vcor_sweep_part, only : new_part, part_t
   use vcor_sweep_quantity, only : quantities
   use vcor_text, only : integer_text, name_flaw, printable
   implicit none
   private

   public :: files_t, name_files, write_files, write_numbers
   public :: previous_t, find_previous, check_finished, check_columns, replacement_note, remark

   !> Length of the longest ending
   integer, parameter :: longest_ending = 24
   !> Endings of the file names of run
   character(len=*), parameter :: run_endings(3) = [character(len=longest_ending) :: &
      '_summary.csv', '.csv', '.h5']
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
      !> Whether a time history is written
      logical :: history = .true.
   contains
      procedure :: name, written, directory
   end type files_t

   !> Existing results
   type :: previous_t
      !> Whether there are any
      logical :: exist = .false.
      !> Whether there is an HDF5 file
      logical :: has_hdf5 = .false.
      !> File that was examined
      character(len=:), allocatable :: path
      !> Difference from the identity of the run; unallocated if they agree
      type(error_t), allocatable :: objection
   end type previous_t

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
   subroutine name_files(request, case, grid, is_alone, files, part, error)
      type(request_t), intent(in) :: request
      !> A case that was read
      type(case_t), intent(in) :: case
      !> Its points
      type(grid_t), intent(in) :: grid
      !> Whether it is the only case
      logical, intent(in) :: is_alone
      type(files_t), intent(out) :: files
      !> Points to solve: all, or those of --shard
      type(part_t), intent(out) :: part
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: directory, stem
      logical :: csv, hdf5

      call case%get('output', 'directory', directory)
      if (allocated(request%directory)) directory = request%directory
      call case%get('output', 'stem', stem)
      call check_name(case, 'directory', directory, error)
      if (.not. allocated(error)) call check_name(case, 'stem', stem, error)
      if (.not. allocated(error)) call take_shard(request, case, grid, part, error)
      if (allocated(error)) return
      files%path = join_path(directory, stem)
      call case%get('output', 'csv', csv)
      call case%get('output', 'hdf5', hdf5)
      call case%get('output', 'history', files%history)
      ! only a single impact has a time history
      files%history = files%history .and. size(grid%axes) == 0
      if (request%command == 'material') then
         files%endings = material_endings
         files%writes = [csv, csv, csv, hdf5]
      else
         files%endings = run_endings
         files%writes = [csv, csv .and. files%history, hdf5]
      end if
      ! plain numbers are for scripts, which do not expect files
      if (size(request%names) > 0 .and. .not. allocated(request%directory)) files%writes = .false.
      if (request%command == 'verify') files%writes = .false.
      files%history = files%history .and. any(files%writes)
      ! the file that vcor merge reads
      if (request%shards > 0) files%writes = [.false., .false., .true.]
      if (is_alone) call take_file_name(request, files)
      if (request%shards > 0) files%path = files%path//'_shard_'//integer_text(request%shard) &
         //'_of_'//integer_text(request%shards)
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

   !> Determine the part of the sweep from --shard
   subroutine take_shard(request, case, grid, part, error)
      type(request_t), intent(in) :: request
      type(case_t), intent(in) :: case
      type(grid_t), intent(in) :: grid
      type(part_t), intent(out) :: part
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      part = new_part(grid%count(), max(1, request%shard), max(1, request%shards))
      if (request%shards == 0) return
      if (size(grid%axes) == 0) then
         call raise(error, error_usage, '--shard takes a part of a sweep, but ' &
            //case%source//' has no &sweep group')
      else if (request%shards > part%points) then
         call raise(error, error_usage, '--shard: found '//integer_text(request%shard)//'/' &
            //integer_text(request%shards)//', but '//case%source//' has ' &
            //integer_text(part%points)//' points; expected no more shards than points')
      end if
   end subroutine take_shard

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

   !> Write the files of a case: a CSV file per table, then all tables as HDF5, which comes last
   !> because it marks complete results
   subroutine write_files(files, tables, lines, error, data, threads)
      type(files_t), intent(in) :: files
      !> Tables in the order of the files, shape (n)
      type(table_t), intent(in) :: tables(:)
      !> Written files, one per line of the screen
      character(len=:), allocatable, intent(out) :: lines
      type(error_t), allocatable, intent(out) :: error
      !> Check sum of the data files of the case, for `--resume`
      character(len=*), intent(in), optional :: data
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
         call write_hdf5(files%name(i), tables, error, data)
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

   !> Find existing results
   subroutine find_previous(files, expected, previous)
      type(files_t), intent(in) :: files
      !> Their expected identity
      type(identity_t), intent(in) :: expected
      type(previous_t), intent(out) :: previous

      type(identity_t) :: identity
      type(error_t), allocatable :: damage
      integer :: i

      ! HDF5 first; the history adds no information
      do i = 3, 1, -2
         previous%path = files%name(i)
         if (files%writes(i)) previous%exist = plain_file_exists(previous%path)
         if (previous%exist) exit
      end do
      if (.not. previous%exist) return
      previous%has_hdf5 = i == 3
      if (previous%has_hdf5) then
         call read_identity(previous%path, identity, damage)
      else
         call read_csv(previous%path, identity)
         identity%data = expected%data
      end if
      if (identity%version /= '') then
         call check_same(previous%path, identity, expected, previous%objection)
      else
         call raise(previous%objection, error_file, quoted_path(previous%path) &
            //' is not a file of results of vcor')
         if (allocated(damage)) previous%objection%message = previous%objection%message//' (' &
            //damage%message//')'
      end if
   end subroutine find_previous

   !> With --resume, find whether the results are complete, so that nothing remains to do
   subroutine check_finished(request, files, previous, points, is_finished, error)
      type(request_t), intent(in) :: request
      type(files_t), intent(in) :: files
      type(previous_t), intent(in) :: previous
      !> Number of points of the results
      integer, intent(in) :: points
      logical, intent(out) :: is_finished
      !> With --resume, an error if the results have another identity
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: text

      is_finished = .false.
      if (.not. request%resume .or. .not. previous%exist) return
      if (allocated(previous%objection)) then
         error = previous%objection
         return
      end if
      is_finished = is_whole(files, previous, points)
      if (.not. is_finished) return
      text = quoted_path(previous%path)//' is finished, there is nothing to resume'
      if (size(request%names) > 0) then
         call remark(text)
      else if (.not. request%quiet) then
         call write_stdout(text//new_line('a'), error)
      end if
   end subroutine check_finished

   !> Whether all files exist and the CSV files have all their rows
   function is_whole(files, previous, points)
      type(files_t), intent(in) :: files
      !> Existing results of this case
      type(previous_t), intent(in) :: previous
      !> Number of points of the results
      integer, intent(in) :: points
      !> Whether the results are complete
      logical :: is_whole

      type(identity_t) :: identity
      type(reader_t) :: reader
      type(error_t), allocatable :: error
      integer(int64) :: ignored
      integer :: expected, rows

      is_whole = .not. files%writes(3)
      if (previous%has_hdf5) then
         call check_columns(previous%path, error)
         is_whole = .not. allocated(error)
      end if
      if (is_whole .and. files%writes(1)) then
         call read_csv(files%name(1), identity, rows)
         is_whole = rows == points
      end if
      if (.not. (is_whole .and. files%writes(2))) return
      call read_csv(files%name(2), identity, rows)
      is_whole = rows > 0
      if (.not. previous%has_hdf5) return
      call open_hdf5(reader, previous%path, error)
      if (.not. allocated(error)) &
         call find_dataset(reader, 'history/time', expected, ignored, error)
      call close_hdf5(reader)
      is_whole = .not. allocated(error)
      if (is_whole) is_whole = rows == expected
   end function is_whole

   !> Refuse results without the columns of this version
   subroutine check_columns(path, error)
      !> Path of the HDF5 file
      character(len=*), intent(in) :: path
      !> Error of code `error_file`, unallocated if all columns are there
      type(error_t), allocatable, intent(out) :: error

      type(reader_t) :: reader
      integer(int64) :: ignored
      integer :: i, rows

      call open_hdf5(reader, path, error)
      associate (list => quantities())
         do i = 1, size(list)
            if (.not. allocated(error)) &
               call find_dataset(reader, 'summary/'//trim(list(i)%name), rows, ignored, error)
         end do
      end associate
      call close_hdf5(reader)
      if (allocated(error)) error%message = error%message//'; the file is damaged, or of an ' &
         //'earlier version of vcor'
   end subroutine check_columns

   !> Note about results that are replaced
   function replacement_note(previous) result(text)
      type(previous_t), intent(in) :: previous
      !> The note; empty if no other results are replaced
      character(len=:), allocatable :: text

      text = ''
      if (allocated(previous%objection)) text = 'replaced: '//previous%objection%message
   end function replacement_note

   !> Write a note to stderr
   subroutine remark(text)
      !> The note; ignored if empty
      character(len=*), intent(in) :: text

      if (len(text) == 0) return
      write (error_unit, '(a)') 'vcor: note: '//text
   end subroutine remark

end module vcor_app_files
