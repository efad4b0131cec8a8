!> How many digits of an outcome can be trusted, from its solutions by several methods
!>
!> The judgement is whether they agree within their stated errors. Of a structure the methods solve
!> the first contact: internal variables follow no other. Its fastest modes ring from the first
!> touch on, which panels longer than their periods smooth and steps follow: largest values and
!> contact time may differ by what both state for it.
module vcor_verify_agreement
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan, ieee_quiet_nan, &
      ieee_value
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_kinds, only : wp
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_sweep_quantity, only : quantity_value, status_name
   implicit none
   private

   public :: attempt_t, compared_t, comparison_t, compared_names
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
      ! with what no step makes smaller of a structure
      if (self%first_contact) best = best + self%attempts(attempt_halved(3))%stated()
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

end module vcor_verify_agreement
