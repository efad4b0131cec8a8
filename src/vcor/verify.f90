!> Laws of impact for the verification table, which need no reference solution or have an
!> independent one. The modules under verify/ explain each law
module vcor_verify
   use vcor_error, only : error_internal, error_t, raise
   use vcor_verify_closed_forms, only : hertz, limits, mittag_leffler, power_law, scaling, &
      weak_maxwell, zener
   use vcor_verify_golden, only : beyond, golden, printed
   use vcor_verify_kelvin_voigt, only : exact, pade, series, zener_relation
   use vcor_verify_layer, only : layer
   use vcor_verify_law, only : evaluate_law, law_t, verdict_t
   use vcor_verify_waves, only : waves_of_any_thickness
   implicit none
   private

   public :: law_count, law_t, verdict_t, evaluate_law, build_law

   !> Number of laws
   integer, parameter :: law_count = 16

contains

   !> Build a law by its number
   subroutine build_law(number, law, error)
      !> Number of the law, 1 .. `law_count`
      integer, intent(in) :: number
      type(law_t), intent(out) :: law
      type(error_t), allocatable, intent(out) :: error

      select case (number)
      case (1)
         call hertz(law)
      case (2)
         call zener(law)
      case (3)
         call series(law)
      case (4)
         call pade(law)
      case (5)
         call exact(law)
      case (6)
         call zener_relation(law)
      case (7)
         call weak_maxwell(law)
      case (8)
         call power_law(law)
      case (9)
         call mittag_leffler(law)
      case (10)
         call scaling(law)
      case (11)
         call limits(law)
      case (12)
         call golden(law)
      case (13)
         call beyond(law)
      case (14)
         call waves_of_any_thickness(law)
      case (15)
         call layer(law)
      case (law_count)
         call printed(law)
      case default
         call raise(error, error_internal, 'a law that does not exist')
      end select
   end subroutine build_law

end module vcor_verify
