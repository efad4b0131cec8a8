!> What the comparison of methods is made of
module vcor_verify_comparison_type
   use vcor_kinds, only : wp
   use vcor_numeric_richardson, only : richardson_t
   use vcor_verify_attempt, only : attempt_t
   implicit none
   private

   public :: comparison_t, compared_t, object
   public :: attempt_count, attempt_case, attempt_first, attempt_refined, attempt_halved
   public :: compared_names

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

   !> One quantity by all methods
   type :: compared_t
      !> Its name
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
      logical :: two_methods = .false.
      !> Whether the bodies separate in all solutions
      logical :: separated = .false.
      !> Quantities, defined if they separate
      type(compared_t) :: compared(size(compared_names))
      !> The first thing that is wrong, one line; unallocated if nothing is
      character(len=:), allocatable :: objection
   end type comparison_t

contains

   !> Note what is wrong, the first time
   pure subroutine object(self, objection)
      !> The comparison
      type(comparison_t), intent(inout) :: self
      !> One line
      character(len=*), intent(in) :: objection

      if (.not. allocated(self%objection)) self%objection = objection
   end subroutine object

end module vcor_verify_comparison_type
