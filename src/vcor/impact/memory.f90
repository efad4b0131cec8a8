!> Memory psi of a viscoelastic thin plate: the dependence of its velocity on the force in the past
!>
!> By the correspondence principle the elastic deflection, U' = A F/sqrt(E'_b), becomes in the
!> Laplace domain, with Q_b = s L{E'_b},
!>
!>     s U = A F/sqrt(Q_b),   U'(t) = alpha F + int_0^t psi(t - x) F(x) dx
!>
!> with alpha = A/sqrt(Q_b(oo)). A s/sqrt(Q_b) has all properties of the complex modulus of a
!> material and is implemented as one, with relaxation modulus psi and dashpot alpha. 1/sqrt(Q_b) is
!> a Stieltjes function, so psi = int w(l) exp(-l t) dl, w >= 0,
!> with w(l) = -(A/pi) Im 1/sqrt(Q_b(-l + i0)).
module vcor_impact_memory
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_positive_inf, ieee_value
   use vcor_kinds, only : pi, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_spectrum, only : constant_rate, farthest_rate, finest_inversion, &
      sum_of_resolved_spectrum, transform_t
   use vcor_material_type, only : material_t
   use vcor_numeric_elliptic, only : branch_rule
   use vcor_tuning, only : spectrum_most
   implicit none
   private

   public :: memory_t, new_memory

   !> Zeros and poles of Q_b(-l) if the material is a sum of exponentials: zero i lies between pole
   !> i and pole i + 1, where pole 1 = 0 is not a pole of Q_b; with a dashpot the last zero is
   !> beyond the last pole
   type :: gaps_t
      !> Poles d [1/s], and their weights w in Q_b(-l) = -l (viscosity + sum w_j/(d_j - l)) [Pa]
      real(wp), allocatable :: pole(:), weight(:)
      !> Number of the pole from which each zero is measured
      integer, allocatable :: near(:)
      !> Distance of each zero from that pole [1/s]
      real(wp), allocatable :: offset(:)
   end type gaps_t

   !> Velocity of the plate per force, as a modulus [m/(N s)], in time [m/(N s2)]
   type, extends(transform_t) :: memory_t
      private
      !> Material of the plate
      class(material_t), allocatable :: material
      !> Coefficient A, including the plane-strain factor [Pa^0.5 m/(N s)]
      real(wp) :: coefficient = 0.0_wp
      !> Zeros and poles if the material is a sum of exponentials
      type(gaps_t) :: gaps
   contains
      procedure :: complex_modulus
      procedure :: glassy
      procedure :: rubbery
      procedure :: exponentials
   end type memory_t

contains

   !> Build the memory of a plate
   pure subroutine new_memory(self, material, coefficient)
      type(memory_t), intent(out) :: self
      !> Material of the plate, neither rigid nor elastic
      class(material_t), intent(in) :: material
      !> A such that an elastic plate has U' = A F/sqrt(E_b) [Pa^0.5 m/(N s)], > 0
      real(wp), intent(in) :: coefficient

      type(exponential_sum_t) :: terms
      real(wp) :: modulus

      call self%prepare()
      allocate (self%material, source=material)
      self%coefficient = coefficient
      modulus = material%glassy()
      if (material%discrete) then
         call material%exponentials(1.0_wp, 1.0_wp, terms)
         modulus = terms%equilibrium + sum(terms%moduli)
         call find_gaps(self%gaps, terms)
      end if
      if (ieee_is_finite(modulus) .and. .not. material%viscosity > 0.0_wp) &
         self%viscosity = coefficient/sqrt(modulus)
   end subroutine new_memory

   !> Find zeros and poles
   pure subroutine find_gaps(gaps, material)
      !> Zeros and poles
      type(gaps_t), intent(out) :: gaps
      type(exponential_sum_t), intent(in) :: material

      call material%find_zeros(gaps%pole, gaps%weight, gaps%near, gaps%offset)
      if (material%equilibrium > 0.0_wp) return
      ! Q_b is proportional to l at 0: a zero
      gaps%near = [1, gaps%near + 1]
      gaps%offset = [0.0_wp, gaps%offset]
      gaps%pole = [0.0_wp, gaps%pole]
      gaps%weight = [0.0_wp, gaps%weight]
   end subroutine find_gaps

   !> A s/sqrt(Q_b(s)), on the branch that is positive for s > 0
   elemental function complex_modulus(self, s) result(modulus)
      class(memory_t), intent(in) :: self
      !> Laplace variable [1/s]
      complex(wp), intent(in) :: s
      !> Velocity per force [m/(N s2)]
      complex(wp) :: modulus

      modulus = self%coefficient*s/sqrt(self%material%complex_modulus(s))
   end function complex_modulus

   !> psi(0): not used by any solver; set to infinity, which it is for singular kernels
   pure function glassy(self) result(modulus)
      class(memory_t), intent(in) :: self
      !> Infinite
      real(wp) :: modulus

      modulus = ieee_value(self%coefficient, ieee_positive_inf)
   end function glassy

   !> psi(infinity)
   pure function rubbery(self) result(modulus)
      class(memory_t), intent(in) :: self
      !> Zero
      real(wp) :: modulus

      modulus = 0.0_wp*self%coefficient
   end function rubbery

   !> The memory as a sum of exponentials, with alpha as its viscosity; `terms%error` is that of the
   !> velocity under a constant force, over that velocity
   pure subroutine exponentials(self, window, accuracy, terms)
      class(memory_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      type(exponential_sum_t), intent(out) :: terms

      type(exponential_sum_t) :: next
      real(wp) :: wanted
      integer :: refinement

      wanted = max(accuracy, finest_inversion)
      if (.not. self%material%discrete) then
         call sum_of_resolved_spectrum(self, window, wanted, spectrum_most, terms)
      else
         terms%error = huge(1.0_wp)
         refinement = 0
         do
            refinement = refinement + 1
            call sum_over_gaps(self, self%gaps, window, wanted**refinement, next)
            next%error = error_of(self, window, next)
            if (.not. next%error < terms%error) exit
            terms = next
            if (terms%error <= wanted) exit
         end do
      end if
      ! the memory of the motion consists of modes only: the constant becomes a mode of a very
      ! slow rate
      if (.not. terms%equilibrium > 0.0_wp) return
      terms%moduli = [terms%moduli, terms%equilibrium]
      terms%rates = [terms%rates, constant_rate/window]
      terms%equilibrium = 0.0_wp
   end subroutine exponentials

   !> Error of the velocity under a constant force, over that velocity
   pure function error_of(self, window, terms) result(error)
      class(memory_t), intent(in) :: self
      !> Time up to which the sum is to hold [s]
      real(wp), intent(in) :: window
      type(exponential_sum_t), intent(in) :: terms
      real(wp) :: error

      real(wp) :: time

      ! the rule over gaps converges geometrically: one time is enough, before all has relaxed
      time = window
      associate (zero => self%gaps%pole(self%gaps%near(1)) + self%gaps%offset(1))
         if (zero*window > 1.0_wp) time = 1.0_wp/zero
      end associate
      error = abs(terms%integral(time)/(self%viscosity + self%integral(time)) - 1.0_wp)
   end function error_of

   !> Sum for a material that is a sum of exponentials. Q_b(-l) is real, and negative between each
   !> zero z and the pole b that follows, with a branch point at both ends; there
   !> w(l) = A/(pi sqrt(-Q_b)). With a dashpot the last gap extends to infinity
   pure subroutine sum_over_gaps(self, gaps, window, accuracy, terms)
      class(memory_t), intent(in) :: self
      !> Zeros and poles of Q_b
      type(gaps_t), intent(in) :: gaps
      !> Time up to which the sum is to hold [s]
      real(wp), intent(in) :: window
      !> Wanted relative accuracy
      real(wp), intent(in) :: accuracy
      type(exponential_sum_t), intent(out) :: terms

      ! in a long window exp(-l t) grows for l < 0; this bounds the strip like a branch point. With
      ! a quarter of it 109 random impacts change by up to 2e-12, 0.001 stated errors
      real(wp), parameter :: growth = 2.0_wp
      ! start of the substitution, over the slower of window and gap: with 1 these impacts change by
      ! up to 2e-12, 0.002 stated errors
      real(wp), parameter :: slow = 0.1_wp
      ! terms collected at a time, more than any gap has
      integer, parameter :: room = 256
      real(wp), allocatable :: from_zero(:), to_pole(:), share(:)
      real(wp) :: rates(room), moduli(room)
      real(wp) :: zero, before, after, h, low, high, x, y, w
      integer :: i, k, n, zeros, found

      zeros = size(gaps%near)
      n = size(gaps%pole) - 1
      terms%viscosity = self%viscosity
      allocate (terms%rates(0), terms%moduli(0))
      found = 0
      do i = 1, n
         zero = gaps%pole(gaps%near(i)) + gaps%offset(i)
         before = (gaps%pole(gaps%near(i)) - gaps%pole(i)) + gaps%offset(i)
         if (i == 1) before = zero + growth/window
         after = ieee_value(1.0_wp, ieee_positive_inf)
         if (i < zeros) after = (gaps%pole(gaps%near(i + 1)) - gaps%pole(i + 1)) &
            + gaps%offset(i + 1)
         call branch_rule(before, (gaps%pole(i + 1) - gaps%pole(gaps%near(i))) - gaps%offset(i), &
            after, window, accuracy, from_zero, to_pole, share)
         if (found + size(share) > room) then
            terms%rates = [terms%rates, rates(:found)]
            terms%moduli = [terms%moduli, moduli(:found)]
            found = 0
         end if
         do k = 1, size(share)
            found = found + 1
            rates(found) = zero + from_zero(k)
            moduli(found) = share(k)*density(i, from_zero(k), to_pole(k))
         end do
      end do
      terms%rates = [terms%rates, rates(:found)]
      terms%moduli = [terms%moduli, moduli(:found)]
      if (.not. zeros > n) return

      ! beyond the last pole l = z + exp(y), with a double-exponential substitution for y at both
      ! ends, as in `vcor_material_spectrum`
      zero = gaps%pole(gaps%near(zeros)) + gaps%offset(zeros)
      before = (gaps%pole(gaps%near(zeros)) - gaps%pole(zeros)) + gaps%offset(zeros)
      if (.not. before > 0.0_wp) before = 1.0_wp/window
      h = -pi**2/log(accuracy)
      low = log(slow*min(1.0_wp/window, before))
      high = log(max(1.0_wp/window, zero)) - log(accuracy)/3.0_wp
      do k = ceiling((low - log(farthest_rate))/h), floor((high + log(farthest_rate))/h)
         x = real(k, wp)*h
         y = x - exp(low - x) + exp(x - high)
         if (abs(y) > farthest_rate) cycle
         w = h*(1.0_wp + exp(low - x) + exp(x - high))*exp(y)*density(zeros, exp(y), 1.0_wp)
         if (.not. w > 0.0_wp) cycle
         if ((zero + exp(y))*window > 1.0_wp/constant_rate) then
            terms%viscosity = terms%viscosity + w/(zero + exp(y))
         else
            terms%rates = [terms%rates, zero + exp(y)]
            terms%moduli = [terms%moduli, w]
         end if
      end do

   contains

      !> w(l) at l = z_i + x = b_i - y. With Q_b(-z_i) = 0 subtracted, all terms are positive:
      !> -Q_b(-l) = x (viscosity + sum w_j d_j/((d_j - z_i) (d_j - l)))
      pure function density(i, x, y) result(w)
         !> Number of the zero
         integer, intent(in) :: i
         !> Distance from the zero [1/s], > 0
         real(wp), intent(in) :: x
         !> Distance to the next pole [1/s], > 0; not used beyond the last pole
         real(wp), intent(in) :: y
         !> Density
         real(wp) :: w

         real(wp), dimension(2:n + 1) :: from_zero, from

         from_zero = (gaps%pole(2:) - gaps%pole(gaps%near(i))) - gaps%offset(i)
         from = from_zero - x
         if (i <= n) from(i + 1) = y
         w = self%coefficient/(pi*sqrt(x*(self%material%viscosity &
            + sum(gaps%weight(2:)*gaps%pole(2:)/(from_zero*from)))))
      end function density
   end subroutine sum_over_gaps

end module vcor_impact_memory
