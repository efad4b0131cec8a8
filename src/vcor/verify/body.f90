!> Laws of the verification table about plates by elastodynamics, waves = 'body': their limits
module vcor_verify_body
   use vcor_constants, only : pi
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_plate, only : waves_body, waves_constant, waves_hereditary
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_verify_law, only : law_t
   use vcor_verify_strike, only : density, elastic, sls, strike_t, time_scale, &
      zener_plate
   implicit none
   private

   public :: thick_body, thin_body

   !> Elastic half space: modulus [Pa], Poisson's ratio [-]
   real(wp), parameter :: modulus = 70.0e9_wp, nu = 0.25_wp

contains

   !> A half space takes int kappa F'^2 dt to first order, kappa = I(nu)/(2 pi mu c_s) by G. F.
   !> Miller and H. Pursey, Proc. R. Soc. A 223 (1954) 521; in Hertz's impact
   !>
   !>     int F'^2 dt = (9/5) B(4/5, 3/2) k^2 v0 s0^2,   k s0^(5/2) = (5/4) m v0^2
   !>
   !> which is v0^0.6 of the energy. Two velocities with half of that leave its square. A layer from
   !> whose far face no wave comes back in time is a half space
   subroutine thick_body(law)
      type(law_t), intent(inout) :: law

      ! half a wave's way to and fro takes 0.2 ms, the contact 0.15 ms
      real(wp), parameter :: velocity = 0.05_wp, half_thickness = 0.75_wp
      type(material_data_t) :: plate
      type(strike_t) :: strikes(3)

      call law%begin('Elastic sphere on a half space that carries waves away', &
         'Miller and Pursey 1954, I(1/4) by quadrature in 25 digits; a layer as thick as that')
      plate = elastic(modulus)
      call plate%set('poisson_ratio', nu)
      strikes = strike_t(plate, waves=waves_body, velocity=velocity, half_thickness=0.0_wp)
      strikes(2)%velocity = velocity*0.5_wp**(5.0_wp/3.0_wp)
      strikes(3)%half_thickness = half_thickness
      call law%add_check(strikes, ive_only=.true.)
      call law%add_row('energy of waves / first order', 1.0_wp, 0.0_wp, 1.0e-4_wp, &
         'accuracy over the energy of the waves, and the square of its share', &
         measure=over_first_order)
      call law%add_row('cor_sphere, thick: half space', times=0.0_wp, more=1.0e-7_wp, &
         reason='accuracies of the two', measure=last_sphere, expectation=first_sphere)
   end subroutine thick_body

   !> Energy of the waves, which is all that the sphere loses, over that of first order, its growth
   !> with v0^0.6 removed
   pure function over_first_order(outcomes) result(ratio)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: ratio

      real(wp), parameter :: i_nu = 0.9307526019144379_wp
      real(wp), parameter :: beta = gamma(0.8_wp)*gamma(1.5_wp)/gamma(2.3_wp)
      type(strike_t) :: strike
      real(wp) :: k, shear, kappa, energy, depth, found(2)
      integer :: i

      shear = 0.5_wp*modulus/(1.0_wp + nu)
      kappa = i_nu/(2.0_wp*pi*shear)*sqrt(density/shear)
      k = 4.0_wp/3.0_wp*sqrt(strike%radius)*modulus/(1.0_wp - nu**2)
      do i = 1, 2
         energy = outcomes(i)%initial_energy
         depth = (2.5_wp*energy/k)**0.4_wp
         found(i) = energy*(1.0_wp - outcomes(i)%cor_sphere**2) &
            /(kappa*1.8_wp*beta*k**2*sqrt(2.0_wp*energy/strike%mass)*depth**2)
      end do
      ratio = 2.0_wp*found(2) - found(1)
   end function over_first_order

   !> Thin plates. The thickness over the way of a wave in the time T, x = H/(c_s T), is 0.016, and
   !> the difference falls with it: 1.5e-2, 5.8e-3, 2.0e-3 and 5.4e-4 of the elastic plate for 0.13,
   !> 0.066, 0.033 and 0.016
   subroutine thin_body(law)
      type(law_t), intent(inout) :: law

      ! x goes with stiff^-0.15 where lambda stays
      real(wp), parameter :: stiff = 1.5e17_wp, lambda = 1.0_wp, drop = 0.25_wp, left = 2.0e-3_wp
      character(len=*), parameter :: why = 'an eighth of x'
      type(strike_t) :: thin(2)
      real(wp) :: rate

      call law%begin('Thin plates by elastodynamics', &
         'Zener''s plate and the hereditary one, the limits of C(s)')
      thin(1) = zener_plate(stiff, waves_body, lambda)
      thin(2) = zener_plate(stiff, waves_constant, lambda)
      call law%add_check(thin, ive_only=.true.)
      call law%add_row('cor_sphere, elastic: constant', times=0.0_wp, more=left, reason=why, &
         measure=first_sphere, expectation=last_sphere)
      rate = 1.0_wp/time_scale(thin(1), stiff)
      thin%plate = sls(stiff, drop*rate, rate)
      thin(2)%waves = waves_hereditary
      call law%add_check(thin, ive_only=.true.)
      call law%add_row('cor_sphere, SLS: hereditary', times=0.0_wp, more=left, reason=why, &
         measure=first_sphere, expectation=last_sphere)
   end subroutine thin_body

   !> cor_sphere of the first outcome
   pure function first_sphere(outcomes) result(cor)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: cor

      cor = outcomes(1)%cor_sphere
   end function first_sphere

   !> cor_sphere of the last outcome
   pure function last_sphere(outcomes) result(cor)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: cor

      cor = outcomes(size(outcomes))%cor_sphere
   end function last_sphere

end module vcor_verify_body
