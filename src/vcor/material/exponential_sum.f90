!> Sum of decaying exponentials: the form of a modulus for which the hereditary integral becomes a
!> set of internal variables
module vcor_material_exponential_sum
   use vcor_kinds, only : wp
   use vcor_tuning, only : most_iterations
   implicit none
   private

   public :: exponential_sum_t, parts, same_rate

   integer :: i_part
   !> Parts of a window up to which the integrals of a sum and of what it stands for are compared
   real(wp), parameter :: parts(*) = [(real(i_part, wp)/3.0_wp, i_part=1, 3)]

   !> Relative difference up to which two rates are the same but for rounding: 450 times epsilon;
   !> with 1e-10 no random impact changes
   real(wp), parameter :: same_rate = 1.0e-13_wp

   !> E(t) = equilibrium + sum_k moduli(k) exp(-rates(k) t) + viscosity delta(t),
   !> Eq. (17) of Green's paper with a dashpot parallel to the Maxwell elements
   type :: exponential_sum_t
      !> Equilibrium modulus [Pa], >= 0
      real(wp) :: equilibrium = 0.0_wp
      !> Moduli of the Maxwell elements [Pa], > 0, shape (n)
      real(wp), allocatable :: moduli(:)
      !> Relaxation rates of the Maxwell elements [1/s], > 0, shape (n)
      real(wp), allocatable :: rates(:)
      !> Viscosity of the dashpot in parallel [Pa s], >= 0
      real(wp) :: viscosity = 0.0_wp
      !> Estimated largest relative error of the integral of the sum, if it approximates a modulus
      !> [-]; 0: exact
      real(wp) :: error = 0.0_wp
   contains
      procedure :: scale
      procedure :: value
      procedure :: integral
      procedure :: compare
      procedure :: complex_modulus
      procedure :: find_zeros
   end type exponential_sum_t

contains

   !> Multiply the sum by a factor
   pure subroutine scale(self, factor)
      class(exponential_sum_t), intent(inout) :: self
      !> Factor, > 0
      real(wp), intent(in) :: factor

      self%equilibrium = factor*self%equilibrium
      self%moduli(:) = factor*self%moduli
      self%viscosity = factor*self%viscosity
   end subroutine scale

   !> Value at t > 0
   elemental function value(self, t) result(modulus)
      class(exponential_sum_t), intent(in) :: self
      !> Time [s], >= 0
      real(wp), intent(in) :: t
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = self%equilibrium
      if (allocated(self%moduli)) modulus = modulus + sum(self%moduli*exp(-self%rates*t))
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

      ! 1 - exp(-l t) = 2 h/(1 + h), h = tanh(l t/2), which keeps all digits for small l t
      value = self%viscosity + self%equilibrium*t
      if (.not. allocated(self%rates)) return
      relaxed = 0.0_wp
      do k = 1, size(self%rates)
         half = tanh(0.5_wp*self%rates(k)*t)
         relaxed = relaxed + self%moduli(k)/self%rates(k)*(2.0_wp*half/(1.0_wp + half))
      end do
      value = value + relaxed
   end function integral

   !> Set the error by integrals of what the sum stands for. A force is the integral of a modulus
   !> times a smooth rate, so errors of the modulus count as those of its integral
   pure subroutine compare(self, window, expected)
      class(exponential_sum_t), intent(inout) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Integrals from 0 to `parts` of the window, dashpot included [Pa s], > 0, same shape
      real(wp), intent(in) :: expected(:)

      real(wp) :: found(size(parts)), half, once, relaxed, scale
      integer :: i, k

      found = self%viscosity + self%equilibrium*window*parts
      do k = 1, size(self%rates)
         ! 1 - exp(-l t) for the first part, as in `integral`; by it for the others, as the parts
         ! are of equal length
         half = tanh(0.5_wp*self%rates(k)*(window*parts(1)))
         once = 2.0_wp*half/(1.0_wp + half)
         scale = self%moduli(k)/self%rates(k)
         relaxed = 0.0_wp
         do i = 1, size(parts)
            relaxed = relaxed + once*(1.0_wp - relaxed)
            found(i) = found(i) + scale*relaxed
         end do
      end do
      self%error = maxval(abs(found/expected - 1.0_wp))
   end subroutine compare

   !> Complex modulus E_0 + sum E_k s/(s + l_k) + viscosity s
   elemental function complex_modulus(self, s) result(modulus)
      class(exponential_sum_t), intent(in) :: self
      !> Laplace variable [1/s], not at -l_k
      complex(wp), intent(in) :: s
      !> Complex modulus [Pa]
      complex(wp) :: modulus

      modulus = self%equilibrium + self%viscosity*s
      if (allocated(self%moduli)) modulus = modulus + sum(self%moduli*(s/(s + self%rates)))
   end function complex_modulus

   !> Poles and zeros at s = -x of the complex modulus,
   !> -x (viscosity + sum w_j/(d_j - x)), with the equilibrium modulus as a pole d = 0. One zero
   !> lies between two adjacent poles, and with a dashpot one beyond the last
   pure subroutine find_zeros(self, pole, weight, near, offset)
      class(exponential_sum_t), intent(in) :: self
      !> Poles d [1/s], increasing: 0 if there is an equilibrium modulus, then the rates; rates that
      !> differ by rounding are one pole
      real(wp), allocatable, intent(out) :: pole(:)
      !> Weights w: the moduli [Pa]
      real(wp), allocatable, intent(out) :: weight(:)
      !> Number of the pole from which each zero is measured
      integer, allocatable, intent(out) :: near(:)
      !> Distance of the zero from that pole [1/s]
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

   !> Zeros of f(x) = c + sum_j w_j/(d_j - x), w_j > 0, which rises from minus to plus infinity
   !> between two poles: one zero lies in each gap, and one beyond the last pole if c > 0. Each is
   !> returned as its distance from the nearest pole: differences between zeros and poles then keep
   !> all their digits
   pure subroutine zeros_between_poles(pole, weight, constant, near, offset)
      !> Poles d, strictly increasing, shape (n)
      real(wp), intent(in) :: pole(:)
      !> Weights w, > 0, shape (n)
      real(wp), intent(in) :: weight(:)
      !> Constant c >= 0
      real(wp), intent(in) :: constant
      !> Number of the pole from which each zero is measured, shape (n - 1), (n) if c > 0
      integer, intent(out) :: near(:)
      !> Signed distance of each zero from that pole, same shape
      real(wp), intent(out) :: offset(:)

      real(wp) :: gap
      integer :: i, n

      n = size(pole)
      do i = 1, n - 1
         gap = pole(i + 1) - pole(i)
         ! f rises: if it is positive at the midpoint, the zero is in the lower half
         if (value_at(i, 0.5_wp*gap) > 0.0_wp) then
            near(i) = i
            offset(i) = root(i, 1.0_wp, 0.5_wp*gap)
         else
            near(i) = i + 1
            offset(i) = -root(i + 1, -1.0_wp, 0.5_wp*gap)
         end if
      end do
      if (constant > 0.0_wp .and. n > 0) then
         near(n) = n
         ! the zero is farthest away if all poles coincide with the last one
         offset(n) = root(n, 1.0_wp, sum(weight)/constant)
      end if

   contains

      !> f at a distance from a pole
      pure function value_at(j, distance) result(value)
         !> Number of the pole
         integer, intent(in) :: j
         !> Distance, not 0
         real(wp), intent(in) :: distance
         real(wp) :: value

         value = constant + sum(weight/((pole - pole(j)) - distance))
      end function value_at

      !> Distance of the zero from a pole: Newton's method for distance*f, which is regular at the
      !> pole, safeguarded by bisection
      pure function root(j, side, farthest) result(distance)
         !> Number of the pole
         integer, intent(in) :: j
         !> Side of the pole, 1 or -1
         real(wp), intent(in) :: side
         !> Upper bound of the distance
         real(wp), intent(in) :: farthest
         !> Distance, > 0
         real(wp) :: distance

         real(wp) :: lower, upper, others, slope, g, next, difference(size(pole)), term(size(pole))
         integer :: iteration

         ! g = side*distance*f rises through its zero
         lower = 0.0_wp
         upper = farthest
         distance = 0.5_wp*farthest
         do iteration = 1, most_iterations
            difference = (pole - pole(j)) - side*distance
            difference(j) = 1.0_wp
            term = weight/difference
            term(j) = 0.0_wp
            others = constant + sum(term)
            slope = side*sum(term/difference)
            g = side*(distance*others) - weight(j)
            if (.not. abs(g) > 0.0_wp) return
            if (g > 0.0_wp) then
               upper = distance
            else
               lower = distance
            end if
            next = distance - g/(side*(others + distance*slope))
            if (.not. (next > lower .and. next < upper)) next = 0.5_wp*(lower + upper)
            if (abs(next - distance) <= 2.0_wp*epsilon(1.0_wp)*distance) then
               distance = next
               return
            end if
            distance = next
         end do
      end function root
   end subroutine zeros_between_poles

end module vcor_material_exponential_sum
