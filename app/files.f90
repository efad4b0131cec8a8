!> The files of a case, what is in their place before, and its bare numbers
module vcor_app_files
   use, intrinsic :: iso_fortran_env, only : error_unit, int64
   use vcor_app_cli, only : request_t
   use vcor_app_job, only : directory_of, job_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_csv, only : write_csv, write_rows
   use vcor_io_file, only : write_stdout
   use vcor_io_hdf5, only : write_hdf5
   use vcor_io_hdf5_reader, only : close_hdf5, find_dataset, open_hdf5, reader_t
   use vcor_io_identity, only : check_same, identity_t, read_csv, read_identity
   use vcor_io_path, only : make_directory, plain_file_exists, quoted_path
   use vcor_io_table, only : place_in_table, table_t
   use vcor_sweep_quantity, only : quantities
   implicit none
   private

   public :: write_files, write_numbers
   public :: previous_t, find_previous, check_finished, replacement_note, remark

   !> Results that are there
   type :: previous_t
      !> Whether there are any
      logical :: exist = .false.
      !> Whether the HDF5 file is there
      logical :: has_hdf5 = .false.
      !> File that was looked into
      character(len=:), allocatable :: path
      !> Why it is not about the same as the run; unallocated if it is
      type(error_t), allocatable :: objection
   end type previous_t

contains

   !> Write the files of a case: a text for each table, and all of them as HDF5. That comes last:
   !> where it is there, all is there
   subroutine write_files(job, tables, files, error, data, threads)
      type(job_t), intent(in) :: job
      !> Tables in the order of the files, shape (n)
      type(table_t), intent(in) :: tables(:)
      !> What was written, one to a line of the screen
      character(len=:), allocatable, intent(out) :: files
      type(error_t), allocatable, intent(out) :: error
      !> Sum over the data files of the case, for `--resume`
      character(len=*), intent(in), optional :: data
      !> Threads that turn numbers into text, absent: 1
      integer, intent(in), optional :: threads

      integer :: i

      files = ''
      if (.not. any(job%writes)) return
      call make_directory(directory_of(job), error)
      do i = 1, size(tables)
         if (job%writes(i) .and. .not. allocated(error)) &
            call write_csv(job%file(i), tables(i), error, threads)
      end do
      i = size(job%writes)
      if (job%writes(i) .and. .not. allocated(error)) &
         call write_hdf5(job%file(i), tables, error, data)
      if (.not. allocated(error)) files = job%written()
   end subroutine write_files

   !> Bare numbers for --print, a line per impact
   subroutine write_numbers(request, summary, error)
      type(request_t), intent(in) :: request
      type(table_t), intent(in) :: summary
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      call write_rows(summary, [(place_in_table(summary, request%names(i)%text), &
         i=1, size(request%names))], error)
   end subroutine write_numbers

   !> Look for results
   subroutine find_previous(job, expected, previous)
      type(job_t), intent(in) :: job
      !> What they should be about
      type(identity_t), intent(in) :: expected
      type(previous_t), intent(out) :: previous

      type(identity_t) :: identity
      type(error_t), allocatable :: damage
      integer :: i

      ! HDF5 first; a history says nothing that the others do not
      do i = 3, 1, -2
         previous%path = job%file(i)
         if (job%writes(i)) previous%exist = plain_file_exists(previous%path)
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

   !> Whether there is nothing to do: with --resume, where the results are there
   subroutine check_finished(request, job, previous, is_finished, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      type(previous_t), intent(in) :: previous
      logical, intent(out) :: is_finished
      !> With --resume: what is there is about something else
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: text

      is_finished = .false.
      if (.not. request%resume .or. .not. previous%exist) return
      if (allocated(previous%objection)) then
         error = previous%objection
         return
      end if
      is_finished = is_whole(job, previous)
      if (.not. is_finished) return
      text = quoted_path(previous%path)//' is finished, there is nothing to resume'
      if (size(request%names) > 0) then
         call remark(text)
      else if (.not. request%quiet) then
         call write_stdout(text//new_line('a'), error)
      end if
   end subroutine check_finished

   !> Whether all files are there, and the CSV files have all of their rows
   function is_whole(job, previous)
      type(job_t), intent(in) :: job
      !> What is there, about this case
      type(previous_t), intent(in) :: previous
      !> Whether nothing is missing
      logical :: is_whole

      type(identity_t) :: identity
      integer :: rows

      is_whole = .not. job%writes(3)
      ! the summary of an earlier version has fewer columns
      associate (list => quantities())
         if (previous%has_hdf5) is_whole = rows_in(previous%path, 'summary/'//list%name) > 0
      end associate
      if (is_whole .and. job%writes(1)) then
         call read_csv(job%file(1), identity, rows)
         is_whole = rows == job%part%count()
      end if
      if (.not. (is_whole .and. job%writes(2))) return
      call read_csv(job%file(2), identity, rows)
      is_whole = rows > 0
      if (previous%has_hdf5) is_whole = rows == rows_in(previous%path, ['history/time'])
   end function is_whole

   !> Number of rows of a table in an HDF5 file
   function rows_in(path, columns) result(rows)
      character(len=*), intent(in) :: path
      !> Paths of its columns
      character(len=*), intent(in) :: columns(:)
      !> 0 where one of them is missing
      integer :: rows

      type(reader_t) :: reader
      type(error_t), allocatable :: error
      integer(int64) :: ignored
      integer :: i

      rows = 0
      call open_hdf5(reader, path, error)
      do i = 1, size(columns)
         if (.not. allocated(error)) &
            call find_dataset(reader, trim(columns(i)), rows, ignored, error)
      end do
      if (allocated(error)) rows = 0
      call close_hdf5(reader)
   end function rows_in

   !> Nobody's results are replaced in silence
   function replacement_note(previous) result(text)
      type(previous_t), intent(in) :: previous
      !> What there is to say: nothing if there was nothing else
      character(len=:), allocatable :: text

      text = ''
      if (allocated(previous%objection)) text = 'replaced: '//previous%objection%message
   end function replacement_note

   !> One line on stderr that is no error
   subroutine remark(text)
      !> What to say; nothing is fine
      character(len=*), intent(in) :: text

      if (len(text) == 0) return
      write (error_unit, '(a)') 'vcor: note: '//text
   end subroutine remark

end module vcor_app_files
