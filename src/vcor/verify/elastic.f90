!> Laws of elastic impacts for the verification table: Hertz and Zener
module vcor_verify_elastic
   use vcor_impact_plate, only : waves_constant, waves_relaxing
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_verify_methods, only : methods_for
   use vcor_verify_impacts, only : elastic, hertz_duration, &
      hertz_scale, strike, zener_plate
   use vcor_verify_row, only : accuracy_of, law_t
   implicit none
   private

   public :: hertz, zener

   !> Modulus of the elastic bodies [Pa]; in units of T nothing depends on it
   real(wp), parameter :: modulus = 15.0e6_wp
   !> Accuracy of quantities other than cor over that of cor: the steps are chosen for cor, the
   !> others follow with errors of the same order
   real(wp), parameter :: other_quantities = 10.0_wp

contains

   !> Hertz's impact, m s'' = -k s^1.5 with s(0) = 0, s'(0) = v0. By the energy integral
   !> s'^2 = v0^2 - (4/5) (k/m) s^(5/2) the largest indentation is (5/4)^(2/5) v0 T with
   !> T = (m/(k sqrt(v0)))^(2/5), the largest force k s^1.5 = (5/4)^(3/5) m v0/T, and the duration
   !> 2 int ds/s' = (4/5) B(2/5, 1/2) (5/4)^(2/5) T = 3.2180654597190435 T. Nothing is lost
   subroutine hertz(law)
      !> The law
      type(law_t), intent(inout) :: law

      character(len=*), parameter :: why = 'twice what the method is asked for'
      character(len=*), parameter :: why_other = 'ten times the accuracy asked of cor'
      type(impact_t) :: impact
      character(len=6) :: methods(2)
      real(wp) :: scale, tolerance
      integer :: i

      call law%begin('Elastic sphere on a half space: nothing is lost', &
         'H. Hertz, J. reine angew. Math. 92 (1882) 156; closed forms')
      call strike(impact, law%error, elastic(modulus))
      if (allocated(law%error)) return
      scale = hertz_scale(impact)
      methods = methods_for()
      do i = 1, size(methods)
         tolerance = accuracy_of(methods(i))
         call law%add('cor', methods(i), 1.0_wp, tolerance, why, impact)
         tolerance = other_quantities*tolerance
         call law%add('contact time / T', methods(i), hertz_duration, tolerance, why_other, &
            quantity='contact_time', unit=scale)
         call law%add('largest indentation / (v0 T)', methods(i), 1.25_wp**0.4_wp, tolerance, &
            why_other, quantity='max_indentation', unit=impact%velocity*scale)
         call law%add('largest force T / (m v0)', methods(i), 1.25_wp**0.6_wp, tolerance, &
            why_other, quantity='max_force', unit=impact%mass*impact%velocity/scale)
         call law%add('hysteresis / energy', methods(i), 0.0_wp, tolerance, why_other, &
            quantity='hysteresis_energy', unit=impact%initial_energy())
      end do
   end subroutine hertz

   !> Zener's elastic sphere on an elastic plate that carries waves away,
   !> sigma'' + sigma^1.5 + lambda (sigma^1.5)' = 0 with sigma(0) = 0, sigma'(0) = 1: restitution
   !> -sigma' at the end is a function of lambda alone. The numbers are those of the script
   !> tests/reference/make_kelvin_voigt.py, by Taylor series in 50 digits, and agree with the 13
   !> digits of tests/reference/reference.csv, which come from another method
   subroutine zener(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: lambda(3) = [0.05_wp, 0.2_wp, 1.0_wp]
      character(len=4), parameter :: label(3) = ['0.05', '0.20', '1.00']
      real(wp), parameter :: cor(3) = [0.91777150179007443633_wp, 0.71404487999215247657_wp, &
         0.18412287416504999366_wp]
      character(len=*), parameter :: name(waves_constant:waves_relaxing) = &
         [character(len=8) :: 'constant', 'relaxing']
      character(len=*), parameter :: why = 'twice what the method is asked for'
      type(impact_t) :: impact
      character(len=6) :: methods(2)
      integer :: i, j, waves

      call law%begin('Elastic sphere on an elastic plate with waves: cor depends on lambda', &
         'C. Zener, Phys. Rev. 59 (1941) 669; his equation by Taylor series, 16 digits')
      do i = 1, size(lambda)
         do waves = waves_constant, waves_relaxing
            call zener_plate(impact, law%error, elastic(modulus), waves, lambda(i))
            if (allocated(law%error)) return
            methods = methods_for()
            do j = 1, size(methods)
               call law%add('cor, lambda = '//label(i)//', '//trim(name(waves)), &
                  methods(j), cor(i), accuracy_of(methods(j)), why, impact)
            end do
         end do
      end do
   end subroutine zener

end module vcor_verify_elastic
