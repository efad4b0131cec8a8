!> Laws of the verification table about a layer on a rigid base
module vcor_verify_layer
   use vcor_impact_plate, only : waves_none
   use vcor_kinds, only : wp
   use vcor_verify_law, only : elastic, law_t, sls, strike_t, time_scale
   implicit none
   private

   public :: layer

contains

   !> A sphere on 10 mm of an incompressible material that is bonded to a rigid floor. Elastic, it
   !> loses nothing, and contact time and force tell how stiff the layer is: on a half space they
   !> would be 3.218 T and 1.143 m v0/T. The paper's rubber, with receding contact, has 0.5575 at
   !> 2 m/s on a half space. The numbers are from tests/reference/make_layers.py
   subroutine layer(law)
      type(law_t), intent(inout) :: law

      ! accuracy of the table of the law
      real(wp), parameter :: of_table = 1.0e-10_wp
      character(len=*), parameter :: why = 'the law of a layer is a table of ten digits'
      real(wp), parameter :: modulus = 15.0e6_wp, thickness = 0.01_wp
      type(strike_t) :: strike
      real(wp) :: scale

      call law%begin('Sphere on a layer that is bonded to a rigid floor', &
         'Fredholm equation of the contact and a solver of ordinary differential equations')
      strike = strike_t(elastic(modulus), waves=waves_none, layer=thickness)
      scale = time_scale(strike, modulus)
      call law%add_check([strike])
      call law%add_row('cor, elastic', 1.0_wp, more=of_table, reason=why)
      call law%add_row('contact time / T', 2.27182506339_wp, 10.0_wp, of_table, why, &
         quantity='contact_time', unit=scale)
      call law%add_row('largest force T / (m v0)', 1.83497066338_wp, 10.0_wp, of_table, &
         why, quantity='max_force', unit=strike%mass*strike%velocity/scale)
      strike = strike_t(sls(modulus, 300.0_wp, 1200.0_wp), waves=waves_none, velocity=2.0_wp, &
         layer=thickness, receding=.true.)
      call law%add_check([strike])
      call law%add_row("cor, the paper's rubber", 0.613633897937_wp, more=of_table, &
         reason=why)
      call law%add_row('contact time / 1.59305016428 ms', 1.0_wp, 10.0_wp, of_table, &
         why, quantity='contact_time', unit=1.59305016428e-3_wp)
   end subroutine layer

end module vcor_verify_layer
