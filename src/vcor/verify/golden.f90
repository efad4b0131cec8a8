!> Impacts of Green's paper in the verification table: our own reference values, and printed ones
module vcor_verify_golden
   use vcor_impact_plate, only : waves_frozen, waves_hereditary, waves_none, waves_relaxing
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_verify_law, only : elastic, law_t, others_follow, sls, strike_t
   implicit none
   private

   public :: golden, beyond, printed

   !> Compared quantities
   character(len=*), parameter :: quantity(6) = [character(len=20) :: 'cor', 'cor_sphere', &
      'contact_time', 'max_indentation', 'max_force', 'residual_ratio']
   !> Units of the table: milliseconds and millimetres
   real(wp), parameter :: unit(6) = [1.0_wp, 1.0_wp, 1.0e-3_wp, 1.0e-3_wp, 1.0_wp, 1.0_wp]
   !> Names in the table
   character(len=*), parameter :: label(6) = [character(len=24) :: 'cor', 'cor_sphere', &
      'contact time [ms]', 'largest indentation [mm]', 'largest force [N]', 'residual ratio']

contains

   !> Steel sphere on plates of four materials at 10 m/s. The values are the rows sls_v10,
   !> butyl_prony_v10, butyl_cerf_v10 and butyl_power_law_v10 of tests/reference/reference.csv, from
   !> spectral collocation of the Volterra equation, which has nothing in common with vcor's methods
   subroutine golden(law)
      type(law_t), intent(inout) :: law

      character(len=*), parameter :: title(4) = [character(len=5) :: 'SLS', 'Prony', 'CERF', &
         'power']
      real(wp), parameter :: value(6, 4) = reshape([ &
         0.4319868986469853_wp, 0.4022529366123597_wp, 1.341543033906264_wp, &
         4.506555295206217_wp, 601.0715760976508_wp, 0.5588879421032072_wp, &
         0.2572184845343607_wp, 0.2401796582154649_wp, 0.7871465613716795_wp, &
         2.358360778311079_wp, 931.2723845348596_wp, 0.6964562734650758_wp, &
         0.2244076321743272_wp, 0.2045604714651135_wp, 0.7606282481542651_wp, &
         2.215303361745405_wp, 940.8233886678752_wp, 0.7270799023942698_wp, &
         0.2114372758956541_wp, 0.1938882475239019_wp, 0.7748556793933617_wp, &
         2.179684101936804_wp, 921.2217702666395_wp, 0.7310900351604307_wp], [6, 4])
      integer :: i, k

      call law%begin("Steel on SLS and on BUTYL-B252 (three models), 10 m/s", &
         "impacts of I. Green's paper; own reference values, 13 digits")
      do i = 1, size(title)
         call law%add_check([strike_t(material(i), waves=waves_relaxing)])
         call law%add_row(trim(title(i))//': cor', value(1, i))
         do k = 2, size(quantity)
            call law%add_row(trim(title(i))//': '//trim(label(k)), value(k, i), &
               10.0_wp*max(1.0_wp, value(k, i)), reason=others_follow, quantity=quantity(k), &
               unit=unit(k))
         end do
      end do
   end subroutine golden

   !> The SLS impact with another contact, plate or pair than the paper's. The values are the
   !> impacts 6, 7, 9, 10, 66 and 67 of tests/reference/make_impacts.py, by the same method as above
   subroutine beyond(law)
      type(law_t), intent(inout) :: law

      character(len=*), parameter :: title(6) = [character(len=10) :: 'receding', 'frozen', &
         'hereditary', 'exact', 'series', 'all three']
      integer, parameter :: waves(6) = [waves_relaxing, waves_frozen, waves_hereditary, &
         waves_hereditary, waves_none, waves_hereditary]
      logical, parameter :: receding(6) = [.true., .false., .false., .true., .false., .true.]
      integer, parameter :: first_in_series = 5
      real(wp), parameter :: value(3, 6) = reshape([ &
         0.4479958101877601_wp, 0.4195242674135116_wp, 1.442593897176693_wp, &
         0.4293322403986276_wp, 0.4679154790149769_wp, 1.369817916591186_wp, &
         0.4711951774390171_wp, 0.4434202328073957_wp, 1.337438012199769_wp, &
         0.4875824381023549_wp, 0.4606655774754929_wp, 1.433384910695691_wp, &
         0.6127767320701085_wp, 0.6127767320701085_wp, 2.024774984972933_wp, &
         0.5317037221192804_wp, 0.5085781999891421_wp, 2.206094551675828_wp], [3, 6])
      type(strike_t) :: strike
      integer :: i

      call law%begin('SLS plate, 10 m/s: receding contact, two plates, both exact ones, series', &
         'own reference values, 12 digits: Ting, correspondence principle, compliances in series')
      do i = 1, size(title)
         strike = strike_t(material(1), waves=waves(i), receding=receding(i))
         if (i >= first_in_series) strike%sphere = sls(8.0e6_wp, 360.0_wp, 900.0_wp)
         call law%add_check([strike])
         call law%add_row(trim(title(i))//': cor', value(1, i))
         call law%add_row(trim(title(i))//': cor_sphere', value(2, i), quantity='cor_sphere')
         call law%add_row(trim(title(i))//': contact time [ms]', value(3, i), 10.0_wp*value(3, i), &
            reason=others_follow, quantity='contact_time', unit=unit(3))
      end do
   end subroutine beyond

   !> Digits printed in the paper that do not depend on its discretisation; the others are
   !> reproduced with its scheme, see docs/reproducing_the_paper.md
   subroutine printed(law)
      type(law_t), intent(inout) :: law

      character(len=*), parameter :: half_digit = "half a unit of the last digit printed"

      call law%begin("Printed numbers of the paper that do not depend on its scheme", &
         'I. Green, The Viscoelastic Coefficient of Restitution; the digits as printed')
      call law%add_check([strike_t(elastic(15.0e6_wp), waves=waves_relaxing)], 'ive')
      call law%add_row('elastic limit: cor', 0.79_wp, 0.0_wp, 0.005_wp, half_digit)
      call law%add_row('elastic limit: t0 [ms]', 1.4_wp, 0.0_wp, 0.05_wp, half_digit, &
         'contact_time', 1.0e-3_wp)
      call law%add_check([strike_t(material(1), waves=waves_relaxing)], 'ive')
      call law%add_row('SLS: t0 [ms]', 1.34_wp, 0.0_wp, 0.005_wp, half_digit, 'contact_time', &
         1.0e-3_wp)
      call law%add_row('SLS: 2 pi/t0 [rad/s]', 4684.0_wp, 0.0_wp, 0.5_wp, half_digit, &
         'min_frequency')
   end subroutine printed

   !> Materials of the paper, Eqs. (14), (26), (24) and (23-b)
   pure function material(number) result(data)
      !> Number, 1 .. 4
      integer, intent(in) :: number
      type(material_data_t) :: data

      select case (number)
      case (1)
         data = sls(15.0e6_wp, 300.0_wp, 1200.0_wp)
      case (2)
         data%model = 'prony'
         call data%set('equilibrium_modulus', 10.421e6_wp)
         call data%set_list('moduli', [20.181e6_wp, 38.204e6_wp, 87.344e6_wp])
         call data%set_list('rates', [972.0_wp, 6426.0_wp, 34221.0_wp])
      case (3)
         data%model = 'cerf'
         call data%set('equilibrium_modulus', 0.442e6_wp)
         call data%set('relaxing_modulus', 676.5e6_wp)
         call data%set('beta', 700.0_wp)
      case default
         data%model = 'power_law'
         call data%set('equilibrium_modulus', 2.28e6_wp)
         call data%set('coefficient', 0.885e6_wp)
         call data%set('exponent', 0.5_wp)
      end select
   end function material

end module vcor_verify_golden
