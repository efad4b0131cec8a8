!> Contacts other than Hertz's by the direct methods: flat punches, u = s, and cones, u = s^2
program test_exponents
   use vcor_error, only : error_t
   use vcor_impact_law, only : new_contact_law
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_target, only : waves_none
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_material_prony, only : new_elastic, new_prony, prony_t
   use vcor_solver_direct_product, only : product_t
   use vcor_solver_paper_adams_bashforth, only : adams_bashforth_t, new_adams_bashforth
   use vcor_solver_type, only : solver_settings_t
   use vcor_test, only : check_close, check_relative, finish, suite
   use vcor_test_cases, only : make_product, rigid_on_plate, run, success
   implicit none

   !> What product integration is asked for
   real(wp), parameter :: accuracy = 1.0e-7_wp
   !> The paper's scheme with 3000 steps: its sums leave out u' at first contact, which is not zero
   !> for n = 1, and start with t^(n-1): order one there, n in general
   real(wp), parameter :: paper_tolerance = 3.0e-4_wp

   call suite("exponents")
   call test_elastic()
   call test_dashpot()
   call finish()

contains

   !> An elastic impact loses nothing, and lasts as long as the closed form of the law says
   subroutine test_elastic()
      real(wp), parameter :: exponent(3) = [1.0_wp, 1.25_wp, 2.0_wp]
      type(prony_t) :: elastic
      type(impact_t) :: impact
      type(product_t) :: product
      type(adams_bashforth_t) :: paper
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      integer :: i

      call new_elastic(elastic, 15.0e6_wp, error)
      call make_product(0.0_wp, accuracy, product)
      call new_adams_bashforth(paper, solver_settings_t(), error)
      call success(error, "the paper's scheme is built")
      do i = 1, size(exponent)
         call rigid_on_plate(elastic, waves_none, 10.0_wp, impact)
         call new_contact_law(impact%law, exponent(i), .false., error)
         call success(error, "the law is built")
         call run(product, impact, outcome)
         call check_close(outcome%cor, 1.0_wp, accuracy, "product: nothing is lost")
         call check_relative(outcome%contact_time, impact%law%contact_time*impact%time_scale(), &
            10.0_wp*accuracy, "product: contact time")
         call run(paper, impact, outcome)
         call check_close(outcome%cor, 1.0_wp, paper_tolerance, "paper's scheme: nothing is lost")
         call check_relative(outcome%contact_time, impact%law%contact_time*impact%time_scale(), &
            paper_tolerance, "paper's scheme: contact time")
      end do
   end subroutine test_elastic

   !> A punch on a spring and a dashpot is a damped oscillator, up to where the force is zero
   subroutine test_dashpot()
      real(wp), parameter :: none(0) = 0.0_wp
      type(prony_t) :: material
      type(impact_t) :: impact
      type(product_t) :: product
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp) :: omega, damping, damped, angle, cor

      call new_prony(material, 1.0e6_wp, none, none, 20.0_wp, error)
      call success(error, "a spring and a dashpot are built")
      call rigid_on_plate(material, waves_none, 10.0_wp, impact)
      call new_contact_law(impact%law, 1.0_wp, .false., error)
      call make_product(0.0_wp, accuracy, product)
      call run(product, impact, outcome)
      omega = sqrt(impact%kernel(1.0_wp)/impact%mass)
      damping = 0.5_wp*impact%kernel_viscosity()/(impact%mass*omega)
      damped = sqrt(1.0_wp - damping**2)
      angle = acos(-1.0_wp) - atan(2.0_wp*damping*damped/(1.0_wp - 2.0_wp*damping**2))
      cor = exp(-damping/damped*angle)*(damping/damped*sin(angle) - cos(angle))
      call check_close(outcome%cor, cor, accuracy, "a damped oscillator: cor")
      call check_relative(outcome%contact_time, angle/(damped*omega), 10.0_wp*accuracy, &
         "a damped oscillator: contact time")
      call check_close(outcome%energy_imbalance/outcome%initial_energy, 0.0_wp, 1.0e-9_wp, &
         "a damped oscillator: the energies close")

      ! the force of a sphere starts as a root
      call rigid_on_plate(material, waves_none, 10.0_wp, impact)
      call run(product, impact, outcome)
      call check_close(outcome%energy_imbalance/outcome%initial_energy, 0.0_wp, 1.0e-9_wp, &
         "a sphere with a dashpot: the energies close")
   end subroutine test_dashpot

end program test_exponents
