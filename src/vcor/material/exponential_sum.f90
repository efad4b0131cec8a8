!> Sum of decaying exponentials: the form of a modulus that turns the hereditary integral into
!> internal variables
module vcor_material_exponential_sum
   use vcor_kinds, only : wp
   use vcor_numeric_interlacing, only : zeros_between_poles
   implicit none
   private

   public :: exponential_sum_t, same_rate

   !> Relative difference of rates that are the same but for rounding
   real(wp), parameter :: same_rate = 1.0e-13_wp

   !> E(t) = equilibrium + sum_k moduli(k) exp(-rates(k) t) + viscosity delta(t),
   !> Eq. (17) of Green's paper with a dashpot beside the Maxwell elements
   type :: exponential_sum_t
      !> What is left after all relaxation [Pa], >= 0
      real(wp) :: equilibrium = 0.0_wp
      !> Moduli of the Maxwell elements [Pa], > 0, shape (n)
      real(wp), allocatable :: moduli(:)
      !> Relaxation rates of the Maxwell elements [1/s], > 0, shape (n)
      real(wp), allocatable :: rates(:)
      !> Viscosity of the dashpot in parallel [Pa s], >= 0
      real(wp) :: viscosity = 0.0_wp
      !> One of each pair of conjugate terms, of which the real part counts: moduli [Pa] and rates
      !> [1/s], shape (m); not allocated where nothing rings
      complex(wp), allocatable :: pair_moduli(:), pair_rates(:)
      !> Largest relative error against the modulus that it stands for [-]; 0: it is that modulus
      real(wp) :: error = 0.0_wp
   contains
      procedure :: scale
      procedure :: variables
      procedure :: value
      procedure :: integral
      procedure :: complex_modulus
      procedure :: find_zeros
   end type exponential_sum_t

contains

   !> Number of real internal variables: one for each real rate, two for each pair
   pure function variables(self) result(n)
      !> The sum
      class(exponential_sum_t), intent(in) :: self
      !> Number
      integer :: n

      n = size(self%rates)
      if (allocated(self%pair_rates)) n = n + 2*size(self%pair_rates)
   end function variables

   !> Multiply the sum by a factor
   pure subroutine scale(self, factor)
      class(exponential_sum_t), intent(inout) :: self
      !> Factor, > 0
      real(wp), intent(in) :: factor

      self%equilibrium = factor*self%equilibrium
      self%moduli(:) = factor*self%moduli
      self%viscosity = factor*self%viscosity
   end subroutine scale

   !> Value at t > 0; pairs are left out
   elemental function value(self, t) result(modulus)
      class(exponential_sum_t), intent(in) :: self
      !> Time [s], >= 0
      real(wp), intent(in) :: t
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = self%equilibrium + sum(self%moduli*exp(-self%rates*t))
   end function value

   !> Integral from 0 to t, dashpot included
   elemental function integral(self, t) result(value)
      class(exponential_sum_t), intent(in) :: self
      !> Upper limit [s], >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      real(wp) :: half, relaxed
      integer :: k

      ! 1 - exp(-l t) = 2 h/(1 + h), h = tanh(l t/2), to all digits where l t is small
      relaxed = 0.0_wp
      do k = 1, size(self%rates)
         half = tanh(0.5_wp*self%rates(k)*t)
         relaxed = relaxed + self%moduli(k)/self%rates(k)*(2.0_wp*half/(1.0_wp + half))
      end do
      value = self%viscosity + self%equilibrium*t + relaxed
   end function integral

   !> Complex modulus E_0 + sum E_k s/(s + l_k) + viscosity s; pairs are left out
   elemental function complex_modulus(self, s) result(modulus)
      class(exponential_sum_t), intent(in) :: self
      !> Laplace variable [1/s], not at -l_k
      complex(wp), intent(in) :: s
      !> Complex modulus [Pa]
      complex(wp) :: modulus

      modulus = self%equilibrium + self%viscosity*s + sum(self%moduli*(s/(s + self%rates)))
   end function complex_modulus

   !> Poles and zeros of the complex modulus at s = -x, -x (viscosity + sum w_j/(d_j - x)) with the
   !> equilibrium modulus at d = 0: each zero lies between two poles, with a dashpot one more beyond
   !> the last one. Pairs are left out
   pure subroutine find_zeros(self, pole, weight, near, offset)
      class(exponential_sum_t), intent(in) :: self
      !> Poles d [1/s], increasing: 0 where there is an equilibrium modulus, and the rates, equal
      !> ones but for rounding as one
      real(wp), allocatable, intent(out) :: pole(:)
      !> Weights w: their moduli [Pa]
      real(wp), allocatable, intent(out) :: weight(:)
      !> Number of the pole that each zero is counted from
      integer, allocatable, intent(out) :: near(:)
      !> Distance of the zero from it [1/s]
      real(wp), allocatable, intent(out) :: offset(:)

      integer :: i, k, zeros

      allocate (pole(0), weight(0))
      do k = 1, size(self%rates)
         i = 1 + count(pole < self%rates(k)*(1.0_wp - same_rate))
         if (i <= size(pole)) then
            if (pole(i) <= self%rates(k)*(1.0_wp + same_rate)) then
               weight(i) = weight(i) + self%moduli(k)
               cycle
            end if
         end if
         pole = [pole(:i - 1), self%rates(k), pole(i:)]
         weight = [weight(:i - 1), self%moduli(k), weight(i:)]
      end do
      if (self%equilibrium > 0.0_wp) then
         pole = [0.0_wp, pole]
         weight = [self%equilibrium, weight]
      end if
      zeros = size(pole)
      if (.not. self%viscosity > 0.0_wp) zeros = zeros - 1
      allocate (near(zeros), offset(zeros))
      call zeros_between_poles(pole, weight, self%viscosity, near, offset)
   end subroutine find_zeros

end module vcor_material_exponential_sum
