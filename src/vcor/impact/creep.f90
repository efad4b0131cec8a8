!> Modes of a structure whose material is a sum of exponentials, in partial fractions
!>
!> A mode of frequency w, damping d and yield y has the receptance y/f(p) with
!>
!>     f(p) = p^2 + d p + w^2 (e_0 + sum_k e_k p/(p + l_k))
!>
!> In the Laplace variable p = -x, f falls from plus to minus infinity between two rates l: each of
!> these gaps has a zero x, one between 0 and the first rate included. What is left are two zeros,
!> as a rule complex, those of p^2 + a p + b:
!>
!>     y/f(p) = (q + jump (a + p))/(p^2 + a p + b) + sum_k r_k/(p + x_k),
!>     jump = -sum_k r_k,   q = y + sum_k r_k x_k,   r_k = y/f'(-x_k)
!>
!> So a mode is an oscillator that F and F' push, and a sum of exponentials. The zeros of all modes
!> in a gap lie close together, and a few rates stand for them, by interpolation of exp(-x t) in
!> ln(x) at Chebyshev's points.
module vcor_impact_creep
   use vcor_kinds, only : pi, wp
   use vcor_material_exponential_sum, only : exponential_sum_t, same_rate
   use vcor_tuning, only : most_iterations
   implicit none
   private

   public :: split_modes, split_rest, rest_damping, in_order, ordered_rates_t

   !> Butterworth's D(u) = 1 + d_1 u + d_2 u^2 + d_1 u^3 + u^4: d_1 = 2 cos(pi/8) + 2 cos(3 pi/8)
   !> and d_2 = 2 + sqrt(2)
   real(wp), parameter :: rest_damping(2) = [2.0_wp*cos(0.125_wp*pi) + 2.0_wp*cos(0.375_wp*pi), &
      2.0_wp + sqrt(2.0_wp)]

   !> Error of the interpolation: with 1e-9 two of 18 random impacts change, by 3e-13
   real(wp), parameter :: of_interpolation = 1.0e-13_wp

   !> The material in order of its rates: e_0, and l_k and e_k with l_0 = 0, shape (0:n)
   type :: ordered_rates_t
      real(wp), allocatable :: rate(:), modulus(:)
   end type ordered_rates_t

contains

   !> Split modes into oscillators and exponentials
   pure subroutine split_modes(terms, square, damping, yield, a, b, push, jump, rate, weight)
      !> The material over its modulus that the frequencies are for, its dashpot not included [-]
      type(exponential_sum_t), intent(in) :: terms
      !> Squares of the frequencies [1/s2], dampings [1/s] and yields of the modes [1/kg], shape
      !> (modes)
      real(wp), intent(in) :: square(:), damping(:), yield(:)
      !> Damping a [1/s] and square b of the frequency of the oscillators [1/s2], q [1/kg] and jump
      !> [s/kg], same shape
      real(wp), intent(out) :: a(:), b(:), push(:), jump(:)
      !> Rates x [1/s] and weights r [s/kg] of the exponentials
      real(wp), allocatable, intent(out) :: rate(:), weight(:)

      type(ordered_rates_t) :: spectrum
      real(wp), allocatable :: x(:, :), r(:, :), kept_x(:), kept_r(:)
      logical :: moves(size(square))
      integer :: gap, mode, n

      spectrum = in_order(terms)
      n = ubound(spectrum%rate, 1)
      a = damping
      b = square*terms%equilibrium
      push = yield
      jump = 0.0_wp
      ! those of rigid motion have no stiffness that relaxes
      moves = square > 0.0_wp
      allocate (x(size(square), n), r(size(square), n), rate(0), weight(0))
      if (n == 0 .or. .not. any(moves)) return
      do mode = 1, size(square)
         if (moves(mode)) call split(spectrum, square(mode), damping(mode), yield(mode), &
            x(mode, :), r(mode, :), a(mode), b(mode), push(mode), jump(mode))
      end do
      do gap = 1, n
         call merge_rates(pack(x(:, gap), moves), pack(r(:, gap), moves), kept_x, kept_r)
         rate = [rate, kept_x]
         weight = [weight, kept_r]
      end do
   end subroutine split_modes

   !> Split the receptance C N(u)/(e D(u)), u = delay p, of many modes together: two oscillators are
   !> the zeros of D, exponentials those of e, one in each gap
   pure subroutine split_rest(terms, flexibility, delay, numerator, a, b, push, jump, rate, weight)
      !> The material over its modulus that C is for, with its dashpot [-]
      type(exponential_sum_t), intent(in) :: terms
      !> C [m/N] and delay [s], > 0
      real(wp), intent(in) :: flexibility, delay
      !> Coefficients of N
      real(wp), intent(in) :: numerator(0:2)
      !> Dampings [1/s] and squares of the frequencies [1/s2] of the oscillators, q [1/kg] and jumps
      !> [s/kg]
      real(wp), intent(out) :: a(2), b(2), push(2), jump(2)
      !> Rates x [1/s] and weights r [s/kg] of the exponentials
      real(wp), allocatable, intent(out) :: rate(:), weight(:)

      ! rate, over that of the oscillators, of a spring in the place of a dashpot, 1e6 changes none
      ! of 18 random impacts; w^2 so large that f has the zeros of e
      real(wp), parameter :: fast = 1.0e8_wp, large = 1.0e150_wp
      type(exponential_sum_t) :: own
      type(ordered_rates_t) :: spectrum
      complex(wp) :: pole, residue
      real(wp) :: slope
      integer :: gap, i

      own = terms
      if (terms%viscosity > 0.0_wp) then
         own%rates = [terms%rates, fast/delay]
         own%moduli = [terms%moduli, terms%viscosity*fast/delay]
      end if
      spectrum = in_order(own)
      allocate (rate(ubound(spectrum%rate, 1)), weight(ubound(spectrum%rate, 1)))
      do gap = 1, size(rate)
         call find_zero(spectrum, large, 0.0_wp, gap, rate(gap), slope)
         associate (u => -delay*rate(gap))
            weight(gap) = -flexibility/slope*(numerator(0) + u*(numerator(1) + u*numerator(2))) &
               /(1.0_wp + u*(rest_damping(1) + u*(rest_damping(2) + u*(rest_damping(1) + u))))
         end associate
      end do
      do i = 1, 2
         pole = exp(cmplx(0.0_wp, pi*(0.375_wp + 0.25_wp*real(i, wp)), wp))
         residue = (numerator(0) + pole*(numerator(1) + pole*numerator(2)))/(rest_damping(1) &
            + pole*(2.0_wp*rest_damping(2) + pole*(3.0_wp*rest_damping(1) + pole*4.0_wp)))
         pole = pole/delay
         residue = residue*flexibility/(delay*(spectrum%modulus(0) &
            + sum(spectrum%modulus(1:)*pole/(pole + spectrum%rate(1:)))))
         a(i) = -2.0_wp*real(pole, wp)
         b(i) = 1.0_wp/delay**2
         jump(i) = 2.0_wp*real(residue, wp)
         push(i) = -2.0_wp*real(residue*conjg(pole), wp) - a(i)*jump(i)
      end do
   end subroutine split_rest

   !> The terms with their rates rising, those of one rate together
   pure function in_order(terms) result(spectrum)
      type(exponential_sum_t), intent(in) :: terms
      type(ordered_rates_t) :: spectrum

      real(wp), allocatable :: rate(:), modulus(:)
      integer :: i, k

      allocate (rate(0), modulus(0))
      do k = 1, size(terms%rates)
         i = 1 + count(rate < terms%rates(k)*(1.0_wp - same_rate))
         if (i <= size(rate)) then
            if (rate(i) <= terms%rates(k)*(1.0_wp + same_rate)) then
               modulus(i) = modulus(i) + terms%moduli(k)
               cycle
            end if
         end if
         rate = [rate(:i - 1), terms%rates(k), rate(i:)]
         modulus = [modulus(:i - 1), terms%moduli(k), modulus(i:)]
      end do
      allocate (spectrum%rate(0:size(rate)), spectrum%modulus(0:size(rate)))
      spectrum%rate = [0.0_wp, rate]
      spectrum%modulus = [terms%equilibrium, modulus]
   end function in_order

   !> Split a mode
   pure subroutine split(spectrum, square, damping, yield, x, r, a, b, push, jump)
      type(ordered_rates_t), intent(in) :: spectrum
      !> w^2 [1/s2], > 0, d [1/s] and y [1/kg]
      real(wp), intent(in) :: square, damping, yield
      !> Rates [1/s] and weights [s/kg], shape (n)
      real(wp), intent(out) :: x(:), r(:)
      !> Damping [1/s] and square of the frequency [1/s2] of the oscillator, q [1/kg] and jump
      !> [s/kg]
      real(wp), intent(out) :: a, b, push, jump

      real(wp) :: slope, at, whole
      integer :: gap

      do gap = 1, size(x)
         call find_zero(spectrum, square, damping, gap, x(gap), slope)
         r(gap) = -yield/(square*slope)
      end do
      jump = -sum(r)
      push = yield + sum(r*x)
      associate (l => spectrum%rate(1:), e => spectrum%modulus)
         ! f(p) over the product of (p + x_k)/(p + l_k) is p^2 + a p + b for all p
         if (x(1) > 0.0_wp) then
            b = square*e(0)*product(l/x)
         else
            b = (damping + square*sum(e(1:)/l))*l(1)*product(l(2:)/x(2:))
         end if
         at = sqrt(b)
         whole = at**2 + damping*at + square*(e(0) + sum(e(1:)*(at/(at + l))))
         a = (whole*product((at + l)/(at + x)) - at**2 - b)/at
      end associate
   end subroutine split

   !> Zero of f in a gap: Newton's method for the distance from the nearer end, safeguarded by
   !> bisection, for f times this distance, which is regular there. Distances keep all digits
   pure subroutine find_zero(spectrum, square, damping, gap, x, slope)
      type(ordered_rates_t), intent(in) :: spectrum
      !> w^2 [1/s2] and d [1/s]
      real(wp), intent(in) :: square, damping
      !> Number of the rate at the upper end of the gap
      integer, intent(in) :: gap
      !> The zero [1/s], and the derivative there of f/w^2 by x [s]
      real(wp), intent(out) :: x, slope

      real(wp) :: distance, lower, upper, others, other_slope, own, value, next, side
      integer :: near, iteration

      if (gap == 1 .and. .not. spectrum%modulus(0) > 0.0_wp) then
         ! a fluid keeps its deflection
         x = 0.0_wp
         slope = -damping/square - sum(spectrum%modulus(1:)/spectrum%rate(1:))
         return
      end if
      associate (l => spectrum%rate, e => spectrum%modulus)
         lower = 0.0_wp
         upper = 0.5_wp*(l(gap) - l(gap - 1))
         near = gap
         side = -1.0_wp
         call evaluate(near, side, upper, x, others, other_slope, own, value)
         if (.not. value > 0.0_wp) then
            near = gap - 1
            side = 1.0_wp
         end if
         distance = upper
         do iteration = 1, most_iterations
            call evaluate(near, side, distance, x, others, other_slope, own, value)
            if (.not. abs(value) > 0.0_wp) exit
            ! at the end itself f is minus infinity below a rate, positive above
            if (value > 0.0_wp .eqv. side < 0.0_wp) then
               upper = distance
            else
               lower = distance
            end if
            if (near == 0) then
               next = distance - others/other_slope
            else
               next = distance - distance*value/(others + side*distance*other_slope + own)
            end if
            if (.not. (next > lower .and. next < upper)) next = 0.5_wp*(lower + upper)
            if (abs(next - distance) <= 2.0_wp*epsilon(1.0_wp)*distance) exit
            distance = next
         end do
         slope = other_slope
         if (near > 0) slope = slope - own*l(near)/distance**2
      end associate

   contains

      !> f/w^2 at a distance; the term of the near rate is side*own*x/distance
      pure subroutine evaluate(near, side, distance, x, others, other_slope, own, value)
         !> The near end, and on which side of it: below -1, above 1
         integer, intent(in) :: near
         real(wp), intent(in) :: side
         !> Distance [1/s], > 0
         real(wp), intent(in) :: distance
         !> The place [1/s], f/w^2 without the term of the near rate, its derivative by x [s], the
         !> modulus of that rate, and f/w^2
         real(wp), intent(out) :: x, others, other_slope, own, value

         real(wp), dimension(size(spectrum%rate) - 1) :: gap_to, term

         associate (l => spectrum%rate, e => spectrum%modulus)
            x = l(near) + side*distance
            gap_to = (l(1:) - l(near)) - side*distance
            term = e(1:)
            own = 0.0_wp
            if (near > 0) then
               own = e(near)
               term(near) = 0.0_wp
            end if
            term = term/gap_to
            others = (x - damping)*x/square + e(0) - x*sum(term)
            other_slope = (2.0_wp*x - damping)/square - sum(term/gap_to*l(1:))
            value = others + side*own*x/distance
         end associate
      end subroutine evaluate
   end subroutine find_zero

   !> A few rates for the many of the modes in a gap
   pure subroutine merge_rates(x, r, rate, weight)
      !> Rates [1/s], > 0, or all 0, and weights [s/kg], shape (modes)
      real(wp), intent(in) :: x(:), r(:)
      !> The same of a few
      real(wp), allocatable, intent(out) :: rate(:), weight(:)

      real(wp), allocatable :: node(:), side(:), share(:)
      real(wp) :: middle, half, ratio, place
      integer :: points, j, n

      half = 0.0_wp
      if (minval(x) > 0.0_wp) half = 0.5_wp*log(maxval(x)/minval(x))
      points = 1
      if (half > epsilon(1.0_wp)) then
         ! exp(-t exp(y)) is bounded for |Im y| < pi/2
         ratio = 0.5_wp*pi/half
         ratio = ratio + sqrt(1.0_wp + ratio**2)
         points = 1 + ceiling(-log(of_interpolation)/log(ratio))
      end if
      if (points >= size(x)) then
         rate = x
         weight = r
         return
      else if (points == 1) then
         rate = [x(1)]
         weight = [sum(r)]
         return
      end if
      middle = 0.5_wp*log(maxval(x)*minval(x))
      node = [(cos((real(j, wp) - 0.5_wp)*pi/real(points, wp)), j=1, points)]
      side = [((-1.0_wp)**j*sin((real(j, wp) - 0.5_wp)*pi/real(points, wp)), j=1, points)]
      rate = exp(middle + half*node)
      allocate (weight(points), source=0.0_wp)
      do n = 1, size(x)
         place = (log(x(n)) - middle)/half
         j = minloc(abs(place - node), 1)
         if (abs(place - node(j)) > epsilon(1.0_wp)) then
            share = side/(place - node)
            weight = weight + r(n)*share/sum(share)
         else
            weight(j) = weight(j) + r(n)
         end if
      end do
   end subroutine merge_rates

end module vcor_impact_creep
