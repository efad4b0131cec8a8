!> The files of a case, and its bare numbers
module vcor_app_files
   use vcor_app_cli, only : request_t
   use vcor_app_job, only : directory_of, job_t
   use vcor_error, only : error_t
   use vcor_io_csv, only : write_csv, write_rows
   use vcor_io_hdf5, only : remark_t, write_hdf5
   use vcor_io_identity, only : identity_t, remarks_of
   use vcor_io_path, only : make_directory
   use vcor_io_table, only : place_in_table, table_t
   use vcor_sweep_points, only : default_threads
   implicit none
   private

   public :: write_files, write_numbers, threads_of

contains

   !> Write the files of a case: a text for each table, and all of them as HDF5. That comes last:
   !> where it is there, all is there
   subroutine write_files(job, tables, files, error, identity, threads)
      type(job_t), intent(in) :: job
      !> Tables in the order of the files, shape (n)
      type(table_t), intent(in) :: tables(:)
      !> What was written, one to a line of the screen
      character(len=:), allocatable, intent(out) :: files
      type(error_t), allocatable, intent(out) :: error
      !> What they are about, where that is more than the case
      type(identity_t), intent(in), optional :: identity
      !> Threads that turn numbers into text, absent: 1
      integer, intent(in), optional :: threads

      type(remark_t) :: remarks(4)
      integer :: i, n

      files = ''
      if (.not. any(job%writes)) return
      call make_directory(directory_of(job), error)
      do i = 1, size(tables)
         if (job%writes(i) .and. .not. allocated(error)) &
            call write_csv(job%file(i), tables(i), error, threads)
      end do
      ! the sum over the data, where there are any
      n = 0
      if (present(identity)) then
         remarks = remarks_of(identity)
         n = merge(1, 0, identity%data /= '')
      end if
      i = size(job%writes)
      if (job%writes(i) .and. .not. allocated(error)) &
         call write_hdf5(job%file(i), tables, error, remarks(:n))
      if (.not. allocated(error)) files = job%written()
   end subroutine write_files

   !> Number of threads of each rank
   function threads_of(request) result(threads)
      type(request_t), intent(in) :: request
      integer :: threads

      threads = request%threads
      if (threads == 0) threads = default_threads()
   end function threads_of

   !> Bare numbers for --print, a line per impact
   subroutine write_numbers(request, summary, error)
      type(request_t), intent(in) :: request
      type(table_t), intent(in) :: summary
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      call write_rows(summary, [(place_in_table(summary, request%names(i)%text), &
         i=1, size(request%names))], error)
   end subroutine write_numbers

end module vcor_app_files
