!> Law of the verification table for waves in a plate of any thickness, by the coupled contact: its
!> limits
module vcor_verify_waves
   use vcor_impact_face, only : base_half_space, base_thin
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_plate, only : waves_none
   use vcor_kinds, only : pi, wp
   use vcor_material, only : material_data_t
   use vcor_verify_law, only : density, elastic, law_t, strike_t, time_scale, zener_plate
   implicit none
   private

   public :: waves_of_any_thickness

   !> Elastic half space: modulus [Pa], Poisson's ratio [-]
   real(wp), parameter :: modulus = 70.0e9_wp, nu = 0.25_wp
   !> Moduli of the thin plates [Pa]: x, proportional to modulus^-0.15, falls from 0.016 to 0.002;
   !> their Zener parameter
   real(wp), parameter :: stiff(2) = 1.5e18_wp*[1.0_wp, 2.0_wp**20], half = 0.5_wp

contains

   !> Limits of a plate of any thickness
   !>
   !>  - Thick. To first order the waves in a half space take the energy int kappa F'^2 dt, with
   !>    kappa = I(nu)/(2 pi mu c_s) by G. F. Miller and H. Pursey, Proc. R. Soc. A 223 (1954) 521.
   !>    In Hertz's impact
   !>
   !>        int F'^2 dt = (9/5) B(4/5, 3/2) k^2 v0 s0^2,   k s0^(5/2) = (5/4) m v0^2
   !>
   !>    so their share of the energy grows as v0^0.6. Two velocities, the second with half the
   !>    share, are extrapolated with an error of order share^2.
   !>  - Thin. Zener's plate moves as a whole, c(s) = alpha/s: a term of the face by itself, and the
   !>    limit of the free plate for a thickness H that waves cross in a short part x = H/(c_s T) of
   !>    the contact. Where the contact is small against H, the compliance of a plate is
   !>
   !>        C = (alpha/s) [1 - (2/(5 pi)) (6 - 6 nu)^(1/2) y ln y + O(y)],   y = s H/c_s
   !>
   !>    The term with ln x acts as a spring between sphere and plate, so the restitution differs
   !>    from its limit by x [A ln(1/x) + B] + O(x^2 ln(x)^2), with A from Zener's impact with such
   !>    a spring.
   subroutine waves_of_any_thickness(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: velocity = 0.5_wp, lambda = 0.2_wp, a = 0.0248552_wp
      type(material_data_t) :: plate
      type(strike_t) :: strikes(2), plates(4)
      integer :: i

      call law%begin('Plates with waves, of any thickness', &
         'Miller and Pursey 1954, I(1/4) by quadrature in 25 digits; Zener''s impact as above')
      plate = elastic(modulus)
      call plate%set('poisson_ratio', nu)
      strikes = strike_t(plate, velocity=velocity, base=base_half_space)
      strikes(2)%velocity = velocity*0.5_wp**(5.0_wp/3.0_wp)
      call law%add_check(strikes, 'coupled')
      call law%add_row('energy of waves / first order', 1.0_wp, 500.0_wp, 2.0e-4_wp, &
         'accuracy over the energy of the waves, and the square of its share', &
         measure=over_first_order)
      strikes(1) = zener_plate(stiff(1), waves_none, lambda)
      strikes(1)%base = base_thin
      call law%add_check(strikes(:1), 'coupled')
      call law%add_row('cor, thin limit: Zener', 0.714044879992_wp, 3.0_wp, 0.0_wp)
      do i = 1, 2
         plates(i) = zener_plate(stiff(i), waves_none, half)
         plates(i + 2) = plates(i)
         plates(i + 2)%base = base_thin
      end do
      call law%add_check(plates, 'coupled')
      call law%add_row('x ln(1/x) of a thin plate', a, 400.0_wp, 2.0e-4_wp, &
         'the accuracies over x of the second plate, and x ln(x)^2 of the first', measure=approach)
   end subroutine waves_of_any_thickness

   !> Energy of the waves, which is all that the sphere loses, over its first-order value,
   !> extrapolated to a share of zero
   pure function over_first_order(outcomes) result(ratio)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: ratio

      real(wp), parameter :: i_nu = 0.9307526019144379_wp
      real(wp), parameter :: beta = gamma(0.8_wp)*gamma(1.5_wp)/gamma(2.3_wp)
      type(strike_t) :: strike
      real(wp) :: shear, kappa, shares(2)

      shear = 0.5_wp*modulus/(1.0_wp + nu)
      kappa = i_nu/(2.0_wp*pi*shear)*sqrt(density/shear)
      associate (e => outcomes%initial_energy, &
                 v => sqrt(2.0_wp*outcomes%initial_energy/strike%mass))
         associate (t => (strike%mass/(4.0_wp/3.0_wp*sqrt(strike%radius)*modulus/(1.0_wp - nu**2) &
                    *sqrt(v)))**0.4_wp)
            ! k = 2 e/(v^5 t^5)^(1/2), s0 = (5/4)^(2/5) v t
            shares = e*(1.0_wp - outcomes%cor_sphere**2) &
               /(kappa*1.8_wp*beta*1.25_wp**0.8_wp*4.0_wp*e**2/(v**2*t**3))
         end associate
      end associate
      ratio = 2.0_wp*shares(2) - shares(1)
   end function over_first_order

   !> Slope over ln(1/x) of the difference to the limit divided by x, which tends to A
   pure function approach(outcomes) result(rate)
      !> Outcomes of two plates and of their thin limits
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: rate

      type(strike_t) :: plate
      real(wp) :: x(2)
      integer :: i

      do i = 1, 2
         plate = zener_plate(stiff(i), waves_none, half)
         ! mu = E/3, Poisson's ratio is 0.5
         x(i) = 2.0_wp*plate%half_thickness/(sqrt(stiff(i)/(3.0_wp*density)) &
            *time_scale(plate, stiff(i)))
      end do
      associate (off => (outcomes(:2)%cor_sphere - outcomes(3:4)%cor_sphere)/x)
         rate = (off(2) - off(1))/log(x(1)/x(2))
      end associate
   end function approach

end module vcor_verify_waves
