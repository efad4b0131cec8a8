!> What the first rank has to do for the points that others have solved: take their numbers, keep
!> them in the file of the sweep under way, write both files in the end. Prints microseconds
!>
!>     rank_zero FOLDER
!>
!> With MPI and two ranks also what a message costs.
program rank_zero
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor, only : case_t, checkpoint_t, create_checkpoint, error_t, identity_of, identity_t, &
      join_ranks, leave_ranks, new_part, new_summary, new_sweep, rank_count, read_case_text, &
      remark_t, summary_t, summary_table, sweep_t, table_t, this_rank, wp, write_csv, write_hdf5
   use vcor_sweep_mpi, only : inbox_t, outbox_t, receive_order, send_order
   use vcor_sweep_summary, only : numbers_per_point
   implicit none

   integer, parameter :: points = 2**17
   integer, parameter :: lengths(*) = [16, 128, 1024, 8192]
   character(len=*), parameter :: lf = new_line('a')
   character(len=*), parameter :: text = "&impact velocity = 5.0 /"//lf &
      //"&sphere radius = 0.01, material = 'steel' /"//lf &
      //"&plate half_thickness = 0.02, material = 'rubber' /"//lf &
      //"&material name = 'steel', model = 'rigid', density = 7800.0 /"//lf &
      //"&material name = 'rubber', model = 'sls', density = 1100.0, poisson_ratio = 0.5," &
      //" glassy_modulus = 15.0e6, alpha = 300.0, beta = 1200.0 /"//lf &
      //"&sweep parameter = 'impact.velocity', start = 1, stop = 50, count = 131072 /"//lf
   character(len=200) :: folder

   call get_command_argument(1, folder)
   call join_ranks()
   if (rank_count() > 1) then
      call measure_messages()
   else
      call measure_files(trim(folder))
   end if
   call leave_ranks()

contains

   !> Time by the clock on the wall [s]
   function seconds()
      !> Time since some moment
      real(wp) :: seconds
      integer(int64) :: count, rate

      call system_clock(count, rate)
      seconds = real(count, wp)/real(rate, wp)
   end function seconds

   !> End if there is an error
   subroutine need(error)
      !> The error
      type(error_t), allocatable, intent(in) :: error

      if (.not. allocated(error)) return
      print '(a)', 'rank_zero: '//error%message
      error stop 1
   end subroutine need

   !> Numbers taken and kept, and both files
   subroutine measure_files(folder)
      !> Where the files go
      character(len=*), intent(in) :: folder
      type(case_t) :: case
      type(sweep_t) :: sweep
      type(identity_t) :: identity
      type(summary_t) :: summary
      type(checkpoint_t) :: file
      type(table_t) :: table
      type(remark_t) :: none(0)
      type(error_t), allocatable :: error
      real(wp), allocatable :: numbers(:, :)
      real(wp) :: start, taken, kept
      integer :: i, k, n

      call read_case_text(case, text, 'case', error)
      call need(error)
      call case%validate(error)
      call need(error)
      call new_sweep(sweep, case, error)
      call need(error)
      identity = identity_of(case, new_part(points, 1, 1))
      call new_summary(summary, points, error)
      call need(error)
      call create_checkpoint(file, folder//'/rank_zero.part.h5', identity, sweep%grid, summary, &
         error)
      call need(error)
      do k = 1, size(lengths)
         n = lengths(k)
         allocate (numbers(n, numbers_per_point))
         call random_number(numbers)
         numbers(:, numbers_per_point - 1:) = 0.0_wp
         taken = 0.0_wp
         kept = 0.0_wp
         do i = 1, points, n
            start = seconds()
            call summary%unpack(i, numbers)
            taken = taken + seconds() - start
            start = seconds()
            call file%put(i, i + n - 1, summary, error)
            kept = kept + seconds() - start
            call need(error)
         end do
         print '(a, i0, 2(a, f0.4))', 'chunk of ', n, ': take ', 1.0e6_wp*taken/points, &
            ', keep ', 1.0e6_wp*kept/points
         deallocate (numbers)
      end do
      call file%remove()
      call summary_table(table, '', identity%case_text, sweep%grid, summary)
      start = seconds()
      call write_csv(folder//'/rank_zero.csv', table, error)
      call need(error)
      print '(a, f0.4)', 'csv ', 1.0e6_wp*(seconds() - start)/points
      start = seconds()
      call write_hdf5(folder//'/rank_zero.h5', table, error=error, remarks=none)
      call need(error)
      print '(a, f0.4)', 'hdf5 ', 1.0e6_wp*(seconds() - start)/points
   end subroutine measure_files

   !> Chunks given out and results received
   subroutine measure_messages()
      type(inbox_t) :: inbox
      type(outbox_t) :: outbox
      real(wp), allocatable :: numbers(:)
      real(wp) :: start
      integer, parameter :: chunks = 2000
      integer :: i, k, order(2)
      logical :: has_arrived

      do k = 1, size(lengths)
         start = seconds()
         do i = 1, chunks
            if (this_rank() == 0) then
               call send_order([i, i], 1)
               do
                  call inbox%look(1, has_arrived)
                  if (has_arrived) exit
               end do
            else if (this_rank() == 1) then
               call receive_order(order)
               call outbox%finish()
               allocate (numbers(lengths(k)*numbers_per_point), source=0.0_wp)
               call outbox%post(numbers)
            end if
         end do
         call outbox%finish()
         if (this_rank() == 0) print '(a, i0, a, f0.4)', 'message of ', lengths(k), ': ', &
            1.0e6_wp*(seconds() - start)/chunks
      end do
   end subroutine measure_messages
end program rank_zero
