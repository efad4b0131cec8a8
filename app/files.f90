!> The files of a run, and its bare numbers
module vcor_app_files
   use vcor_app_cli, only : request_t
   use vcor_app_job, only : directory_of, job_t
   use vcor_error, only : error_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_io_csv, only : write_csv, write_rows
   use vcor_io_hdf5, only : remark_t, write_hdf5
   use vcor_io_identity, only : identity_t, remarks_of
   use vcor_io_path, only : make_directory
   use vcor_io_results, only : history_table, write_summary
   use vcor_io_table, only : place_in_table, table_t
   use vcor_sweep_points, only : default_threads
   implicit none
   private

   public :: write_files, write_numbers, threads_of

contains

   !> Write the files of a case
   subroutine write_files(job, identity, summary, trajectory, files, error)
      type(job_t), intent(in) :: job
      !> What it is about
      type(identity_t), intent(in) :: identity
      !> Its outcomes
      type(table_t), intent(in) :: summary
      !> The trajectory of a single impact
      type(trajectory_t), intent(in) :: trajectory
      character(len=:), allocatable, intent(out) :: files
      type(error_t), allocatable, intent(out) :: error

      type(table_t) :: course
      type(remark_t) :: remarks(4)
      integer :: n

      files = ''
      if (.not. any(job%writes)) return
      call make_directory(directory_of(job), error)
      if (allocated(error)) return
      ! the sum over the data, where there are any
      remarks = remarks_of(identity)
      n = merge(1, 0, len(identity%data) > 0)
      if (.not. job%history) then
         call write_summary(job%file(1), job%file(3), summary, remarks(:n), error)
      else
         call history_table(course, summary%title, summary%case_text, trajectory)
         if (job%writes(1)) call write_csv(job%file(1), summary, error)
         if (job%writes(2) .and. .not. allocated(error)) call write_csv(job%file(2), course, error)
         if (job%writes(3) .and. .not. allocated(error)) call write_hdf5(job%file(3), summary, &
            error, remarks(:n), more=[course])
      end if
      if (.not. allocated(error)) files = job%written()
   end subroutine write_files

   !> Number of threads of each rank
   function threads_of(request) result(threads)
      type(request_t), intent(in) :: request
      !> Number, at least 1
      integer :: threads

      threads = request%threads
      if (threads == 0) threads = default_threads()
   end function threads_of

   !> Bare numbers for --print, a line per impact
   subroutine write_numbers(request, summary, error)
      type(request_t), intent(in) :: request
      type(table_t), intent(in) :: summary
      type(error_t), allocatable, intent(out) :: error

      integer :: places(size(request%names)), i

      do i = 1, size(places)
         places(i) = place_in_table(summary, request%names(i)%text)
      end do
      call write_rows(summary, places, error)
   end subroutine write_numbers

end module vcor_app_files
