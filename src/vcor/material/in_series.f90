!> Two materials in series: the force is the same in both and the deformations add, so the creep
!> compliances add in the Laplace domain
!>
!>     1/Q = 1/Q_a + 1/Q_b,   Q = s L{E}(s)
!>
!> Two Prony series in series are a Prony series. Its rates are the zeros of P = Q_a + Q_b, one
!> between any two adjacent rates of both, and the rates that both have in common; the modulus of a
!> rate l is Q_a^2/(l P') at s = -l. Other pairs are evaluated by inversion of the transform, and
!> their sum of exponentials follows from the spectrum.
module vcor_material_in_series
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t, same_rate
   use vcor_material_prony, only : new_prony, prony_t
   use vcor_material_spectrum, only : sum_of_resolved_spectrum, transform_t
   use vcor_material_type, only : material_t
   use vcor_tuning, only : sum_most
   implicit none
   private

   public :: new_in_series

   !> Two materials in series of which at least one is no Prony series
   type, extends(transform_t) :: in_series_t
      private
      !> The first material
      class(material_t), allocatable :: first
      !> The second material
      class(material_t), allocatable :: second
      !> Factor of the first modulus
      real(wp) :: first_factor = 1.0_wp
      !> Factor of the second modulus
      real(wp) :: second_factor = 1.0_wp
      !> Sum of exponentials of the pair if both moduli are represented by such sums, else
      !> unallocated
      type(exponential_sum_t), allocatable :: terms
   contains
      procedure :: complex_modulus
      procedure :: glassy
      procedure :: rubbery
      procedure :: exponentials
   end type in_series_t

contains

   !> Put two materials in series
   pure subroutine new_in_series(self, first, first_factor, second, second_factor, error)
      !> The pair; not allocated on entry, nor on failure
      class(material_t), allocatable, intent(inout) :: self
      !> First material, not rigid
      class(material_t), intent(in) :: first
      !> Factor of its modulus, > 0
      real(wp), intent(in) :: first_factor
      !> Second material, not rigid
      class(material_t), intent(in) :: second
      !> Factor of its modulus, > 0
      real(wp), intent(in) :: second_factor
      type(error_t), allocatable, intent(out) :: error

      type(in_series_t), allocatable :: series
      type(prony_t), allocatable :: prony
      type(exponential_sum_t) :: a, b

      if (first%discrete .and. second%discrete) then
         call first%exponentials(1.0_wp, 1.0_wp, a)
         call second%exponentials(1.0_wp, 1.0_wp, b)
         call a%scale(first_factor)
         call b%scale(second_factor)
         allocate (prony)
         call combine(a, b, prony, error)
         if (allocated(error)) return
         if (.not. max(a%error, b%error) > 0.0_wp) then
            call move_alloc(prony, self)
            return
         end if
      end if

      allocate (series)
      if (allocated(prony)) then
         allocate (series%terms)
         call prony%exponentials(1.0_wp, 1.0_wp, series%terms)
      end if
      call series%prepare()
      series%discrete = allocated(series%terms)
      allocate (series%first, source=first)
      allocate (series%second, source=second)
      series%first_factor = first_factor
      series%second_factor = second_factor
      series%viscosity = in_series(first_factor*first%viscosity, second_factor*second%viscosity)
      call move_alloc(series, self)
   end subroutine new_in_series

   !> a b/(a + b), also if one is infinite or both are zero
   pure function in_series(a, b) result(value)
      !> First number, >= 0
      real(wp), intent(in) :: a
      !> Second number, >= 0
      real(wp), intent(in) :: b
      real(wp) :: value

      value = 0.0_wp
      if (min(a, b) > 0.0_wp) value = 1.0_wp/(1.0_wp/a + 1.0_wp/b)
   end function in_series

   !> Prony series of two Prony series in series
   pure subroutine combine(a, b, prony, error)
      !> First series
      type(exponential_sum_t), intent(in) :: a
      !> Second series
      type(exponential_sum_t), intent(in) :: b
      !> The resulting series
      type(prony_t), intent(out) :: prony
      type(error_t), allocatable, intent(out) :: error

      ! moduli divided by the glassy one that are rounding: squares of parts that cancel, eps^2 =
      ! 5e-32
      real(wp), parameter :: nothing = 1.0e-30_wp
      type(exponential_sum_t) :: both
      real(wp), allocatable :: pole(:), weight(:), offset(:), of_a(:), of_b(:), distance(:)
      integer, allocatable :: near(:)
      real(wp), dimension(size(a%rates) + size(b%rates) + 1) :: rate, modulus
      real(wp) :: part_a, part_b
      logical :: kept(size(rate))
      integer :: k, zeros

      both%equilibrium = a%equilibrium + b%equilibrium
      both%rates = [a%rates, b%rates]
      both%moduli = [a%moduli, b%moduli]
      both%viscosity = a%viscosity + b%viscosity
      call both%find_zeros(pole, weight, near, offset)
      of_a = moduli_at(a, pole)
      of_b = moduli_at(b, pole)

      zeros = size(near)
      do k = 1, zeros
         rate(k) = pole(near(k)) + offset(k)
         distance = (pole - pole(near(k))) - offset(k)
         ! Q_a = -l part_a = -Q_b: the parts differ in sign and rounding; the smaller one is right
         part_a = a%viscosity + sum(of_a/distance)
         part_b = b%viscosity + sum(of_b/distance)
         modulus(k) = min(part_a**2, part_b**2)/sum(weight/distance**2)
      end do
      ! a rate that both have remains a rate
      do k = 1, size(pole)
         if (.not. (pole(k) > 0.0_wp .and. min(of_a(k), of_b(k)) > 0.0_wp)) cycle
         zeros = zeros + 1
         rate(zeros) = pole(k)
         modulus(zeros) = in_series(of_a(k), of_b(k))
      end do
      kept(:zeros) = modulus(:zeros) > nothing*sum(modulus(:zeros))
      call new_prony(prony, in_series(a%equilibrium, b%equilibrium), &
         pack(modulus(:zeros), kept(:zeros)), pack(rate(:zeros), kept(:zeros)), &
         in_series(a%viscosity, b%viscosity), error)
   end subroutine combine

   !> Moduli of a series at given rates, and its equilibrium modulus at rate 0
   pure function moduli_at(series, rates) result(moduli)
      type(exponential_sum_t), intent(in) :: series
      !> Rates [1/s], shape (n)
      real(wp), intent(in) :: rates(:)
      !> Moduli [Pa], 0 at rates that the series does not have, shape (n)
      real(wp) :: moduli(size(rates))

      integer :: k

      do k = 1, size(rates)
         moduli(k) = sum(series%moduli, &
            mask=abs(series%rates - rates(k)) <= same_rate*rates(k))
         if (.not. rates(k) > 0.0_wp) moduli(k) = series%equilibrium
      end do
   end function moduli_at

   !> Complex modulus Q_a Q_b/(Q_a + Q_b)
   elemental function complex_modulus(self, s) result(modulus)
      class(in_series_t), intent(in) :: self
      !> Laplace variable [1/s]
      complex(wp), intent(in) :: s
      !> Complex modulus [Pa]
      complex(wp) :: modulus

      modulus = 1.0_wp/(1.0_wp/(self%first_factor*self%first%complex_modulus(s)) &
         + 1.0_wp/(self%second_factor*self%second%complex_modulus(s)))
   end function complex_modulus

   !> Glassy modulus without the dashpot; a body with a dashpot is rigid at first
   pure function glassy(self) result(modulus)
      class(in_series_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      real(wp) :: a, b

      a = self%first_factor*self%first%glassy()
      b = self%second_factor*self%second%glassy()
      if (self%viscosity > 0.0_wp) then
         ! limit of Q - viscosity*s for s -> infinity
         associate (eta_a => self%first_factor*self%first%viscosity, &
                    eta_b => self%second_factor*self%second%viscosity)
            modulus = a*(eta_b/(eta_a + eta_b))**2 + b*(eta_a/(eta_a + eta_b))**2
         end associate
      else if (self%first%viscosity > 0.0_wp) then
         modulus = b
      else if (self%second%viscosity > 0.0_wp) then
         modulus = a
      else if (.not. ieee_is_finite(a)) then
         modulus = b
      else if (.not. ieee_is_finite(b)) then
         modulus = a
      else
         modulus = in_series(a, b)
      end if
   end function glassy

   !> Rubbery modulus
   pure function rubbery(self) result(modulus)
      class(in_series_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = in_series(self%first_factor*self%first%rubbery(), &
         self%second_factor*self%second%rubbery())
   end function rubbery

   !> The modulus as a sum of exponentials, from its spectrum
   pure subroutine exponentials(self, window, accuracy, terms)
      class(in_series_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      type(exponential_sum_t), intent(out) :: terms

      type(exponential_sum_t) :: one, other

      if (allocated(self%terms)) then
         ! the modulus of two in series errs at most as one of both does, relative
         call self%first%exponentials(window, accuracy, one)
         call self%second%exponentials(window, accuracy, other)
         terms = self%terms
         terms%error = max(one%error, other%error)
         return
      end if
      call sum_of_resolved_spectrum(self, window, accuracy, sum_most, terms)
   end subroutine exponentials

end module vcor_material_in_series
