!> A hard ball of 10 mm on a thick block of rubber, without a case file
program from_code
   use vcor, only : contact_modulus_t, error_t, impact_t, new_contact_modulus, new_impact, &
      new_plate, new_rigid, new_sls, new_solver, outcome_t, target_t, prony_t, solve_impact, &
      solver_settings_t, solver_t, trajectory_t, waves_none, wp
   implicit none
   type(prony_t) :: steel, rubber
   type(contact_modulus_t) :: modulus
   type(target_t) :: block
   type(impact_t) :: impact
   class(solver_t), allocatable :: solver
   type(trajectory_t) :: trajectory
   type(outcome_t) :: outcome
   type(error_t), allocatable :: error
   integer :: i

   call new_rigid(steel)
   call new_sls(rubber, glassy_modulus=15.0e6_wp, alpha=300.0_wp, beta=1200.0_wp, error=error)
   if (.not. allocated(error)) call rubber%set_constants(error, poisson_ratio=0.5_wp)
   if (.not. allocated(error)) call new_contact_modulus(modulus, steel, rubber, .false., error)
   if (.not. allocated(error)) call new_plate(block, rubber, 0.0_wp, waves_none, error)
   if (.not. allocated(error)) call new_solver(solver, solver_settings_t(), error)
   do i = 1, 3
      if (.not. allocated(error)) call new_impact(impact, velocity=real(i, wp), mass=0.03_wp, &
         radius=0.01_wp, surface_radius=0.0_wp, modulus=modulus, target=block, error=error)
      if (.not. allocated(error)) call solve_impact(solver, impact, trajectory, outcome, error)
      if (allocated(error)) exit
      print '(i0, a, f11.8, a, es10.3, a)', i, ' m/s: COR ', outcome%cor, ', contact ', &
         outcome%contact_time, ' s'
   end do
   if (allocated(error)) then
      print '(a)', error%message
      stop 1
   end if
end program from_code
