!> One case by several methods: what of its outcome can be trusted
!>
!> The internal variables at the accuracy of the case and at a hundredth of it, product integration
!> with three steps halved from one to the next, and the case's own scheme where it is another one.
!> Product integration gets its steps from the contact time, not from the case. The two methods
!> share the equation of motion and nothing else, so what they agree on is its solution. The judge
!> says whether they agree within the errors they state.
module vcor_verify_methods
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_quiet_nan, ieee_value
   use vcor_case_case, only : case_t
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : finest_accuracy, wp
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_solver, only : default_accuracy, method_for, new_solver, solve_impact, &
      solver_settings_t, solver_t
   use vcor_sweep_quantity, only : quantity_value, status_name
   implicit none
   private

   public :: attempt_t, compared_t, comparison_t, compared_names, compare
   public :: attempt_count, attempt_case, attempt_first, attempt_refined, attempt_halved
   public :: judge_ends, judge_numbers, is_honest, error_of_best

   !> How many times the stated error the true one may be: measured over the cases of
   !> tests/reference with the steps used here, it is below 3 wherever it is above `rounding`
   real(wp), parameter :: honest_factor = 3.0_wp
   !> Accuracy of quantities other than cor, and of the energy budget, over that of cor: the steps
   !> are chosen for cor, the others follow with errors of the same order
   real(wp), parameter :: other_quantities = 10.0_wp
   !> What rounding and the error of the reference itself leave of any number, over its size
   real(wp), parameter :: rounding = 1.0e-10_wp

   !> Number of attempts
   integer, parameter :: attempt_count = 6
   !> The case's own solver, if it is none of the others
   integer, parameter :: attempt_case = 1
   !> The method that `auto` takes, at the accuracy of the case
   integer, parameter :: attempt_first = 2
   !> The internal variables, refined
   integer, parameter :: attempt_refined = 3
   !> Product integration with dt, dt/2 and dt/4
   integer, parameter :: attempt_halved(3) = [4, 5, 6]

   !> Quantities that are compared, cor first
   character(len=*), parameter :: compared_names(7) = [character(len=20) :: 'cor', 'cor_sphere', &
      'contact_time', 'max_indentation', 'max_force', 'residual_indentation', &
      'hysteresis_energy']

   !> One solution
   type :: attempt_t
      !> Whether it was tried
      logical :: made = .false.
      !> How: ive, direct, or the scheme of the case
      character(len=21) :: label = ''
      !> Accuracy that was asked for, 0 where the step is given
      real(wp) :: accuracy = 0.0_wp
      !> Step [s], 0 where it follows from the accuracy
      real(wp) :: time_step = 0.0_wp
      !> What went wrong, one line; unallocated if nothing did
      character(len=:), allocatable :: failure
      !> Outcome, if nothing went wrong
      type(outcome_t) :: outcome
      !> Distances of its cor and cor_sphere from the most accurate ones
      real(wp) :: seen(2) = 0.0_wp
   contains
      procedure :: solve
      procedure :: stated
      procedure :: separated
      procedure :: imbalance
   end type attempt_t

   !> One quantity by all methods
   type :: compared_t
      character(len=20) :: name = ''
      !> Value of each attempt, NaN where there is none
      real(wp) :: value(attempt_count) = 0.0_wp
      !> Product integration, extrapolated
      type(richardson_t) :: direct
      !> The most accurate value
      real(wp) :: best = 0.0_wp
      !> What its digits are counted against: its own size, or that of what it is a part of
      real(wp) :: scale = 1.0_wp
      !> Significant digits that can be trusted
      integer :: digits = 0
   end type compared_t

   !> All of it
   type :: comparison_t
      !> Solutions, by the constants `attempt_*`
      type(attempt_t) :: attempts(attempt_count)
      !> Whether there are two methods to compare
      logical :: two_methods = .true.
      !> Whether the bodies separate in all solutions
      logical :: separated = .false.
      !> Quantities, defined if they separate
      type(compared_t) :: compared(size(compared_names))
      !> The first thing that is wrong, one line; unallocated if nothing is
      character(len=:), allocatable :: objection
   end type comparison_t

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
            if (.not. allocated(error)) call own%solve(problem%solver, problem%impact, error)
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
      if (.not. allocated(error)) call attempt%solve(solver, impact, error, lenient)
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

   !> Solve, and keep a numerical failure
   subroutine solve(self, solver, impact, error, lenient)
      class(attempt_t), intent(inout) :: self
      class(solver_t), intent(in) :: solver
      type(impact_t), intent(in) :: impact
      !> What is no numerical failure; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether an error far above the accuracy is no failure; absent: it is one
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

   !> Errors of cor and cor_sphere that a solution with separation states
   pure function stated(self)
      class(attempt_t), intent(in) :: self
      real(wp) :: stated(2)

      stated = [self%outcome%cor_error, self%outcome%cor_sphere_error]
   end function stated

   !> Whether it ended in separation
   pure function separated(self)
      class(attempt_t), intent(in) :: self
      logical :: separated

      separated = self%made .and. .not. allocated(self%failure)
      if (separated) separated = self%outcome%status == contact_separated
   end function separated

   !> What the budget of energies misses, over the energy before the impact [-]
   elemental function imbalance(self)
      class(attempt_t), intent(in) :: self
      real(wp) :: imbalance

      imbalance = self%outcome%energy_imbalance/self%outcome%initial_energy
   end function imbalance

   !> Note what is wrong, the first time
   pure subroutine object(self, objection)
      type(comparison_t), intent(inout) :: self
      character(len=*), intent(in) :: objection

      if (.not. allocated(self%objection)) self%objection = objection
   end subroutine object

   !> Whether no attempt failed and all ended in the same way
   pure subroutine judge_ends(self)
      type(comparison_t), intent(inout) :: self

      integer :: i

      do i = 1, attempt_count
         associate (this => self%attempts(i), first => self%attempts(attempt_first))
            if (.not. this%made) cycle
            if (allocated(this%failure)) then
               call object(self, trim(this%label)//': '//this%failure)
            else if (.not. allocated(first%failure) .and. this%outcome%status &
                     /= first%outcome%status) then
               call object(self, 'the methods do not agree on how the contact ends: ' &
                  //status_name(first%outcome%status)//' by '//trim(first%label)//', ' &
                  //status_name(this%outcome%status)//' by '//trim(this%label))
            end if
         end associate
      end do
      self%separated = .not. allocated(self%objection) &
         .and. self%attempts(attempt_first)%separated()
   end subroutine judge_ends

   !> Compare all numbers
   pure subroutine judge_numbers(self)
      !> The comparison, all attempts separated
      type(comparison_t), intent(inout) :: self

      integer :: i

      do i = 1, size(compared_names)
         call tabulate(self%compared(i), compared_names(i), self%attempts, self%two_methods)
      end do
      do i = 1, attempt_count
         if (self%attempts(i)%made) self%attempts(i)%seen &
            = abs(self%compared(:2)%value(i) - self%compared(:2)%best)
      end do
      call judge_errors(self)
      call judge_distances(self)
      call judge_energies(self)
   end subroutine judge_numbers

   !> One quantity by all methods. Its best value is that of the refined internal variables, or the
   !> limit of product integration; how many of its digits can be trusted is decided by what is
   !> farthest from it, the solution at the accuracy of the case or the limit of the other method
   pure subroutine tabulate(self, name, attempts, two_methods)
      type(compared_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      type(attempt_t), intent(in) :: attempts(attempt_count)
      logical, intent(in) :: two_methods

      ! the internal variables have no more than 11
      integer, parameter :: most_digits = 11
      real(wp) :: uncertainty(2)
      integer :: i

      self%name = name
      do i = 1, attempt_count
         self%value(i) = ieee_value(self%value(i), ieee_quiet_nan)
         if (attempts(i)%made) self%value(i) = quantity_value(attempts(i)%outcome, name)
      end do
      self%direct = richardson(self%value(attempt_halved))
      if (two_methods) then
         self%best = self%value(attempt_refined)
         uncertainty(1) = abs(self%direct%limit - self%best)
      else
         self%best = self%direct%limit
         uncertainty(1) = self%direct%error
      end if
      uncertainty(2) = abs(self%value(attempt_first) - self%best)
      self%digits = 0
      if (.not. all(ieee_is_finite(uncertainty))) return
      self%scale = max(abs(self%best), size_of_whole(name, attempts(attempt_first)%outcome))
      if (.not. self%scale > 0.0_wp) return
      uncertainty = max(uncertainty/self%scale, tiny(1.0_wp))
      self%digits = min(most_digits, max(0, floor(-log10(maxval(uncertainty)))))
   end subroutine tabulate

   !> Whether each attempt is as far from the best cor and cor_sphere as it says, however good it
   !> is. Not the case's own scheme: how far that is off is shown, and the choice of the case
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
               if (.not. fine(j)) call object(self, trim(this%label)//' is farther from the best ' &
                  //trim(compared_names(j))//' than three times the error it states')
            end do
         end associate
      end do
   end subroutine judge_errors

   !> Whether the errors that an attempt states are honest
   pure function is_honest(self, reference)
      !> The attempt, `seen` being set
      type(attempt_t), intent(in) :: self
      !> Errors that the best cor and cor_sphere state themselves
      real(wp), intent(in) :: reference(2)
      logical :: is_honest(2)

      is_honest = within(self%seen, honest_factor*(self%stated() + reference) + rounding)
   end function is_honest

   !> Errors that the best cor and cor_sphere state: those of the refined internal variables, or of
   !> the shortest step, whose limit is better
   pure function error_of_best(self) result(error)
      !> The comparison, tabulated
      type(comparison_t), intent(in) :: self
      !> Errors of cor and cor_sphere
      real(wp) :: error(2)

      error = self%compared(:2)%direct%error
      if (self%two_methods) error = self%attempts(attempt_refined)%stated()
   end function error_of_best

   !> Whether a number is at most so large; one that is not finite is not
   elemental function within(value, largest)
      real(wp), intent(in) :: value
      real(wp), intent(in) :: largest
      logical :: within

      within = .false.
      if (.not. ieee_is_finite(value)) return
      if (.not. ieee_is_finite(largest)) return
      within = abs(value) <= largest
   end function within

   !> Whether product integration with the shortest step is as far from the best values as its own
   !> convergence says
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
                  *max(self%attempts(attempt_first)%accuracy, best(1))
            end select
            if (.not. within(this%value(attempt_halved(3)) - this%best, allowed)) &
               call object(self, 'the methods do not agree on '//trim(this%name))
            if (.not. settles(this%value(attempt_halved), allowed_change(self)*this%scale)) &
               call object(self, 'direct does not converge to a '//trim(this%name))
         end associate
      end do
   end subroutine judge_distances

   !> Whether the energies close: within the accuracy where one was asked for; with given steps the
   !> imbalance must go to zero as fast as it changes
   pure subroutine judge_energies(self)
      !> The comparison, tabulated
      type(comparison_t), intent(inout) :: self

      type(richardson_t) :: direct
      integer :: i

      do i = attempt_first, attempt_refined
         associate (this => self%attempts(i))
            if (.not. this%made) cycle
            if (.not. within(this%imbalance(), other_quantities*this%accuracy + rounding)) &
               call object(self, 'the energies of '//trim(this%label)//' do not close')
         end associate
      end do
      direct = richardson(self%attempts(attempt_halved)%imbalance())
      if (.not. within(self%attempts(attempt_halved(3))%imbalance(), &
                       honest_factor*direct%error + allowed_change(self)) .or. &
          .not. settles(self%attempts(attempt_halved)%imbalance(), allowed_change(self))) &
         call object(self, 'the energies of direct do not close')
   end subroutine judge_energies

   !> Change from step to step, over the size of a number, that is no matter: what the case allows
   pure function allowed_change(self) result(change)
      type(comparison_t), intent(in) :: self
      real(wp) :: change

      change = other_quantities*self%attempts(attempt_first)%accuracy + rounding
   end function allowed_change

   !> Whether three values get closer to each other, or are close enough. Where they do not, the
   !> error that is estimated from them is large and would allow anything. Where the first one is
   !> right by chance and errors halve at least, the last difference is up to one and a half times
   !> the first: maxima on a grid jump like that
   pure function settles(value, close_enough)
      !> Values with steps halved from one to the next
      real(wp), intent(in) :: value(3)
      !> Difference that is no matter
      real(wp), intent(in) :: close_enough
      logical :: settles

      real(wp), parameter :: chance = 1.5_wp

      settles = all(ieee_is_finite(value))
      if (settles) settles = within(value(3) - value(2), &
         max(chance*abs(value(2) - value(1)), close_enough))
   end function settles

   !> What a quantity is a part of, against which its digits are counted where it is small or none
   pure function size_of_whole(name, outcome) result(whole)
      character(len=*), intent(in) :: name
      type(outcome_t), intent(in) :: outcome
      !> Size of the whole, 0 if the quantity stands for itself
      real(wp) :: whole

      select case (name)
      case ('cor_sphere')
         whole = abs(outcome%cor)
      case ('residual_indentation')
         whole = outcome%max_indentation
      case ('hysteresis_energy')
         whole = outcome%initial_energy
      case default
         whole = 0.0_wp
      end select
   end function size_of_whole

end module vcor_verify_methods
