!> One case by several methods: what of its outcome can be trusted; and by other mechanics: what the
!> choice of the model is worth
!>
!> The internal variables at the accuracy of the case and at a hundredth of it, product integration
!> with three steps halved from one to the next, and the case's own scheme where it is another one.
!> Product integration gets its steps from the contact time, not from the case. The two methods
!> share the equation of motion and nothing else, so what they agree on is its solution.
module vcor_verify_comparison
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_case, only : case_t
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_case_unread, only : why_unread
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_kinds, only : finest_accuracy, wp
   use vcor_solver, only : default_accuracy, method_for, new_solver, solve_impact, &
      solver_settings_t, solver_t
   use vcor_verify_judge, only : judge_ends, judge_numbers
   use vcor_verify_solutions, only : attempt_case, attempt_first, attempt_halved, &
      attempt_refined, attempt_t, comparison_t
   implicit none
   private

   public :: compare, model_t, solve_models, solve_model, differ

   !> The case with one plate model, one contact law and one pair
   type :: model_t
      character(len=10) :: waves = ''
      character(len=9) :: law = ''
      character(len=6) :: pair = ''
      !> Whether it is that of the case
      logical :: given = .false.
      !> Why there is no outcome, one line; unallocated if there is one
      character(len=:), allocatable :: failure
      type(outcome_t) :: outcome
   end type model_t

contains

   !> Solve a case by all methods and judge what comes out
   subroutine compare(case, impact, comparison, error)
      !> A validated case
      type(case_t), intent(in) :: case
      type(impact_t), intent(in) :: impact
      type(comparison_t), intent(out) :: comparison
      !> What no method can do; numerical failures are part of the comparison. Unallocated on
      !> success
      type(error_t), allocatable, intent(out) :: error

      type(solver_settings_t) :: settings
      type(problem_t) :: problem
      character(len=:), allocatable :: method, scheme

      call case%get('solver', 'method', method)
      call case%get('solver', 'scheme', scheme)
      associate (first => comparison%attempts(attempt_first), &
                 own => comparison%attempts(attempt_case))
         settings = settings_of(case, 'ive')
         call try(first, settings, impact, error)
         if (allocated(error)) return
         if (method == 'auto' .and. allocated(first%failure)) then
            ! as auto does: direct by itself where ive fails
            comparison%two_methods = .false.
            first = attempt_t()
            settings = settings_of(case, 'direct')
            call try(first, settings, impact, error)
         else
            ! a hundredth is more than anybody has asked for, and may be more than ive can do
            settings%accuracy = max(0.01_wp*settings%accuracy, finest_accuracy)
            call try(comparison%attempts(attempt_refined), settings, impact, error, lenient=.true.)
         end if
         if (.not. allocated(error)) call halve(comparison%attempts, settings, impact, error)
         if (allocated(error)) return
         if (method_for(method, scheme) == 'direct' .and. (comparison%two_methods &
            .or. scheme /= 'product' .or. case%given('solver', 'time_step'))) then
            own%label = 'case: '//scheme
            if (case%given('solver', 'time_step')) &
               call case%get('solver', 'time_step', own%time_step)
            call problem_of_case(problem, case, error)
            if (.not. allocated(error)) call own%try(problem%solver, problem%impact, error)
            if (allocated(error)) return
         end if
      end associate
      call judge_ends(comparison)
      if (comparison%separated) call judge_numbers(comparison)
   end subroutine compare

   !> Make an attempt with given settings
   subroutine try(attempt, settings, impact, error, lenient)
      type(attempt_t), intent(inout) :: attempt
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> What is no numerical failure; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether an error far above the accuracy is no failure; absent: it is one
      logical, intent(in), optional :: lenient

      class(solver_t), allocatable :: solver

      attempt%label = settings%method
      attempt%time_step = settings%time_step
      if (.not. attempt%time_step > 0.0_wp) attempt%accuracy = settings%accuracy
      call new_solver(solver, settings, impact, error)
      if (.not. allocated(error)) call attempt%try(solver, impact, error, lenient)
   end subroutine try

   !> What the attempts take over from the case; not its steps, its scheme or its ghost lines
   function settings_of(case, method) result(settings)
      !> A validated case
      type(case_t), intent(in) :: case
      !> ive or direct
      character(len=*), intent(in) :: method
      type(solver_settings_t) :: settings

      integer :: order

      settings%method = method
      settings%scheme = 'product'
      settings%accuracy = default_accuracy(method)
      if (case%given('solver', 'accuracy')) &
         call case%get('solver', 'accuracy', settings%accuracy)
      if (case%given('solver', 'end_time')) call case%get('solver', 'end_time', settings%end_time)
      call case%get('solver', 'volterra_order', order)
      if (order == 2) &
         call case%get('solver', 'volterra_coefficient', settings%second_coefficient)
   end function settings_of

   !> Product integration with steps dt, dt/2 and dt/4; once, and with steps of its own, where the
   !> bodies do not separate and there is no number to extrapolate
   subroutine halve(attempts, settings, impact, error)
      !> All attempts; the first one is made
      type(attempt_t), intent(inout) :: attempts(:)
      !> Settings but for method and step
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      type(error_t), allocatable, intent(out) :: error

      ! steps per contact
      real(wp) :: per_contact
      type(solver_settings_t) :: direct
      integer :: i

      direct = settings
      direct%method = 'direct'
      ! the steps are given
      direct%accuracy = 0.0_wp
      ! each takes two values of the compliance of a layer
      per_contact = merge(200.0_wp, 1000.0_wp, impact%plate%layered())
      if (attempts(attempt_first)%separated()) then
         direct%time_step = attempts(attempt_first)%outcome%contact_time/per_contact
      else if (allocated(attempts(attempt_first)%failure)) then
         direct%time_step = impact%law%contact_time*impact%time_scale()/per_contact
      else
         direct%accuracy = default_accuracy('direct')
         call try(attempts(attempt_halved(1)), direct, impact, error)
         return
      end if
      do i = 1, size(attempt_halved)
         call try(attempts(attempt_halved(i)), direct, impact, error)
         if (allocated(error)) return
         direct%time_step = 0.5_wp*direct%time_step
      end do
   end subroutine halve

   !> Solve a case with every plate model and both contact laws, by the internal variables, then all
   !> of it with the other pair where that makes a difference. A plate without half thickness or
   !> density has the model `none` only
   subroutine solve_models(case, models)
      !> A validated case
      type(case_t), intent(in) :: case
      !> The table
      type(model_t), allocatable, intent(out) :: models(:)

      character(len=*), parameter :: plates(6) = [character(len=10) :: 'none', 'constant', &
         'relaxing', 'frozen', 'hereditary', 'body']
      character(len=*), parameter :: laws(2) = [character(len=9) :: 'boltzmann', 'receding']
      type(model_t) :: all(2*size(plates)*size(laws))
      character(len=:), allocatable :: waves, law, pair
      logical :: exists
      integer :: i, j, k, n, half

      call case%get('plate', 'waves', waves)
      call case%get('contact', 'law', law)
      call case%get('contact', 'pair', pair)
      n = 0
      do k = 1, merge(2, 1, reads(case, 'pair'))
         half = n
         do i = 1, size(plates)
            do j = 1, merge(size(laws), 1, reads(case, 'law'))
               associate (model => all(n + 1))
                  model = model_t(plates(i), laws(j), pair, &
                     plates(i) == waves .and. laws(j) == law .and. k == 1)
                  call solve_model(case, model, exists)
                  exists = exists .or. plates(i) == waves .or. j > 1 &
                     .or. case%given('plate', 'half_thickness')
               end associate
               if (.not. exists) exit
               n = n + 1
            end do
         end do
         pair = trim(merge('series', 'eq1   ', pair == 'eq1'))
      end do
      if (half > 0) then
         if (.not. any(differ(all(:half)%outcome, all(half + 1:n)%outcome))) n = half
      end if
      allocate (models, source=all(:n))
   end subroutine solve_models

   !> Whether a key of &contact makes a difference
   pure function reads(case, key)
      type(case_t), intent(in) :: case
      character(len=*), intent(in) :: key
      logical :: reads

      reads = why_unread(case, case%address('contact', key)) == ''
   end function reads

   !> Whether two outcomes have another restitution, or only one of them has any
   elemental function differ(a, b)
      type(outcome_t), intent(in) :: a, b
      logical :: differ

      ! a solution that failed has no number, which a debug build must not compare
      differ = a%status /= b%status .or. (ieee_is_nan(a%cor) .neqv. ieee_is_nan(b%cor))
      if (.not. (differ .or. ieee_is_nan(a%cor))) &
         differ = abs(a%cor - b%cor) > a%cor_error + b%cor_error
   end function differ

   !> Solve a case with other mechanics
   subroutine solve_model(case, model, valid)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Its row, outcome or failure to be set
      type(model_t), intent(inout) :: model
      !> Whether it still describes an impact
      logical, intent(out) :: valid

      type(case_t) :: other
      type(problem_t) :: problem
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      other = case
      call other%set(other%address('plate', 'waves'), trim(model%waves), given=.false.)
      if (reads(case, 'law')) &
         call other%set(other%address('contact', 'law'), trim(model%law), given=.false.)
      if (reads(case, 'pair')) &
         call other%set(other%address('contact', 'pair'), trim(model%pair), given=.false.)
      call other%set(other%address('solver', 'method'), 'auto', given=.false.)
      call other%set(other%address('solver', 'scheme'), 'product', given=.false.)
      call other%unset(other%address('solver', 'continue_after_separation'))
      ! a layer is solved to what it can be
      if (model%waves == 'body') call other%unset(other%address('solver', 'accuracy'))
      call problem_of_case(problem, other, error)
      valid = .not. allocated(error)
      if (valid) call solve_impact(problem%solver, problem%impact, trajectory, model%outcome, error)
      if (allocated(error)) then
         model%failure = error%message
         ! a number with an error above all bounds is none
         model%outcome = outcome_t()
      end if
   end subroutine solve_model

end module vcor_verify_comparison
