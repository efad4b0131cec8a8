!> The reliance of an impact on a material that was found by a fit, beyond the data of the fit
!>
!> The keys valid_from and valid_to of a material are the band of these data. The reliance is the
!> change of the coefficient of restitution if the modulus is held constant outside of the band,
!> E(t) = E(valid_from) before it and E(valid_to) after it, the effect of the extrapolation on the
!> quantity of interest. Method direct solves both impacts, since it uses the modulus itself; a sum
!> of exponentials would continue to grow before the band. A plate of any thickness has the change
!> of the thin plate, a half space or a layer on a base that without waves. On a structure direct
!> needs a sum of exponentials: where none holds the modulus constant, before the band, it is the
!> change without the structure, if this is of another material. Where direct cannot solve this, as
!> a layer under a ball that deforms as well, method coupled solves both impacts with the mechanics
!> of the case.
module vcor_case_identified
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_case, only : case_t
   use vcor_case_body, only : material_of_case
   use vcor_case_mechanics, only : has_body
   use vcor_case_problem, only : solve_case
   use vcor_case_catalogue, only : find_group
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_kinds, only : wp
   use vcor_material_moduli, only : sampled_times, time_range_t
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: reliance_t, find_reliance

   !> Change of cor that is not reported; the solutions are ten times more accurate
   real(wp), parameter :: reported_change = 1.0e-4_wp
   !> Bound of the contact time, over its value, for any material beyond the data
   real(wp), parameter :: ample = 10.0_wp

   !> Reliance of an impact on a material beyond its data
   type :: reliance_t
      !> Whether the impact relies on it
      logical :: relies = .false.
      !> Index of the material
      integer :: item = 0
      !> Band of its data at the temperature of the impact [s]
      real(wp) :: band(2) = 0.0_wp
      !> Whether the band has a start, and an end
      logical :: ends(2) = .false.
      !> cor with the unchanged modulus [-]
      real(wp) :: cor = 0.0_wp
      !> cor with the modulus held constant outside of the band [-], if `solved`
      real(wp) :: held = 0.0_wp
      !> Whether that impact ends in separation
      logical :: solved = .false.
      !> Whether both impacts are computed, and that with the unchanged modulus ends in separation
      logical :: compared = .false.
      !> Difference of both cor [-]; a huge number if one has no result
      real(wp) :: change = huge(1.0_wp)
   end type reliance_t

contains

   !> Remove shear and shift of a material: its moduli are tensile, at the temperature of the impact
   pure subroutine take_as_is(case, item)
      type(case_t), intent(inout) :: case
      !> Number of the material
      integer, intent(in) :: item

      call case%unset(case%address('material', 'modulus_kind', item))
      call case%unset(case%address('material', 'shift', item))
   end subroutine take_as_is

   !> Replace waves in a plate of any thickness by those of a thin plate, if it is free
   pure subroutine simplify(case)
      type(case_t), intent(inout) :: case

      character(len=:), allocatable :: base, waves
      logical :: is_thick

      call case%get('plate', 'base', base)
      is_thick = .not. case%has_thickness()
      waves = 'hereditary'
      if (is_thick .or. base /= 'free') waves = 'none'
      call case%set(case%address('plate', 'waves'), waves, given=.true.)
   end subroutine simplify

   !> Take the mechanics of a case itself, with method coupled
   pure subroutine use_coupled(case, other)
      type(case_t), intent(in) :: case
      !> The case to be solved
      type(case_t), intent(inout) :: other

      other = case
      call other%set(other%address('solver', 'method'), 'coupled', given=.true.)
      call other%set(other%address('solver', 'accuracy'), 0.1_wp*reported_change)
      call other%unset(other%address('solver', 'time_step'))
      call other%unset(other%address('solver', 'scheme'))
   end subroutine use_coupled

   !> Find the reliance of an impact on a material beyond its data
   subroutine find_reliance(reliance, case, item, contact_time)
      !> The reliance
      type(reliance_t), intent(out) :: reliance
      !> The case, with the parameters of the impact
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      !> Contact time of the impact, which must end in separation [s]
      real(wp), intent(in) :: contact_time

      type(case_t) :: other
      class(material_t), allocatable :: material
      type(error_t), allocatable :: error
      real(wp), allocatable :: times(:), moduli(:)
      real(wp) :: first, last
      logical :: is_body

      reliance%item = item
      call material_of_case(case, item, material, error)
      if (allocated(error)) return
      call case%get('material', 'valid_from', reliance%band(1), item)
      call case%get('material', 'valid_to', reliance%band(2), item)
      ! at the temperature of the impact; NaN for a missing end
      reliance%band = reliance%band*material%time_factor
      first = reliance%band(1)
      last = reliance%band(2)
      reliance%ends = .not. ieee_is_nan(reliance%band)
      if (.not. any(reliance%ends)) return

      if (.not. reliance%ends(2)) last = ample*contact_time
      if (.not. reliance%ends(1)) first = min(1.0e-9_wp*contact_time, 0.1_wp*last)
      ! the contact does not depend on later times
      if (.not. last < ample*contact_time) &
         last = max(ample*contact_time, 2.0_wp*first)
      times = sampled_times(time_range_t(first, last))
      allocate (moduli(size(times)))
      moduli = material%relaxation(times)
      other = case
      is_body = has_body(case)
      if (is_body) call simplify(other)
      call other%set(other%address('solver', 'method'), 'direct', given=.true.)
      call other%set(other%address('solver', 'scheme'), 'product', given=.true.)
      call other%set(other%address('solver', 'accuracy'), 0.1_wp*reported_change)
      call other%unset(other%address('solver', 'time_step'))
      call compare(other, item, is_body, times, moduli, reliance)
      if (.not. reliance%compared .and. case%count('target') > 0 &
          .and. case%material_of('target') /= item) then
         call other%remove(find_group('target'), 1)
         call other%set(other%address('plate', 'waves'), 'none', given=.true.)
         call compare(other, item, is_body, times, moduli, reliance)
      end if
      if (.not. reliance%compared) then
         call use_coupled(case, other)
         call compare(other, item, is_body, times, moduli, reliance)
      end if
      if (.not. reliance%compared) return
      if (reliance%solved) reliance%change = abs(reliance%held - reliance%cor)
      ! a contact that ends before the data begin relies on extrapolation only, whatever the change
      reliance%relies = reliance%change > reported_change &
         .or. (reliance%ends(1) .and. first > contact_time)
   end subroutine find_reliance

   !> Solve an impact with a material as it is, and with its modulus held constant beyond the data
   subroutine compare(case, item, is_body, times, moduli, reliance)
      !> The case to be solved
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      !> Whether cor is that of the sphere alone
      logical, intent(in) :: is_body
      !> Times [s] and moduli [Pa] of the data, shape (n)
      real(wp), intent(in) :: times(:), moduli(:)
      !> The reliance; unchanged if the impact is not solved
      type(reliance_t), intent(inout) :: reliance

      type(case_t) :: other
      type(outcome_t) :: free, held
      type(error_t), allocatable :: error

      call solve_case(case, free, error)
      if (allocated(error)) return
      if (free%status /= contact_separated) return
      reliance%cor = merge(free%cor_sphere, free%cor, is_body)
      other = case
      call other%set(other%address('material', 'model', item), 'table', given=.true.)
      call take_as_is(other, item)
      call other%set(other%address('material', 'times', item), times, given=.true.)
      call other%set(other%address('material', 'moduli', item), moduli, given=.true.)
      call solve_case(other, held, error)
      reliance%compared = .not. allocated(error)
      if (.not. reliance%compared) return
      reliance%solved = held%status == contact_separated
      reliance%held = merge(held%cor_sphere, held%cor, is_body)
   end subroutine compare

end module vcor_case_identified
