!> Laws of the verification table with a closed form or a scaling law: elastic impacts, materials
!> without a time scale, limits of models
module vcor_verify_closed_forms
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_plate, only : waves_constant, waves_relaxing
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_verify_law, only : elastic, hertz_duration, law_t, others_follow, sls, strike_t, &
      time_scale, zener_plate
   implicit none
   private

   public :: hertz, zener, power_law, mittag_leffler, weak_maxwell, scaling, limits

   !> Modulus of the elastic bodies, and glassy modulus of the paper's standard linear solid [Pa]
   real(wp), parameter :: modulus = 15.0e6_wp
   !> Contact time over relaxation time in `weak_maxwell`, each an eighth of the one before [-]
   real(wp), parameter :: epsilon(3) = 1.0e-2_wp*[1.0_wp, 1.0_wp/8.0_wp, 1.0_wp/64.0_wp]

contains

   !> Hertz's impact, m s'' = -k s^1.5 with s(0) = 0, s'(0) = v0, loses no energy. By the energy
   !> integral s'^2 = v0^2 - (4/5) (k/m) s^(5/2) the largest indentation is (5/4)^(2/5) v0 T with
   !> T = (m/(k sqrt(v0)))^(2/5), the largest force k s^1.5 = (5/4)^(3/5) m v0/T, and the duration
   !> 2 int ds/s' = (4/5) B(2/5, 1/2) (5/4)^(2/5) T = 3.2180654597190435 T
   subroutine hertz(law)
      type(law_t), intent(inout) :: law

      type(strike_t) :: strike
      real(wp) :: scale

      call law%begin('Elastic sphere on a half space: nothing is lost', &
         'H. Hertz, J. reine angew. Math. 92 (1882) 156; closed forms')
      strike = strike_t(elastic(modulus))
      scale = time_scale(strike, modulus)
      call law%add_check([strike])
      call law%add_row('cor', 1.0_wp)
      call law%add_row('contact time / T', hertz_duration, 10.0_wp, reason=others_follow, &
         quantity='contact_time', unit=scale)
      call law%add_row('largest indentation / (v0 T)', 1.25_wp**0.4_wp, 10.0_wp, &
         reason=others_follow, quantity='max_indentation', unit=strike%velocity*scale)
      call law%add_row('largest force T / (m v0)', 1.25_wp**0.6_wp, 10.0_wp, &
         reason=others_follow, quantity='max_force', unit=strike%mass*strike%velocity/scale)
      call law%add_row('hysteresis / energy', 0.0_wp, 10.0_wp, reason=others_follow, &
         quantity='hysteresis_energy', unit=0.5_wp*strike%mass*strike%velocity**2)
   end subroutine hertz

   !> Zener's elastic sphere on an elastic plate that carries waves away,
   !> sigma'' + sigma^1.5 + lambda (sigma^1.5)' = 0 with sigma(0) = 0, sigma'(0) = 1. The
   !> restitution -sigma' at the end depends on lambda alone. The values come from Taylor series in
   !> 50 digits, tests/reference/make_kelvin_voigt.py, and agree with the 13 digits of
   !> tests/reference/reference.csv, which come from another method
   subroutine zener(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: lambda(3) = [0.05_wp, 0.2_wp, 1.0_wp]
      character(len=*), parameter :: label(3) = ['0.05', '0.20', '1.00']
      real(wp), parameter :: cor(3) = [0.91777150179007443633_wp, 0.71404487999215247657_wp, &
         0.18412287416504999366_wp]
      integer :: i

      call law%begin('Elastic sphere on an elastic plate with waves: cor depends on lambda', &
         'C. Zener, Phys. Rev. 59 (1941) 669; his equation by Taylor series, 16 digits')
      do i = 1, size(lambda)
         call law%add_check([zener_plate(modulus, waves_constant, lambda(i))])
         call law%add_row('cor, lambda = '//label(i)//', constant', cor(i))
         call law%add_check([zener_plate(modulus, waves_relaxing, lambda(i))])
         call law%add_row('cor, lambda = '//label(i)//', relaxing', cor(i))
      end do
   end subroutine zener

   !> A pure power law has no time scale: in units of its own T the exponent is the only parameter
   !> of the impact. Two impacts with different values of everything else must agree
   subroutine power_law(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: exponent(3) = [0.25_wp, 0.5_wp, 0.75_wp]
      character(len=*), parameter :: label(3) = ['0.25', '0.50', '0.75']
      real(wp), parameter :: cor(3) = [0.57164767998043_wp, 0.28565312277610_wp, &
         0.097580216965_wp]
      type(strike_t) :: two(2)
      integer :: i, k

      call law%begin('Power law t^-a on a half space: cor depends on a alone', &
         'no time scale; numbers: own reference values, 12 digits')
      two(2) = strike_t(velocity=0.3_wp, mass=2.0e-3_wp, radius=4.0e-3_wp, plate=elastic(1.0_wp))
      do i = 1, size(exponent)
         do k = 1, 2
            two(k)%plate = described('power_law', [character(len=11) :: 'exponent', &
               'coefficient'], [exponent(i), merge(1.0e6_wp, 3.0e4_wp, k == 1)])
            call law%add_check(two(k:k))
            call law%add_row('cor, a = '//label(i)//trim(merge('         ', ', another', k == 1)), &
               cor(i))
         end do
      end do
   end subroutine power_law

   !> With exponent 1/2 the Mittag-Leffler function, E_0 + E_1 E_{1/2}(-sqrt(t/tau)), is CERF's
   !> exp(b^2 t) erfc(b sqrt(t)) with b = tau^(-1/2); with exponent 1 it is exp(-t/tau), the
   !> standard linear solid. The two models of each pair have different code for E(t), its integral
   !> and its spectrum. With exponent exactly 1 the material would be a Prony series, so an exponent
   !> next to 1 is used; it changes cor by less than its distance from 1
   subroutine mittag_leffler(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: beta = 700.0_wp, rate = 1200.0_wp, drop = 0.25_wp
      real(wp), parameter :: cerf(2) = [0.442e6_wp, 676.5e6_wp]
      real(wp), parameter :: next_to_one = 1.0_wp - 1.0e-12_wp
      character(len=*), parameter :: names(4) = [character(len=19) :: 'equilibrium_modulus', &
         'relaxing_modulus', 'exponent', 'time']
      character(len=*), parameter :: why = 'accuracies of the two'

      call law%begin('Mittag-Leffler material: its relatives', &
         'identities of the Mittag-Leffler function; an impact by the other model')
      call law%add_check([strike_t(described('mittag_leffler', names, &
         [cerf, 0.5_wp, 1.0_wp/beta**2]), waves=waves_relaxing), &
         strike_t(described('cerf', [names(:2), 'beta               '], [cerf, beta]), &
         waves=waves_relaxing)])
      call law%add_row('cor, exponent 1/2: CERF', times=2.0_wp, reason=why, twin=2)
      call law%add_check([strike_t(described('mittag_leffler', names, &
         [drop*modulus, (1.0_wp - drop)*modulus, next_to_one, 1.0_wp/rate]), &
         waves=waves_relaxing), &
         strike_t(sls(modulus, drop*rate, rate), waves=waves_relaxing)])
      call law%add_row('cor, exponent 1: SLS', times=2.0_wp, reason=why, twin=2)
   end subroutine mittag_leffler

   !> A Maxwell fluid, k exp(-t/tau), that relaxes little within Hertz's contact time t_c. With q
   !> the relaxed part of u, F = k (u - q) and q' = F/(k tau), so q = I/(k tau) exactly and
   !>
   !>     W_h = int F ds = (1/tau) int F s dt - (3/5) k s0^(5/2),   k s0^(3/2) = I0/tau
   !>
   !> at the end of contact. In Hertz's impact int F s dt = m int s'^2 dt = (10/9) W0 t_c and
   !> I0 = 2 m v0. With epsilon = t_c/tau and t_c = 3.218 T
   !>
   !>     (1 - e)/epsilon = 5/9 - c epsilon^(2/3) + O(epsilon),   c = (3/5) (2/3.218)^(5/3)
   !>
   !> with all powers of epsilon^(1/3) from there on. Three values of epsilon, each an eighth of the
   !> one before, give the limit without the powers 2/3 and 1, and c without the next two
   subroutine weak_maxwell(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: c = 0.6_wp*(2.0_wp/hertz_duration)**(5.0_wp/3.0_wp)
      type(strike_t) :: strikes(3)
      real(wp) :: contact_time
      integer :: i

      call law%begin('Maxwell fluid that relaxes little: (1 - cor) tau/t_c', &
         'first order of the energy balance, derived in docs/theory.md')
      contact_time = hertz_duration*time_scale(strikes(1), modulus)
      do i = 1, size(epsilon)
         strikes(i)%plate = sls(modulus, 0.0_wp, epsilon(i)/contact_time)
      end do
      call law%add_check(strikes, 'ive')
      call law%add_row('limit', 5.0_wp/9.0_wp, 2.0_wp/epsilon(3), epsilon(2)**(4.0_wp/3.0_wp), &
         'accuracy over t_c/tau, and the power 4/3 that is left', measure=maxwell_limit)
      call law%add_row('coefficient of (t_c/tau)^(2/3)', -c, &
         4.0_wp/epsilon(3)**(5.0_wp/3.0_wp), epsilon(2), &
         'accuracy over (t_c/tau)^(5/3), and the power 1 that is left', measure=maxwell_slope)
   end subroutine weak_maxwell

   !> Limit of (1 - cor)/epsilon, extrapolated without the powers 2/3 and 1
   pure function maxwell_limit(outcomes) result(limit)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: limit

      real(wp) :: ratio(3), first(2)

      ratio = (1.0_wp - outcomes%cor)/epsilon
      first = (4.0_wp*ratio(2:3) - ratio(1:2))/3.0_wp
      limit = (8.0_wp*first(2) - first(1))/7.0_wp
   end function maxwell_limit

   !> Coefficient of epsilon^(2/3) in (1 - cor)/epsilon, without the relative powers 1/3 and 2/3
   pure function maxwell_slope(outcomes) result(slope)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: slope

      real(wp) :: ratio(3), first(2)

      ratio = ((1.0_wp - outcomes%cor)/epsilon - 5.0_wp/9.0_wp)/epsilon**(2.0_wp/3.0_wp)
      first = 2.0_wp*ratio(2:3) - ratio(1:2)
      slope = (4.0_wp*first(2) - first(1))/3.0_wp
   end function maxwell_slope

   !> Without a plate the impact depends on mass m, Hertz radius R and velocity only through
   !> m/sqrt(R v0). Factors that are powers of 4 leave this ratio exact in floating point, so both
   !> impacts take the same steps
   subroutine scaling(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: velocity = 3.0_wp, mass = 0.02_wp, radius = 0.01_wp
      ! some tens of rounding errors of numbers near 1
      real(wp), parameter :: rounding = 1.0e-14_wp
      type(material_data_t) :: data(2)
      type(strike_t) :: one
      integer :: i

      call law%begin('Half space: mass, radius and speed enter through m/sqrt(R v0) alone', &
         'dimensional analysis; an impact against one of the same m/sqrt(R v0)')
      data(1) = described('prony', ['equilibrium_modulus'], [1.0e6_wp])
      call data(1)%set_list('moduli', [2.0e6_wp, 5.0e6_wp])
      call data(1)%set_list('rates', [300.0_wp, 4000.0_wp])
      data(2) = described('cerf', [character(len=19) :: 'equilibrium_modulus', &
         'relaxing_modulus', 'beta'], [1.0e6_wp, 5.0e6_wp, 50.0_wp])
      do i = 1, 2
         one = strike_t(data(i), velocity=velocity, mass=mass, radius=radius)
         call law%add_check([strike_t(data(i), velocity=16.0_wp*velocity, mass=4.0_wp*mass, &
            radius=radius), one])
         call law%add_row('cor, '//data(i)%model//', 4 m and 16 v0', times=0.0_wp, more=rounding, &
            reason='rounding', twin=2)
         call law%add_check([strike_t(data(i), velocity=velocity, mass=0.25_wp*mass, &
            radius=radius/16.0_wp), one])
         call law%add_row('cor, '//data(i)%model//', m/4 and R/16', times=0.0_wp, more=rounding, &
            reason='rounding', twin=2)
      end do
   end subroutine scaling

   !> A standard linear solid that never relaxes, or relaxes at once, is elastic with its glassy or
   !> its rubbery modulus. The remaining differences are a relaxation of beta t0, and a dashpot of
   !> viscosity E_1/beta beside the rubbery spring E_r. Without a plate the dashpot reduces cor by
   !> (6/5) (5/4)^(3/5) B(3/5, 3/2) E_1/(E_r beta T), with a plate by less
   subroutine limits(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: slow = 1.0e-7_wp, fast = 1.0e12_wp, drop = 0.25_wp
      ! the contact with the glassy modulus lasts 1.43 ms
      real(wp), parameter :: contact_time = 1.5e-3_wp, dashpot = 1.7302_wp*(1.0_wp/drop - 1.0_wp)
      type(strike_t) :: limit

      call law%begin('Standard linear solid on a plate with waves: its elastic limits', &
         'an elastic impact of the same modulus by the same method')
      limit = strike_t(elastic(modulus), waves=waves_relaxing)
      call law%add_check([strike_t(sls(modulus, drop*slow, slow), waves=waves_relaxing), limit])
      call law%add_row('cor, beta -> 0', times=2.0_wp, more=slow*contact_time, &
         reason='accuracies of the two, and beta t0', twin=2)
      limit = strike_t(elastic(drop*modulus), waves=waves_relaxing)
      call law%add_check([strike_t(sls(modulus, drop*fast, fast), waves=waves_relaxing), limit])
      call law%add_row('cor, beta -> infinity', times=2.0_wp, &
         more=dashpot/(fast*time_scale(limit, drop*modulus)), &
         reason='accuracies of the two, and the dashpot that is left', twin=2)
   end subroutine limits

   !> A material by the names and values of its parameters
   pure function described(model, names, values) result(data)
      character(len=*), intent(in) :: model, names(:)
      !> Values in SI units, shape (size(names))
      real(wp), intent(in) :: values(:)
      type(material_data_t) :: data

      integer :: i

      data%model = model
      do i = 1, size(names)
         call data%set(trim(names(i)), values(i))
      end do
   end function described

end module vcor_verify_closed_forms
