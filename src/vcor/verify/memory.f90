!> Laws of materials with memory for the verification table
module vcor_verify_memory
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_plate, only : waves_relaxing
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_verify_methods, only : methods_for
   use vcor_verify_impacts, only : elastic, hertz_duration, &
      hertz_scale, sls, strike
   use vcor_verify_row, only : accuracy_of, law_t
   implicit none
   private

   public :: power_law, mittag_leffler, weak_maxwell, scaling, limits

   !> Glassy modulus of the paper's standard linear solid [Pa]
   real(wp), parameter :: glassy = 15.0e6_wp
   !> Why most tolerances are what they are
   character(len=*), parameter :: as_asked = 'twice what the method is asked for'

contains

   !> A pure power law has no time scale: in units of its own T the impact has no parameter left but
   !> the exponent. Two impacts that differ in everything else show it
   subroutine power_law(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: exponent(3) = [0.25_wp, 0.5_wp, 0.75_wp]
      character(len=*), parameter :: label(3) = ['0.25', '0.50', '0.75']
      real(wp), parameter :: cor(3) = [0.57164767998043_wp, 0.28565312277610_wp, &
         0.097580216965_wp]
      type(material_data_t) :: data
      type(impact_t) :: impact(2)
      character(len=6) :: methods(2)
      integer :: i, j, k

      call law%begin('Power law t^-a on a half space: cor depends on a alone', &
         'no time scale; numbers: own reference values, 12 digits')
      data%model = 'power_law'
      do i = 1, size(exponent)
         call data%set('exponent', exponent(i))
         call data%set('coefficient', 1.0e6_wp)
         call strike(impact(1), law%error, data)
         call data%set('coefficient', 3.0e4_wp)
         call strike(impact(2), law%error, data, velocity=0.3_wp, mass=2.0e-3_wp, radius=4.0e-3_wp)
         if (allocated(law%error)) return
         methods = methods_for()
         do j = 1, size(methods)
            do k = 1, 2
               call law%add('cor, a = '//label(i)//trim(merge('         ', ', another', k == 1)), &
                  methods(j), cor(i), accuracy_of(methods(j)), as_asked, impact(k))
            end do
         end do
      end do
   end subroutine power_law

   !> Mittag-Leffler's function of exponent 1/2, E_0 + E_1 E_{1/2}(-sqrt(t/tau)), is CERF's
   !> exp(b^2 t) erfc(b sqrt(t)) with b = tau^(-1/2), and that of exponent 1 is exp(-t/tau), the
   !> standard linear solid. The two of each pair are different code for E(t), its integral and its
   !> spectrum
   subroutine mittag_leffler(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: beta = 700.0_wp, rate = 1200.0_wp, drop = 0.25_wp
      character(len=*), parameter :: why = 'accuracies of the two'
      type(material_data_t) :: data, cerf
      type(impact_t) :: impact, other
      character(len=6) :: methods(2)
      integer :: i

      call law%begin('Mittag-Leffler material: its relatives', &
         'identities of the Mittag-Leffler function; an impact by the other model')
      methods = methods_for()
      cerf%model = 'cerf'
      call cerf%set('equilibrium_modulus', 0.442e6_wp)
      call cerf%set('relaxing_modulus', 676.5e6_wp)
      call cerf%set('beta', beta)
      data%model = 'mittag_leffler'
      call data%set('equilibrium_modulus', cerf%number('equilibrium_modulus'))
      call data%set('relaxing_modulus', cerf%number('relaxing_modulus'))
      call data%set('exponent', 0.5_wp)
      call data%set('time', 1.0_wp/beta**2)
      call strike(impact, law%error, data, waves_relaxing)
      call strike(other, law%error, cerf, waves_relaxing)
      if (allocated(law%error)) return
      do i = 1, size(methods)
         call law%add_pair('cor, exponent 1/2: CERF', methods(i), 2.0_wp*accuracy_of(methods(i)), &
            why, impact, other)
      end do
      call data%set('equilibrium_modulus', drop*glassy)
      call data%set('relaxing_modulus', (1.0_wp - drop)*glassy)
      call data%set('exponent', 1.0_wp)
      call data%set('time', 1.0_wp/rate)
      call strike(impact, law%error, data, waves_relaxing)
      call strike(other, law%error, sls(glassy, drop*rate, rate), waves_relaxing)
      if (allocated(law%error)) return
      do i = 1, size(methods)
         call law%add_pair('cor, exponent 1: SLS', methods(i), 2.0_wp*accuracy_of(methods(i)), &
            why, impact, other)
      end do
   end subroutine mittag_leffler

   !> A Maxwell fluid, k exp(-t/tau), that relaxes little within Hertz's contact time t_c. With q
   !> the relaxed part of u, F = k (u - q) and q' = F/(k tau), so q = I/(k tau) exactly and
   !>
   !>     W_h = int F ds = (1/tau) int F s dt - (3/5) k s0^(5/2),   k s0^(3/2) = I0/tau
   !>
   !> at the end of contact. In Hertz's impact int F s dt = m int s'^2 dt = (10/9) W0 t_c and I0 = 2
   !> m v0. With epsilon = t_c/tau and t_c = 3.218 T that makes
   !>
   !>     (1 - e)/epsilon = 5/9 - c epsilon^(2/3) + O(epsilon),   c = (3/5) (2/3.218)^(5/3)
   !>
   !> and all powers of epsilon^(1/3) from there on. Three impacts with epsilon falling by 8 give
   !> the limit with the powers 2/3 and 1 removed, and c with the two powers after it removed
   subroutine weak_maxwell(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: epsilon(3) = 1.0e-2_wp*[1.0_wp, 1.0_wp/8.0_wp, 1.0_wp/64.0_wp]
      real(wp), parameter :: c = 0.6_wp*(2.0_wp/hertz_duration)**(5.0_wp/3.0_wp)
      type(impact_t) :: impact, impacts(3)
      real(wp) :: contact_time, noise
      integer :: i

      call law%begin('Maxwell fluid that relaxes little: (1 - cor) tau/t_c', &
         'first order of the energy balance, derived in docs/theory.md')
      call strike(impact, law%error, elastic(glassy))
      if (allocated(law%error)) return
      contact_time = hertz_duration*hertz_scale(impact)
      do i = 1, size(epsilon)
         call strike(impacts(i), law%error, sls(glassy, 0.0_wp, epsilon(i)/contact_time))
      end do
      if (allocated(law%error)) return
      noise = accuracy_of('ive')/epsilon(3)
      call law%add_measure('limit', 'ive', 5.0_wp/9.0_wp, &
         epsilon(2)**(4.0_wp/3.0_wp) + 2.0_wp*noise, &
         'accuracy over t_c/tau, and the power 4/3 that is left', epsilon, impacts, maxwell_limit)
      call law%add_measure('coefficient of (t_c/tau)^(2/3)', 'ive', -c, epsilon(2) + &
         4.0_wp*noise/epsilon(3)**(2.0_wp/3.0_wp), &
         'accuracy over (t_c/tau)^(5/3), and the power 1 that is left', epsilon, &
         measure=maxwell_slope)
   end subroutine weak_maxwell

   !> Limit of (1 - cor)/epsilon, the powers 2/3 and 1 removed
   pure function maxwell_limit(outcomes, epsilon) result(limit)
      !> Outcomes, epsilon falling by 8 from one to the next, shape (3)
      type(outcome_t), intent(in) :: outcomes(:)
      !> t_c/tau, shape (3)
      real(wp), intent(in) :: epsilon(:)
      !> Limit [-]
      real(wp) :: limit

      real(wp) :: ratio(3), first(2)

      ratio = (1.0_wp - outcomes%cor)/epsilon
      first = (4.0_wp*ratio(2:3) - ratio(1:2))/3.0_wp
      limit = (8.0_wp*first(2) - first(1))/7.0_wp
   end function maxwell_limit

   !> Coefficient of epsilon^(2/3) in (1 - cor)/epsilon, the next powers 1/3 and 2/3 removed
   pure function maxwell_slope(outcomes, epsilon) result(slope)
      !> Outcomes, epsilon falling by 8 from one to the next, shape (3)
      type(outcome_t), intent(in) :: outcomes(:)
      !> t_c/tau, shape (3)
      real(wp), intent(in) :: epsilon(:)
      !> Coefficient [-]
      real(wp) :: slope

      real(wp) :: ratio(3), first(2)

      ratio = ((1.0_wp - outcomes%cor)/epsilon - 5.0_wp/9.0_wp)/epsilon**(2.0_wp/3.0_wp)
      first = 2.0_wp*ratio(2:3) - ratio(1:2)
      slope = (4.0_wp*first(2) - first(1))/3.0_wp
   end function maxwell_slope

   !> Without a plate mass m, Hertz radius R and speed enter the impact through m/sqrt(R v0) alone.
   !> Factors that are powers of 4 keep that ratio to the last bit, so that both impacts take the
   !> same steps
   subroutine scaling(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: velocity = 3.0_wp, mass = 0.02_wp, radius = 0.01_wp
      ! some tens of roundings of numbers near 1
      real(wp), parameter :: rounding = 1.0e-14_wp
      character(len=*), parameter :: why = 'rounding'
      type(material_data_t) :: data(2)
      character(len=6) :: methods(2)
      type(impact_t) :: one, other
      integer :: i, j

      call law%begin('Half space: mass, radius and speed enter through m/sqrt(R v0) alone', &
         'dimensional analysis; an impact against one of the same m/sqrt(R v0)')
      data(1)%model = 'prony'
      call data(1)%set('equilibrium_modulus', 1.0e6_wp)
      call data(1)%set_list('moduli', [2.0e6_wp, 5.0e6_wp])
      call data(1)%set_list('rates', [300.0_wp, 4000.0_wp])
      data(2)%model = 'cerf'
      call data(2)%set('equilibrium_modulus', 1.0e6_wp)
      call data(2)%set('relaxing_modulus', 5.0e6_wp)
      call data(2)%set('beta', 50.0_wp)
      do i = 1, 2
         call strike(one, law%error, data(i), velocity=velocity, mass=mass, radius=radius)
         if (allocated(law%error)) return
         methods = methods_for()
         do j = 1, size(methods)
            call strike(other, law%error, data(i), velocity=16.0_wp*velocity, mass=4.0_wp*mass, &
               radius=radius)
            if (allocated(law%error)) return
            call law%add_pair('cor, '//trim(data(i)%model)//', 4 m and 16 v0', methods(j), &
               rounding, why, other, one)
            call strike(other, law%error, data(i), velocity=velocity, mass=0.25_wp*mass, &
               radius=radius/16.0_wp)
            if (allocated(law%error)) return
            call law%add_pair('cor, '//trim(data(i)%model)//', m/4 and R/16', methods(j), &
               rounding, why, other, one)
         end do
      end do
   end subroutine scaling

   !> A standard linear solid that relaxes never, or at once, is elastic with its glassy, or its
   !> rubbery modulus. What is left of the other limit: a relaxation by beta t0; and a dashpot of
   !> viscosity E_1/beta beside the rubbery spring E_r, which without the plate costs
   !> (6/5) (5/4)^(3/5) B(3/5, 3/2) E_1/(E_r beta T) of the restitution, with it less
   subroutine limits(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: slow = 1.0e-7_wp, fast = 1.0e12_wp, drop = 0.25_wp
      ! the contact with the glassy modulus lasts 1.43 ms
      real(wp), parameter :: contact_time = 1.5e-3_wp, dashpot = 1.7302_wp*(1.0_wp/drop - 1.0_wp)
      type(impact_t) :: impact, limit
      character(len=6) :: methods(2)
      integer :: i

      call law%begin('Standard linear solid on a plate with waves: its elastic limits', &
         'an elastic impact of the same modulus by the same method')
      call strike(impact, law%error, sls(glassy, drop*slow, slow), waves_relaxing)
      call strike(limit, law%error, elastic(glassy), waves_relaxing)
      if (allocated(law%error)) return
      methods = methods_for()
      do i = 1, size(methods)
         call law%add_pair('cor, beta -> 0', methods(i), slow*contact_time &
            + 2.0_wp*accuracy_of(methods(i)), 'accuracies of the two, and beta t0', impact, limit)
      end do
      call strike(impact, law%error, sls(glassy, drop*fast, fast), waves_relaxing)
      call strike(limit, law%error, elastic(drop*glassy), waves_relaxing)
      if (allocated(law%error)) return
      do i = 1, size(methods)
         call law%add_pair('cor, beta -> infinity', methods(i), &
            dashpot/(fast*hertz_scale(limit)) + 2.0_wp*accuracy_of(methods(i)), &
            'accuracies of the two, and the dashpot that is left', impact, limit)
      end do
   end subroutine limits

end module vcor_verify_memory
