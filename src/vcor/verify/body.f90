!> Laws of the verification table for plates by elastodynamics, waves = 'body': their limits
module vcor_verify_body
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_plate, only : waves_body, waves_constant, waves_hereditary
   use vcor_kinds, only : pi, wp
   use vcor_material, only : material_data_t
   use vcor_verify_law, only : density, elastic, hertz_duration, law_t, sls, strike_t, time_scale, &
      zener_plate
   implicit none
   private

   public :: thick_body, thin_body

   !> Elastic half space: modulus [Pa], Poisson's ratio [-]
   real(wp), parameter :: modulus = 70.0e9_wp, nu = 0.25_wp
   !> Moduli of the thin plates [Pa]: x = H/(c_s T), proportional to modulus^-0.15, falls from 0.016
   !> to 0.002. Zener's parameter, and rubbery over glassy modulus of the solid [-]
   real(wp), parameter :: stiff(2) = 1.5e18_wp*[1.0_wp, 2.0_wp**20], lambda = 0.5_wp, &
      drop = 0.25_wp

contains

   !> Thick plates. To first order the waves in a half space take the energy int kappa F'^2 dt, with
   !> kappa = I(nu)/(2 pi mu c_s) by G. F. Miller and H. Pursey, Proc. R. Soc. A 223 (1954) 521. In
   !> Hertz's impact
   !>
   !>     int F'^2 dt = (9/5) B(4/5, 3/2) k^2 v0 s0^2,   k s0^(5/2) = (5/4) m v0^2
   !>
   !> so their share of the energy grows as v0^0.6. Two velocities, the second with half the share,
   !> are extrapolated with an error of order share^2, also to the static limit, Hertz's half space.
   !> A layer is a half space if no wave returns from the far face in time
   subroutine thick_body(law)
      type(law_t), intent(inout) :: law

      ! the fastest wave returns from the far face after 0.34 ms; the contacts last 0.15 and 0.19 ms
      real(wp), parameter :: velocity = 0.05_wp, half_thickness = 0.75_wp
      character(len=*), parameter :: square = 'accuracy, and the square of the share of the waves'
      type(material_data_t) :: plate
      type(strike_t) :: strikes(3)

      call law%begin('Elastic sphere on a thick plate that carries waves away', &
         'Miller and Pursey 1954, I(1/4) by quadrature in 25 digits; Hertz 1882; a half space')
      plate = elastic(modulus)
      call plate%set('poisson_ratio', nu)
      strikes = strike_t(plate, waves=waves_body, velocity=velocity, half_thickness=half_thickness)
      strikes(2)%velocity = velocity*0.5_wp**(5.0_wp/3.0_wp)
      strikes(3)%half_thickness = 0.0_wp
      call law%add_check(strikes, ive_only=.true.)
      call law%add_row('energy of waves / first order', 1.0_wp, 0.0_wp, 1.0e-4_wp, &
         'accuracy over the energy of the waves, and the square of its share', &
         measure=over_first_order)
      call law%add_row('static indentation / (v0 T)', 1.25_wp**0.4_wp, 0.0_wp, 1.0e-6_wp, &
         square, measure=static_indentation)
      call law%add_row('static contact time / T', hertz_duration, 0.0_wp, 1.0e-5_wp, square, &
         measure=static_duration)
      call law%add_row('cor_sphere, thick: half space', times=0.0_wp, more=1.0e-7_wp, &
         reason='accuracies of the two', quantity='cor_sphere', twin=size(strikes))
   end subroutine thick_body

   !> Energy of the waves, which is all that the sphere loses, over its first-order value,
   !> extrapolated to a share of zero
   pure function over_first_order(outcomes) result(ratio)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: ratio

      real(wp), parameter :: i_nu = 0.9307526019144379_wp
      real(wp), parameter :: beta = gamma(0.8_wp)*gamma(1.5_wp)/gamma(2.3_wp)
      real(wp) :: shear, kappa

      shear = 0.5_wp*modulus/(1.0_wp + nu)
      kappa = i_nu/(2.0_wp*pi*shear)*sqrt(density/shear)
      associate (v => velocity(outcomes), t => hertz_time(outcomes), e => outcomes%initial_energy)
         ! k = 2 e/(v^5 t^5)^(1/2), s0 = (5/4)^(2/5) v t
         ratio = without_waves(e*(1.0_wp - outcomes%cor_sphere**2) &
            /(kappa*1.8_wp*beta*1.25_wp**0.8_wp*4.0_wp*e**2/(v**2*t**3)))
      end associate
   end function over_first_order

   !> Largest indentation in units of v0 T
   pure function static_indentation(outcomes) result(depth)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: depth

      depth = without_waves(outcomes%max_indentation/(velocity(outcomes)*hertz_time(outcomes)))
   end function static_indentation

   !> Contact time in units of T
   pure function static_duration(outcomes) result(duration)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: duration

      duration = without_waves(outcomes%contact_time/hertz_time(outcomes))
   end function static_duration

   !> Number extrapolated to a share of zero, from two impacts, the second with half the share
   pure function without_waves(numbers) result(limit)
      real(wp), intent(in) :: numbers(:)
      real(wp) :: limit

      limit = 2.0_wp*numbers(2) - numbers(1)
   end function without_waves

   !> Velocity of an impact [m/s]
   elemental function velocity(outcome)
      type(outcome_t), intent(in) :: outcome
      real(wp) :: velocity

      type(strike_t) :: strike

      velocity = sqrt(2.0_wp*outcome%initial_energy/strike%mass)
   end function velocity

   !> Time scale T of Hertz's impact on the half space [s]
   elemental function hertz_time(outcome) result(scale)
      type(outcome_t), intent(in) :: outcome
      real(wp) :: scale

      type(strike_t) :: strike

      scale = (strike%mass/(4.0_wp/3.0_wp*sqrt(strike%radius)*modulus/(1.0_wp - nu**2) &
         *sqrt(velocity(outcome))))**0.4_wp
   end function hertz_time

   !> Thin plates. If the contact area is small against H, a layer has the compliance
   !> C = (alpha/s) [1 - (2/(5 pi)) (6 - 6 nu)^(1/2) y ln y + O(y)]
   !> with y = s H/c_s. The term with ln x, x = H/(c_s T), acts as a spring between sphere and
   !> plate, so the restitution differs from its thin limit by
   !>
   !>     x [A ln(1/x) + B] + O(x^2 ln(x)^2)
   !>
   !> with A from the impact with such a spring by tests/reference/make_thin_limit.py
   subroutine thin_body(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: a_elastic = 0.0248552_wp, a_sls = 0.0152017_wp
      ! tolerances at the second x
      real(wp), parameter :: left = 1.0e-4_wp, left_of_a = 2.0e-4_wp
      character(len=*), parameter :: why = 'a twentieth of x', &
         why_a = 'x ln(x)^2 of the first plate, and the accuracies over x of the second one'
      type(strike_t) :: plates(4)
      real(wp) :: rate
      integer :: i

      call law%begin('Thin plates by elastodynamics', &
         'Zener''s plate and the hereditary one, the limits of C(s) for x = H/(c_s T) -> 0')
      do i = 1, 2
         plates(i) = zener_plate(stiff(i), waves_body, lambda)
         plates(i + 2) = zener_plate(stiff(i), waves_constant, lambda)
      end do
      call law%add_check(plates, ive_only=.true.)
      call law%add_row('cor_sphere, elastic: constant', times=0.0_wp, more=left, reason=why, &
         quantity='cor_sphere', subject=2, twin=size(plates))
      call law%add_row('x ln(1/x) of it, elastic', a_elastic, 0.0_wp, left_of_a, why_a, &
         measure=approach)
      do i = 1, 2
         rate = 1.0_wp/time_scale(plates(i), stiff(i))
         plates(i::2)%plate = sls(stiff(i), drop*rate, rate)
      end do
      plates(3:)%waves = waves_hereditary
      call law%add_check(plates, ive_only=.true.)
      call law%add_row('cor_sphere, SLS: hereditary', times=0.0_wp, more=left, reason=why, &
         quantity='cor_sphere', subject=2, twin=size(plates))
      call law%add_row('x ln(1/x) of it, SLS', a_sls, 0.0_wp, left_of_a, why_a, measure=approach)
   end subroutine thin_body

   !> Slope over ln(1/x) of the difference to the thin plate divided by x, which tends to A
   pure function approach(outcomes) result(rate)
      !> Outcomes of two layers and of their thin limits
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: rate

      type(strike_t) :: plate
      real(wp) :: x(2)
      integer :: i

      do i = 1, 2
         plate = zener_plate(stiff(i), waves_body, lambda)
         ! mu = E/3, Poisson's ratio is 0.5
         x(i) = 2.0_wp*plate%half_thickness/(sqrt(stiff(i)/(3.0_wp*density)) &
            *time_scale(plate, stiff(i)))
      end do
      associate (off => (outcomes(:2)%cor_sphere - outcomes(3:4)%cor_sphere)/x)
         rate = (off(2) - off(1))/log(x(1)/x(2))
      end associate
   end function approach

end module vcor_verify_body
