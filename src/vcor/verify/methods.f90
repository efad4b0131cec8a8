!> One case solved by several methods, for `vcor_verify_agreement` to judge
!>
!> The solutions are internal variables at the accuracy of the case and at a hundredth of it,
!> product integration with dt, dt/2 and dt/4, and the case's own scheme if it is different. The
!> step dt comes from the contact time, not from the case. The two methods have only the equation of
!> motion in common, so a result on which they agree is its solution. The coupled contact has no
!> second method: it is solved at the accuracy of the case and at a tenth of it, or at half of the
!> error it states if that is less, so that the meshes differ; at half of the error, too, if a tenth
!> is out of reach.
module vcor_verify_methods
   use vcor_case_case, only : case_t
   use vcor_case_mechanics, only : method_of
   use vcor_case_problem, only : problem_t
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_outcome, only : evaluate
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_kinds, only : finest_accuracy, wp
   use vcor_solver, only : default_accuracy, new_solver, solve_impact, solver_settings_t, solver_t
   use vcor_verify_agreement, only : attempt_case, attempt_first, attempt_halved, attempt_refined, &
      attempt_t, comparison_t, judge_ends, judge_numbers
   implicit none
   private

   public :: compare

contains

   !> Solve a case by all methods and judge the results
   subroutine compare(case, problem, comparison, error)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Its problem
      type(problem_t), intent(in) :: problem
      type(comparison_t), intent(out) :: comparison
      !> An error that no method can avoid, but no numerical failure: those are part of the
      !> comparison. Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(solver_settings_t) :: settings
      class(solver_t), allocatable :: solver
      character(len=:), allocatable :: method, scheme
      ! whether the case has one of the paper's variants, which internal variables do not solve
      logical :: is_variant

      if (method_of(case) == 'coupled') then
         call compare_coupled(case, problem%impact, comparison, error)
         return
      end if
      comparison%first_contact = case%count('target') > 0
      call case%get('solver', 'method', method)
      call case%get('solver', 'scheme', scheme)
      associate (first => comparison%attempts(attempt_first), &
                 own => comparison%attempts(attempt_case), impact => problem%impact)
         settings = settings_of(case, 'ive')
         is_variant = impact%target%frozen() .or. abs(settings%second_coefficient) > 0.0_wp
         if (.not. is_variant) call make_attempt(first, settings, impact, error)
         if (allocated(error)) return
         if (is_variant .or. method == 'auto' .and. allocated(first%failure)) then
            ! like `auto`, use direct alone if ive fails
            comparison%two_methods = .false.
            first = attempt_t()
            settings = settings_of(case, 'direct')
            call make_attempt(first, settings, impact, error)
         else
            ! a hundredth of the accuracy may be more than ive can reach
            settings%accuracy = max(0.01_wp*settings%accuracy, finest_accuracy)
            call make_attempt(comparison%attempts(attempt_refined), settings, impact, error, &
               lenient=.true.)
         end if
         if (.not. allocated(error)) call solve_direct(comparison%attempts, settings, impact, error)
         if (allocated(error)) return
         if (method_of(case) == 'direct' .and. .not. comparison%first_contact &
             .and. (comparison%two_methods .or. scheme /= 'product' &
             .or. case%given('solver', 'time_step'))) then
            own%label = 'case: '//scheme
            if (case%given('solver', 'time_step')) &
               call case%get('solver', 'time_step', own%time_step)
            allocate (solver, source=problem%solver)
            call try(own, solver, impact, error)
            if (allocated(error)) return
         end if
      end associate
      call judge_ends(comparison)
      if (.not. comparison%separated) return
      call judge_numbers(comparison)
   end subroutine compare

   !> Solve the coupled contact of a case at its accuracy and on a finer mesh, and judge the results
   subroutine compare_coupled(case, impact, comparison, error)
      !> A validated case
      type(case_t), intent(in) :: case
      type(impact_t), intent(in) :: impact
      type(comparison_t), intent(inout) :: comparison
      !> An error that is not numerical; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(solver_settings_t) :: settings
      real(wp) :: half

      comparison%has_direct = .false.
      settings = settings_of(case, 'coupled')
      associate (first => comparison%attempts(attempt_first), &
                 refined => comparison%attempts(attempt_refined))
         call make_attempt(first, settings, impact, error)
         if (allocated(error)) return
         half = 0.5_wp*settings%accuracy
         if (first%separated()) half = 0.5_wp*first%outcome%cor_sphere_error
         settings%accuracy = max(min(0.1_wp*settings%accuracy, half), finest_accuracy)
         call make_attempt(refined, settings, impact, error, lenient=.true.)
         if (allocated(error)) return
         ! what is out of reach in reasonable time may not be so for half of the error
         if (allocated(refined%failure) .and. half > settings%accuracy) then
            refined = attempt_t()
            settings%accuracy = half
            call make_attempt(refined, settings, impact, error, lenient=.true.)
            if (allocated(error)) return
         end if
      end associate
      call judge_ends(comparison)
      if (comparison%separated) call judge_numbers(comparison)
   end subroutine compare_coupled

   !> Make an attempt with given settings
   subroutine make_attempt(attempt, settings, impact, error, lenient)
      type(attempt_t), intent(inout) :: attempt
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> An error that is not numerical; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether to accept a result whose error is far above the accuracy; absent: it is a failure
      logical, intent(in), optional :: lenient

      class(solver_t), allocatable :: solver

      attempt%label = settings%method
      attempt%time_step = settings%time_step
      if (.not. attempt%time_step > 0.0_wp) attempt%accuracy = settings%accuracy
      call new_solver(solver, settings, impact, error)
      if (.not. allocated(error)) call try(attempt, solver, impact, error, lenient)
   end subroutine make_attempt

   !> Settings of the case for the attempts, without step, scheme or motion after separation
   function settings_of(case, method) result(settings)
      !> A validated case
      type(case_t), intent(in) :: case
      !> ive or direct
      character(len=*), intent(in) :: method
      type(solver_settings_t) :: settings

      integer :: order

      settings%method = method
      settings%scheme = 'product'
      settings%first_contact = case%count('target') > 0
      settings%accuracy = default_accuracy(method)
      if (case%given('solver', 'accuracy')) &
         call case%get('solver', 'accuracy', settings%accuracy)
      if (case%given('solver', 'end_time')) call case%get('solver', 'end_time', settings%end_time)
      call case%get('solver', 'volterra_order', order)
      if (order == 2) &
         call case%get('solver', 'volterra_coefficient', settings%second_coefficient)
   end function settings_of

   !> Product integration with steps dt, dt/2 and dt/4. Without separation there is no number to
   !> extrapolate, and it runs once with steps of its own
   subroutine solve_direct(attempts, settings, impact, error)
      !> All attempts; the first one has been made
      type(attempt_t), intent(inout) :: attempts(:)
      !> Settings except method and step
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      type(error_t), allocatable, intent(out) :: error

      ! steps per contact time
      real(wp), parameter :: per_contact = 1000.0_wp
      type(solver_settings_t) :: direct
      integer :: i

      direct = settings
      direct%method = 'direct'
      ! zero accuracy: the step is given
      direct%accuracy = 0.0_wp
      if (attempts(attempt_first)%separated()) then
         direct%time_step = attempts(attempt_first)%outcome%contact_time/per_contact
      else if (allocated(attempts(attempt_first)%failure)) then
         direct%time_step = impact%law%contact_time*impact%time_scale()/per_contact
      else
         direct%accuracy = default_accuracy('direct')
         call make_attempt(attempts(attempt_halved(1)), direct, impact, error)
         return
      end if
      do i = 1, size(attempt_halved)
         call make_attempt(attempts(attempt_halved(i)), direct, impact, error)
         if (allocated(error)) return
         direct%time_step = 0.5_wp*direct%time_step
      end do
   end subroutine solve_direct

   !> Solve, and store a numerical failure
   subroutine try(attempt, solver, impact, error, lenient)
      type(attempt_t), intent(inout) :: attempt
      class(solver_t), intent(inout) :: solver
      type(impact_t), intent(in) :: impact
      !> An error that is not numerical; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether to accept a result whose error is far above the accuracy; absent: it is a failure
      logical, intent(in), optional :: lenient

      type(trajectory_t) :: trajectory

      attempt%made = .true.
      call solve_impact(solver, impact, trajectory, attempt%outcome, error)
      if (.not. allocated(error)) return
      if (error%code /= error_numerical) return
      attempt%failure = error%message
      deallocate (error)
      if (.not. present(lenient)) return
      call solver%solve(impact, trajectory, error)
      if (allocated(error)) then
         deallocate (error)
      else
         deallocate (attempt%failure)
         attempt%outcome = evaluate(impact, trajectory)
      end if
   end subroutine try

end module vcor_verify_methods
