!> Moduli of materials against time and frequency, the data of Figs. 1 and 5
module vcor_material_moduli
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan, ieee_positive_inf, &
      ieee_quiet_nan, ieee_value
   use vcor_error, only : error_t, error_usage, raise
   use vcor_kinds, only : pi, wp
   use vcor_material_type, only : material_t
   use vcor_number, only : log_spacing, real_text, spaced
   implicit none
   private

   public :: moduli_t, curves_t, time_range_t
   public :: compute_moduli, sampled_times, usual_range, loss_tangent

   ! The range that is shown is a choice: it has to contain the contact and, if near, the plateaus

   !> Points per decade by default
   integer, parameter :: per_decade = 50
   !> Fewest decades shown before and after the contact time
   integer, parameter :: least_before = 3, least_after = 1
   !> Most decades added on either side to reach the plateaus of the modulus
   integer, parameter :: most_before = 10, most_after = 8
   !> Decades added where there is no plateau
   integer, parameter :: singular_before = 5, fluid_after = 3
   !> Relative distance from a plateau at which it counts as reached
   real(wp), parameter :: near = 0.05_wp

   !> Times at which a modulus is evaluated, equally spaced in the logarithm
   type :: time_range_t
      !> First time [s]; 0: chosen automatically
      real(wp) :: first = 0.0_wp
      !> Last time [s]; 0: chosen automatically
      real(wp) :: last = 0.0_wp
      !> Number of points, >= 2; 0: 50 per decade
      integer :: points = 0
   end type time_range_t

   !> Moduli of one material
   type :: curves_t
      !> Its model
      character(len=:), allocatable :: model
      !> The material; a rigid one has no curves
      class(material_t), allocatable :: material
      !> Relaxation modulus at the contact time [Pa]; this and the next two are NaN if there is none
      real(wp) :: at_contact_time = 0.0_wp
      !> Storage modulus at the lowest frequency of interest [Pa]
      real(wp) :: storage_at_min = 0.0_wp
      !> Loss modulus at the lowest frequency of interest [Pa]
      real(wp) :: loss_at_min = 0.0_wp
      !> Relaxation modulus E(t) [Pa], shape (points)
      real(wp), allocatable :: relaxation(:)
      !> Storage modulus E' [Pa], shape (points)
      real(wp), allocatable :: storage(:)
      !> Loss modulus E'' [Pa], shape (points)
      real(wp), allocatable :: loss(:)
   end type curves_t

   !> Moduli of materials over the times of one range
   type :: moduli_t
      !> Contact time t0 of the impact [s]; 0 if it does not end
      real(wp) :: contact_time = 0.0_wp
      !> Lowest frequency of interest 2 pi/t0 [rad/s]; 0 without a contact time
      real(wp) :: min_frequency = 0.0_wp
      !> Times [s], increasing, shape (points)
      real(wp), allocatable :: times(:)
      !> Angular frequencies [rad/s], the reciprocals of the times, increasing, shape (points)
      real(wp), allocatable :: frequencies(:)
      !> The materials, shape (n)
      type(curves_t), allocatable :: materials(:)
   end type moduli_t

contains

   !> Compute the moduli of materials
   subroutine compute_moduli(self, contact_time, reference, range, error)
      !> Models and materials are there, their moduli afterwards
      type(moduli_t), intent(inout) :: self
      !> Contact time of the impact [s]; 0 if it does not end
      real(wp), intent(in) :: contact_time
      !> Time around which the range is chosen [s], > 0: the contact time, or the time scale of a
      !> contact that does not end
      real(wp), intent(in) :: reference
      !> Times requested
      type(time_range_t), intent(in) :: range
      !> Error of code `error_usage` if the range is empty, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(time_range_t) :: all, usual
      integer :: i, n

      n = size(self%materials)
      all = time_range_t(huge(1.0_wp), 0.0_wp, range%points)
      do i = 1, n
         usual = usual_range(self%materials(i)%material, reference)
         if (self%materials(i)%material%rigid .and. n > 1) cycle
         all%first = min(all%first, usual%first)
         all%last = max(all%last, usual%last)
      end do
      if (range%first > 0.0_wp) all%first = range%first
      if (range%last > 0.0_wp) all%last = range%last
      if (.not. all%first < all%last) then
         call raise(error, error_usage, 'found times from '//real_text(all%first)//' to ' &
            //real_text(all%last)//' s, expected --from before --to')
         return
      end if

      self%contact_time = contact_time
      if (contact_time > 0.0_wp) self%min_frequency = 2.0_wp*pi/contact_time
      self%times = sampled_times(all)
      self%frequencies = sampled_times(time_range_t(1.0_wp/all%last, 1.0_wp/all%first, all%points))
      do i = 1, n
         call trace(self%materials(i), self)
      end do
   end subroutine compute_moduli

   !> Compute the curves of one material
   pure subroutine trace(curves, moduli)
      type(curves_t), intent(inout) :: curves
      !> Times and frequencies
      type(moduli_t), intent(in) :: moduli

      complex(wp) :: modulus(size(moduli%frequencies))
      complex(wp) :: at_min

      associate (material => curves%material)
         curves%at_contact_time = material%glassy()
         curves%storage_at_min = material%glassy()
         if (material%rigid) return
         curves%at_contact_time = ieee_value(1.0_wp, ieee_quiet_nan)
         curves%storage_at_min = curves%at_contact_time
         curves%loss_at_min = curves%at_contact_time
         ! gfortran 12 does not allocate the result of an elemental type-bound function
         allocate (curves%relaxation(size(moduli%times)))
         curves%relaxation = material%relaxation(moduli%times)
         modulus = material%complex_modulus(cmplx(0.0_wp, moduli%frequencies, wp))
         curves%storage = real(modulus, wp)
         curves%loss = aimag(modulus)
         if (.not. moduli%contact_time > 0.0_wp) return
         at_min = material%complex_modulus(cmplx(0.0_wp, moduli%min_frequency, wp))
         curves%at_contact_time = material%relaxation(moduli%contact_time)
         curves%storage_at_min = real(at_min, wp)
         curves%loss_at_min = aimag(at_min)
      end associate
   end subroutine trace

   !> Loss tangent E''/E'
   elemental function loss_tangent(storage, loss) result(tangent)
      !> Storage modulus [Pa], >= 0
      real(wp), intent(in) :: storage
      !> Loss modulus [Pa], >= 0
      real(wp), intent(in) :: loss
      !> The ratio; infinite for a fluid without elasticity
      real(wp) :: tangent

      if (ieee_is_nan(loss)) then
         tangent = loss
      else if (.not. loss > 0.0_wp) then
         tangent = 0.0_wp
      else if (storage > loss*1.0e-300_wp) then
         tangent = loss/storage
      else
         tangent = ieee_value(1.0_wp, ieee_positive_inf)
      end if
   end function loss_tangent

   !> Whole decades from the glassy plateau to the rubbery one, as far as they are within reach of a
   !> reference time, which is included
   pure function usual_range(material, reference) result(range)
      class(material_t), intent(in) :: material
      !> Reference time [s], > 0
      real(wp), intent(in) :: reference
      type(time_range_t) :: range

      real(wp) :: glassy, rubbery
      integer :: first, last, least, most

      glassy = material%glassy()
      rubbery = material%rubbery()
      least = floor(log10(reference)) - least_before
      most = ceiling(log10(reference)) + least_after
      first = least
      last = most
      if (.not. material%rigid) then
         if (ieee_is_finite(glassy)) then
            do while (first > least - most_before &
               .and. material%relaxation(10.0_wp**first) < (1.0_wp - near)*glassy)
               first = first - 1
            end do
         else
            first = least - singular_before
         end if
         if (rubbery > 0.0_wp) then
            do while (last < most + most_after &
               .and. material%relaxation(10.0_wp**last) > (1.0_wp + near)*rubbery)
               last = last + 1
            end do
         else
            last = most + fluid_after
         end if
      end if
      range = time_range_t(10.0_wp**first, 10.0_wp**last)
   end function usual_range

   !> Times of a range
   pure function sampled_times(range) result(times)
      !> The range, both ends given
      type(time_range_t), intent(in) :: range
      !> Times [s], equally spaced on the logarithmic scale, both ends included
      real(wp), allocatable :: times(:)

      integer :: n

      n = range%points
      if (n == 0) n = 1 + max(1, nint(per_decade*log10(range%last/range%first)))
      times = spaced(range%first, range%last, n, log_spacing)
   end function sampled_times

end module vcor_material_moduli
