!> The collocation rules of the internal-variable method, for the solution and for its companion,
!> and the tolerances of Newton's method
module vcor_solver_ive_collocator
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : apply, width
   use vcor_numeric_radau_collocation, only : collocation_t, new_collocation
   use vcor_tuning, only : near_tolerance, newton_tolerance
   implicit none
   private

   public :: collocator_t, new_collocator

   !> Stages of the solution: enough for an impact in three panels, few enough for eigenvectors of
   !> the integration matrices that cost only four digits
   integer, parameter :: stages = width
   !> Stages of the companion
   integer, parameter :: fewer_stages = stages - 1

   !> Collocation rules; immutable once built
   type :: collocator_t
      !> Rule of the panels
      type(collocation_t) :: rule
      !> Rule of the companion
      type(collocation_t) :: coarse
      !> Interpolation from the points of `rule` to the nodes of `coarse`
      real(wp) :: to_coarse(width, 0:width) = 0.0_wp
      !> Interpolation from the nodes of `coarse` to those of `rule`, for values that are 0 at the
      !> start
      real(wp) :: from_coarse(width, width) = 0.0_wp
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp) :: second_coefficient = 0.0_wp
      !> Error left by Newton's method in the indentation, over its largest value
      real(wp) :: tolerance = 0.0_wp
      !> The same at the end of a panel solved with the Jacobian of another: a companion, whose
      !> difference to the solution is needed to two digits only, or a panel cut at the end of the
      !> contact
      real(wp) :: near_tolerance = 0.0_wp
   contains
      procedure :: coarsened
   end type collocator_t

contains

   !> Build the rules
   subroutine new_collocator(self, accuracy, second_coefficient, error)
      type(collocator_t), intent(out) :: self
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Coefficient of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp), intent(in) :: second_coefficient
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: unit(0:stages)
      integer :: i, j

      self%second_coefficient = second_coefficient
      ! rounding in products with a matrix
      self%tolerance = max(width**2*epsilon(1.0_wp), newton_tolerance*accuracy)
      self%near_tolerance = max(width**2*epsilon(1.0_wp), near_tolerance*accuracy)
      call new_collocation(self%rule, stages, error)
      if (allocated(error)) return
      call new_collocation(self%coarse, fewer_stages, error)
      if (allocated(error)) return

      do j = 0, stages
         unit = 0.0_wp
         unit(j) = 1.0_wp
         do i = 1, fewer_stages
            self%to_coarse(i, j) = self%rule%interpolate(unit, self%coarse%node(i))
         end do
      end do
      do j = 1, fewer_stages
         unit = 0.0_wp
         unit(j) = 1.0_wp
         do i = 1, stages
            self%from_coarse(i, j) = self%coarse%interpolate(unit, self%rule%node(i))
         end do
      end do
   end subroutine new_collocator

   !> Values of a polynomial at the nodes of `coarse`
   pure function coarsened(self, value) result(coarse)
      class(collocator_t), intent(in) :: self
      !> Values at the points of `rule`
      real(wp), intent(in) :: value(0:width)
      !> Values at the nodes of `coarse`
      real(wp) :: coarse(width)

      coarse = self%to_coarse(:, 0)*value(0) + apply(self%to_coarse(:, 1:), value(1:))
   end function coarsened

end module vcor_solver_ive_collocator
