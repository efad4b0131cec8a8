!> One case by several methods: what of its outcome can be trusted
!>
!> The internal variables at the accuracy of the case and at a hundredth of it, product integration
!> with three steps halved from one to the next, and the case's own scheme where it is another one.
!> Product integration gets its steps from the contact time, not from the case. The two methods
!> share the equation of motion and nothing else, so what they agree on is its solution.
module vcor_verify_comparison
   use vcor_error, only : error_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver, only : default_accuracy, solver_settings_t
   use vcor_case_case, only : case_t
   use vcor_verify_attempt, only : attempt_t
   use vcor_verify_judge, only : judge_ends, judge_numbers
   use vcor_verify_comparison_type, only : attempt_case, attempt_count, attempt_first, &
      attempt_halved, attempt_refined, comparison_t
   use vcor_verify_methods, only : method_of_case, methods_for
   implicit none
   private

   public :: compare

contains

   !> Solve a case by all methods and judge what comes out
   subroutine compare(case, impact, comparison, error)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Its impact
      type(impact_t), intent(in) :: impact
      !> The comparison
      type(comparison_t), intent(out) :: comparison
      !> What no method can do; numerical failures are part of the comparison. Unallocated on
      !> success
      type(error_t), allocatable, intent(out) :: error

      type(solver_settings_t) :: settings
      character(len=:), allocatable :: method

      comparison%two_methods = size(methods_for()) == 2
      call take_settings(case, comparison%two_methods, settings)
      call comparison%attempts(attempt_first)%try(settings, impact, error)
      if (allocated(error)) return
      call case%get('solver', 'method', method)
      if (method == 'auto' .and. allocated(comparison%attempts(attempt_first)%failure)) then
         ! as auto does: direct by itself where ive fails
         comparison%two_methods = .false.
         comparison%attempts(attempt_first) = attempt_t()
         call take_settings(case, comparison%two_methods, settings)
         call comparison%attempts(attempt_first)%try(settings, impact, error)
         if (allocated(error)) return
      end if
      if (comparison%two_methods) then
         settings%accuracy = refined(settings%accuracy)
         ! a hundredth is more than anybody has asked for
         call comparison%attempts(attempt_refined)%try(settings, impact, error, lenient=.true.)
         if (allocated(error)) return
      end if
      call halve(comparison%attempts, settings, impact, error)
      if (allocated(error)) return
      if (is_another(case, comparison%two_methods)) then
         call comparison%attempts(attempt_case)%try_case(case, error)
         if (allocated(error)) return
      end if
      call judge_ends(comparison)
      if (comparison%separated) call judge_numbers(comparison)
   end subroutine compare

   !> What the attempts take over from the case; not its steps, its scheme or its ghost lines
   subroutine take_settings(case, two_methods, settings)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Whether its impact can be solved by internal variables
      logical, intent(in) :: two_methods
      !> Settings
      type(solver_settings_t), intent(out) :: settings

      integer :: order

      settings%method = 'direct'
      if (two_methods) settings%method = 'ive'
      settings%scheme = 'product'
      settings%accuracy = default_accuracy(settings%method)
      if (case%given('solver', 'accuracy')) &
         call case%get('solver', 'accuracy', settings%accuracy)
      if (case%given('solver', 'end_time')) call case%get('solver', 'end_time', settings%end_time)
      call case%get('solver', 'volterra_order', order)
      if (order == 2) &
         call case%get('solver', 'volterra_coefficient', settings%second_coefficient)
   end subroutine take_settings

   !> Whether the case's own solver is none of those that are tried anyway
   function is_another(case, two_methods)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Whether the internal variables were tried
      logical, intent(in) :: two_methods
      !> Whether it is
      logical :: is_another

      character(len=:), allocatable :: scheme

      call case%get('solver', 'scheme', scheme)
      is_another = method_of_case(case) == 'direct' .and. (two_methods &
         .or. scheme /= 'product' .or. case%given('solver', 'time_step'))
   end function is_another

   !> A hundredth of an accuracy, but not below what the internal variables can do
   pure function refined(accuracy)
      !> Accuracy
      real(wp), intent(in) :: accuracy
      !> Refined one
      real(wp) :: refined

      real(wp), parameter :: finest = 1.0e-11_wp

      refined = max(0.01_wp*accuracy, finest)
   end function refined

   !> Product integration with steps dt, dt/2 and dt/4; once, and with steps of its own, where the
   !> bodies do not separate and there is no number to extrapolate
   subroutine halve(attempts, settings, impact, error)
      !> All attempts; the first one is made
      type(attempt_t), intent(inout) :: attempts(attempt_count)
      !> Settings but for method and step
      type(solver_settings_t), intent(in) :: settings
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      ! steps per contact
      real(wp), parameter :: per_contact = 1000.0_wp
      type(solver_settings_t) :: direct
      integer :: i

      direct = settings
      direct%method = 'direct'
      ! the steps are given
      direct%accuracy = 0.0_wp
      if (attempts(attempt_first)%separated()) then
         direct%time_step = attempts(attempt_first)%outcome%contact_time/per_contact
      else if (allocated(attempts(attempt_first)%failure)) then
         direct%time_step = impact%law%contact_time*impact%time_scale()/per_contact
      else
         direct%accuracy = default_accuracy('direct')
         call attempts(attempt_halved(1))%try(direct, impact, error)
         return
      end if
      do i = 1, size(attempt_halved)
         call attempts(attempt_halved(i))%try(direct, impact, error)
         if (allocated(error)) return
         direct%time_step = 0.5_wp*direct%time_step
      end do
   end subroutine halve

end module vcor_verify_comparison
