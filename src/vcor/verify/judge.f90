!> The judge of a comparison: do the solutions agree within the errors they state
module vcor_verify_judge
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_quiet_nan, ieee_value
   use vcor_impact_outcome, only : outcome_t
   use vcor_kinds, only : wp
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_sweep_quantity, only : quantity_value, status_name
   use vcor_verify_solutions, only : attempt_count, attempt_first, attempt_halved, &
      attempt_refined, attempt_t, compared_names, compared_t, comparison_t, object
   implicit none
   private

   public :: judge_ends, judge_numbers, is_honest, error_of_best

   !> How many times the stated error the true one may be: measured over the cases of
   !> tests/reference with the steps used here, it is below 3 wherever it is above `rounding`
   real(wp), parameter :: honest_factor = 3.0_wp
   !> Accuracy of quantities other than cor, and of the energy budget, over that of cor: the steps
   !> are chosen for cor, the others follow with errors of the same order
   real(wp), parameter :: other_quantities = 10.0_wp
   !> What rounding and the error of the reference itself leave of any number, over its size
   real(wp), parameter :: rounding = 1.0e-10_wp

contains

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

end module vcor_verify_judge
