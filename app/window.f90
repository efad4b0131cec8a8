!> The impact of a case as that on which commands about its materials look: its contact time tells
!> what of them matters
module vcor_app_window
   use vcor_app_job, only : job_t
   use vcor_app_screen, only : significant
   use vcor_case_case, only : case_t
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_kinds, only : wp
   use vcor_sweep_sweep, only : solve_point, worker_t
   implicit none
   private

   public :: window_t, find_window

   !> An impact
   type :: window_t
      !> The case; of a sweep its first point, which stands for all of them
      type(case_t) :: case
      !> Contact time [s]; 0: the impact has no result
      real(wp) :: contact_time = 0.0_wp
      !> Coefficient of restitution [-], where there is a contact time
      real(wp) :: cor = 0.0_wp
      !> Contact time or, where there is none, a time in its place [s]; that of any impact
      real(wp) :: reference = 1.0e-3_wp
      !> Notes about them, one to a line
      character(len=:), allocatable :: notes
   end type window_t

contains

   !> Solve the impact of a case, the first one of a sweep
   subroutine find_window(job, window, error)
      type(job_t), intent(in) :: job
      type(window_t), intent(out) :: window
      !> Error of code `error_input`, unallocated on success, with or without a result
      type(error_t), allocatable, intent(out) :: error

      !> Contact times are about three times the time scale of Hertz's impact
      real(wp), parameter :: hertz = 3.0_wp
      type(worker_t) :: worker
      type(outcome_t) :: outcome
      type(error_t), allocatable :: trouble
      integer :: i

      window%case = job%case
      window%notes = ''
      do i = 1, size(job%sweep%grid%axes)
         associate (axis => job%sweep%grid%axes(i))
            call window%case%put(axis%address, axis%values(1), error)
            if (allocated(error)) return
            window%notes = window%notes//'  note: the case varies '//axis%name//', here it is ' &
               //trim(adjustl(significant(axis%values(1))))//new_line('a')
         end associate
      end do
      call solve_point(job%sweep, 1, worker, outcome, trouble)
      if (allocated(trouble)) then
         window%notes = window%notes//'  note: the impact cannot be solved ('//trouble%message &
            //'): its window is not known'//new_line('a')
      else if (outcome%status /= contact_separated) then
         window%reference = hertz*worker%problem%impact%time_scale()
         window%notes = window%notes//'  note: the impact does not end in separation: its window ' &
            //'is not known'//new_line('a')
      else
         window%contact_time = outcome%contact_time
         window%reference = outcome%contact_time
         window%cor = outcome%cor
      end if
   end subroutine find_window

end module vcor_app_window
