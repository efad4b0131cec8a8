!> One case solved by several methods: how many digits of its outcome can be trusted
!>
!> The solutions are internal variables at the accuracy of the case and at a hundredth of it,
!> product integration with dt, dt/2 and dt/4, and the case's own scheme if it is different. The
!> step dt comes from the contact time, not from the case. The two methods have only the equation of
!> motion in common, so a result on which they agree is its solution. The judgement is whether they
!> agree within their stated errors. The coupled contact has no second method: it is solved at the
!> accuracy of the case and at a tenth of it, or at half of the error it states if that is less, so
!> that the meshes differ; at half of the error, too, if a tenth is out of reach. Of a structure
!> the methods solve the first contact: internal variables follow no other. Its fastest modes ring
!> from the first touch on, which panels longer than their periods smooth and steps follow: largest
!> values and contact time may differ by what both state for it.
module vcor_verify_methods
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan, ieee_quiet_nan, &
      ieee_value
   use vcor_case_case, only : case_t
   use vcor_case_mechanics, only : method_of
   use vcor_case_problem, only : problem_t
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : finest_accuracy, wp
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_solver, only : default_accuracy, new_solver, solve_impact, &
      solver_settings_t, solver_t
   use vcor_sweep_quantity, only : quantity_value, status_name
   implicit none
   private

   public :: attempt_t, compared_t, comparison_t, compared_names, compare
   public :: attempt_count, attempt_case, attempt_first, attempt_refined, attempt_halved
   public :: judge_ends, judge_numbers, is_honest, error_of_best

   !> Largest ratio of the true error to the stated one: for the cases of tests/reference with these
   !> steps the ratio is below 3 wherever the error is above `rounding`
   real(wp), parameter :: honest_factor = 3.0_wp
   !> Ratio of the accuracy of the energy budget, and of quantities other than cor, to that of cor:
   !> the steps are chosen for cor, and the errors of the others are of the same order
   real(wp), parameter :: other_quantities = 10.0_wp
   !> Relative error of any number by rounding and by the error of the reference itself
   real(wp), parameter :: rounding = 1.0e-10_wp

   !> Number of attempts
   integer, parameter :: attempt_count = 6
   !> The case's own solver, if it differs from the others
   integer, parameter :: attempt_case = 1
   !> The first method of `auto`, at the accuracy of the case
   integer, parameter :: attempt_first = 2
   !> The internal variables, refined
   integer, parameter :: attempt_refined = 3
   !> Product integration with dt, dt/2 and dt/4
   integer, parameter :: attempt_halved(3) = [4, 5, 6]

   !> Compared quantities, cor first
   character(len=*), parameter :: compared_names(7) = [character(len=20) :: 'cor', 'cor_sphere', &
      'contact_time', 'max_indentation', 'max_force', 'residual_indentation', &
      'energy_loss']

   !> One solution
   type :: attempt_t
      !> Whether it was tried
      logical :: made = .false.
      !> ive, direct, or the scheme of the case
      character(len=21) :: label = ''
      !> Requested accuracy; 0 if the step is given
      real(wp) :: accuracy = 0.0_wp
      !> Step [s]; 0 if it follows from the accuracy
      real(wp) :: time_step = 0.0_wp
      !> Reason of a failure, one line; unallocated if there was none
      character(len=:), allocatable :: failure
      !> Outcome, if there was no failure
      type(outcome_t) :: outcome
      !> Distances of its cor and cor_sphere from the best ones [-]
      real(wp) :: distance(2) = 0.0_wp
   contains
      procedure :: solve
      procedure :: stated
      procedure :: separated
      procedure :: imbalance
   end type attempt_t

   !> One quantity by all methods
   type :: compared_t
      character(len=20) :: name = ''
      !> Value of each attempt, NaN if there is none
      real(wp) :: value(attempt_count) = 0.0_wp
      !> Product integration, extrapolated to dt = 0
      type(richardson_t) :: direct
      !> The most accurate value
      real(wp) :: best = 0.0_wp
      !> Size that the digits are relative to: its own, or that of the whole that it is a part of
      real(wp) :: scale = 1.0_wp
      !> Significant digits that can be trusted
      integer :: digits = 0
   end type compared_t

   !> The attempts and their judgement
   type :: comparison_t
      !> Solutions, by the constants `attempt_*`
      type(attempt_t) :: attempts(attempt_count)
      !> Whether two methods, or two accuracies of the coupled contact, are compared
      logical :: two_methods = .true.
      !> Whether direct is one of them
      logical :: has_direct = .true.
      !> Whether it is the first contact with a structure
      logical :: first_contact = .false.
      !> Whether the bodies separate in all solutions
      logical :: separated = .false.
      !> Quantities, defined if they separate
      type(compared_t) :: compared(size(compared_names))
      !> The first objection, one line; unallocated if there is none
      character(len=:), allocatable :: objection
   end type comparison_t

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
            call own%solve(solver, impact, error)
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
      if (.not. allocated(error)) call attempt%solve(solver, impact, error, lenient)
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
   subroutine solve(self, solver, impact, error, lenient)
      class(attempt_t), intent(inout) :: self
      class(solver_t), intent(inout) :: solver
      type(impact_t), intent(in) :: impact
      !> An error that is not numerical; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether to accept a result whose error is far above the accuracy; absent: it is a failure
      logical, intent(in), optional :: lenient

      type(trajectory_t) :: trajectory

      self%made = .true.
      call solve_impact(solver, impact, trajectory, self%outcome, error)
      if (.not. allocated(error)) return
      if (error%code /= error_numerical) return
      self%failure = error%message
      deallocate (error)
      if (.not. present(lenient)) return
      call solver%solve(impact, trajectory, error)
      if (allocated(error)) then
         deallocate (error)
      else
         deallocate (self%failure)
         self%outcome = evaluate(impact, trajectory)
      end if
   end subroutine solve

   !> Stated errors of cor and cor_sphere of a solution with separation
   pure function stated(self)
      class(attempt_t), intent(in) :: self
      real(wp) :: stated(2)

      stated = [self%outcome%cor_error, self%outcome%cor_sphere_error]
   end function stated

   !> Whether the solution ended in separation
   pure function separated(self)
      class(attempt_t), intent(in) :: self
      logical :: separated

      separated = self%made .and. .not. allocated(self%failure)
      if (separated) separated = self%outcome%status == contact_separated
   end function separated

   !> Imbalance of the energy budget divided by the initial energy [-]
   elemental function imbalance(self)
      class(attempt_t), intent(in) :: self
      real(wp) :: imbalance

      imbalance = self%outcome%energy_imbalance/self%outcome%initial_energy
   end function imbalance

   !> Store an objection if it is the first
   pure subroutine add_objection(self, objection)
      type(comparison_t), intent(inout) :: self
      character(len=*), intent(in) :: objection

      if (.not. allocated(self%objection)) self%objection = objection
   end subroutine add_objection

   !> Object if an attempt failed or they did not all end in the same way
   pure subroutine judge_ends(self)
      type(comparison_t), intent(inout) :: self

      integer :: i

      do i = 1, attempt_count
         associate (this => self%attempts(i), first => self%attempts(attempt_first))
            if (.not. this%made) cycle
            if (allocated(this%failure)) then
               call add_objection(self, trim(this%label)//': '//this%failure)
            else if (.not. allocated(first%failure) .and. this%outcome%status &
                     /= first%outcome%status) then
               call add_objection(self, 'the methods do not agree on how the contact ends: ' &
                  //trim(status_name(first%outcome%status))//' by '//trim(first%label)//', ' &
                  //trim(status_name(this%outcome%status))//' by '//trim(this%label))
            end if
         end associate
      end do
      self%separated = .not. allocated(self%objection) &
         .and. self%attempts(attempt_first)%separated()
   end subroutine judge_ends

   !> Compare all quantities
   pure subroutine judge_numbers(self)
      !> The comparison, all attempts separated
      type(comparison_t), intent(inout) :: self

      integer :: i

      do i = 1, size(compared_names)
         call tabulate(self, i)
      end do
      do i = 1, attempt_count
         if (self%attempts(i)%made) self%attempts(i)%distance &
            = abs(self%compared(:2)%value(i) - self%compared(:2)%best)
      end do
      call judge_errors(self)
      if (self%has_direct) call judge_distances(self)
      call judge_energies(self)
   end subroutine judge_numbers

   !> Compare one quantity. Its best value is the refined one or, with one method, the limit of
   !> product integration. Its trusted digits follow from the value farthest from it, that at the
   !> accuracy of the case or the limit of the other method, and from the error that the best value
   !> states: what both solutions have in common moves no two values apart
   pure subroutine tabulate(self, number)
      type(comparison_t), intent(inout) :: self
      !> Number of the quantity in `compared_names`
      integer, intent(in) :: number

      ! the internal variables have at most 11 digits
      integer, parameter :: most_digits = 11
      real(wp) :: uncertainty(2)
      integer :: i

      associate (this => self%compared(number), attempts => self%attempts)
         this%name = compared_names(number)
         do i = 1, attempt_count
            this%value(i) = ieee_value(this%value(i), ieee_quiet_nan)
            if (attempts(i)%made) this%value(i) = quantity_value(attempts(i)%outcome, this%name)
         end do
         this%direct = richardson(this%value(attempt_halved))
         if (self%two_methods) then
            this%best = this%value(attempt_refined)
            uncertainty(1) = stated_error(attempts(attempt_refined)%outcome, this%name)
            if (self%has_direct) uncertainty(1) = larger(uncertainty(1), &
               abs(this%direct%limit - this%best))
         else
            this%best = this%direct%limit
            uncertainty(1) = this%direct%error
         end if
         uncertainty(2) = abs(this%value(attempt_first) - this%best)
         if (.not. all(ieee_is_finite(uncertainty))) return
         this%scale = max(abs(this%best), size_of_whole(this%name, attempts(attempt_first)%outcome))
         if (.not. this%scale > 0.0_wp) return
         uncertainty = max(uncertainty/this%scale, tiny(1.0_wp))
         this%digits = min(most_digits, max(0, floor(-log10(maxval(uncertainty)))))
      end associate
   end subroutine tabulate

   !> Error that a solution states of a quantity; 0 if it states none
   pure function stated_error(outcome, name) result(error)
      type(outcome_t), intent(in) :: outcome
      !> Name of the quantity
      character(len=*), intent(in) :: name
      real(wp) :: error

      error = quantity_value(outcome, trim(name)//'_error')
      if (ieee_is_nan(error)) error = 0.0_wp
   end function stated_error

   !> The larger of two numbers; NaN if one is
   pure real(wp) function larger(a, b)
      real(wp), intent(in) :: a, b

      larger = a + b
      if (ieee_is_finite(larger)) larger = max(a, b)
   end function larger

   !> Object if an attempt is farther from the best cor and cor_sphere than its stated errors allow.
   !> The case's own scheme, the user's choice, is not judged: the table shows its distance
   pure subroutine judge_errors(self)
      !> The comparison, tabulated
      type(comparison_t), intent(inout) :: self

      logical :: fine(2)
      integer :: i, j

      do i = attempt_first, attempt_count
         associate (this => self%attempts(i))
            if (.not. this%made) cycle
            fine = is_honest(this, error_of_best(self))
            do j = 1, size(fine)
               if (.not. fine(j)) call add_objection(self, trim(this%label)//' is farther from ' &
                  //'the best '//trim(compared_names(j))//' than three times the error it states')
            end do
         end associate
      end do
   end subroutine judge_errors

   !> Whether the stated errors of an attempt are honest
   pure function is_honest(self, reference)
      !> The attempt, `distance` set
      type(attempt_t), intent(in) :: self
      !> Stated errors of the best cor and cor_sphere
      real(wp), intent(in) :: reference(2)
      logical :: is_honest(2)

      is_honest = within(self%distance, honest_factor*(self%stated() + reference) + rounding)
   end function is_honest

   !> Stated errors of the best cor and cor_sphere: those of the refined internal variables, or that
   !> of the shortest step, whose limit is more accurate
   pure function error_of_best(self) result(error)
      !> The comparison, tabulated
      type(comparison_t), intent(in) :: self
      !> Errors of cor and cor_sphere
      real(wp) :: error(2)

      error = self%compared(:2)%direct%error
      if (self%two_methods) error = self%attempts(attempt_refined)%stated()
   end function error_of_best

   !> Whether a number is finite and of absolute value at most `largest`
   elemental function within(value, largest)
      real(wp), intent(in) :: value
      real(wp), intent(in) :: largest
      logical :: within

      within = .false.
      if (.not. ieee_is_finite(value)) return
      if (.not. ieee_is_finite(largest)) return
      within = abs(value) <= largest
   end function within

   !> Object if product integration with the shortest step is farther from the best values than its
   !> own convergence allows
   pure subroutine judge_distances(self)
      !> The comparison, tabulated
      type(comparison_t), intent(inout) :: self

      real(wp) :: allowed, best(2)
      integer :: i

      best = error_of_best(self)
      do i = 1, size(self%compared)
         associate (this => self%compared(i))
            allowed = honest_factor*this%direct%error + rounding*this%scale &
               + abs(this%value(attempt_first) - this%best)
            select case (i)
            case (1)
               allowed = allowed + honest_factor*best(1)
            case (2)
               allowed = allowed + honest_factor*best(2)
            case default
               allowed = allowed + other_quantities*this%scale &
                  *max(self%attempts(attempt_first)%accuracy, best(1)) + ringing_of(self, this)
            end select
            if (.not. within(this%value(attempt_halved(3)) - this%best, allowed)) &
               call add_objection(self, 'the methods do not agree on '//trim(this%name))
            if (.not. settles(this%value(attempt_halved), allowed_change(self)*this%scale &
               + ringing_of(self, this))) &
               call add_objection(self, 'direct does not converge to a '//trim(this%name))
         end associate
      end do
   end subroutine judge_distances

   !> Change of a quantity by the ringing of fast modes
   pure function ringing_of(self, this) result(change)
      !> The comparison, tabulated
      type(comparison_t), intent(in) :: self
      type(compared_t), intent(in) :: this
      !> Change, in the unit of the quantity
      real(wp) :: change

      change = 0.0_wp
      if (.not. self%first_contact) return
      associate (one => self%attempts(attempt_first)%outcome, &
                 other => self%attempts(attempt_halved(3))%outcome)
         select case (this%name)
         case ('contact_time')
            change = one%contact_time_error + other%contact_time_error
         case ('max_indentation')
            ! F ~ s^n with n >= 1
            change = (one%max_force_error + other%max_force_error)*one%max_indentation/one%max_force
         case ('max_force')
            change = one%max_force_error + other%max_force_error
         case default
            continue
         end select
      end associate
   end function ringing_of

   !> Object if the energies do not balance: to within the accuracy if one was requested; with given
   !> steps, the imbalance must be as small as its changes from step to step say
   pure subroutine judge_energies(self)
      !> The comparison, tabulated
      type(comparison_t), intent(inout) :: self

      type(richardson_t) :: direct
      integer :: i

      do i = attempt_first, attempt_refined
         associate (this => self%attempts(i))
            if (.not. this%made) cycle
            if (.not. within(this%imbalance(), other_quantities*this%accuracy + rounding)) &
               call add_objection(self, 'the energies of '//trim(this%label)//' do not close')
         end associate
      end do
      if (.not. self%has_direct) return
      direct = richardson(self%attempts(attempt_halved)%imbalance())
      if (.not. within(self%attempts(attempt_halved(3))%imbalance(), &
                       honest_factor*direct%error + allowed_change(self)) .or. &
          .not. settles(self%attempts(attempt_halved)%imbalance(), allowed_change(self))) &
         call add_objection(self, 'the energies of direct do not close')
   end subroutine judge_energies

   !> Relative change of a number from step to step that is acceptable at the accuracy of the case
   pure function allowed_change(self) result(change)
      type(comparison_t), intent(in) :: self
      real(wp) :: change

      change = other_quantities*self%attempts(attempt_first)%accuracy + rounding
   end function allowed_change

   !> Whether three values get closer to each other, or are close enough. If they do not, the error
   !> estimated from them is large and would allow anything. If the first is right by chance and
   !> errors at least halve, the last difference is up to one and a half times the first, as for
   !> maxima on a grid
   pure function settles(value, close_enough)
      !> Values with steps dt, dt/2 and dt/4
      real(wp), intent(in) :: value(3)
      !> Acceptable difference
      real(wp), intent(in) :: close_enough
      logical :: settles

      real(wp), parameter :: chance = 1.5_wp

      settles = all(ieee_is_finite(value))
      if (settles) settles = within(value(3) - value(2), &
         max(chance*abs(value(2) - value(1)), close_enough))
   end function settles

   !> Size of the whole that a quantity is a part of; digits of a small part are relative to it
   pure function size_of_whole(name, outcome) result(whole)
      character(len=*), intent(in) :: name
      type(outcome_t), intent(in) :: outcome
      !> Size of the whole; 0 if the quantity is a whole itself
      real(wp) :: whole

      select case (name)
      case ('cor_sphere')
         whole = abs(outcome%cor)
      case ('residual_indentation')
         whole = outcome%max_indentation
      case ('energy_loss')
         whole = outcome%initial_energy
      case default
         whole = 0.0_wp
      end select
   end function size_of_whole

end module vcor_verify_methods
