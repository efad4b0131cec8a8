!> A steel ball on the tip of a cantilever, and on an anvil on a load cell
program from_structure
   use vcor, only : contact_modulus_t, error_t, impact_t, new_beam, new_block, &
      new_contact_modulus, new_elastic, new_impact, new_target, outcome_t, prony_t, solve_impact, &
      structure_t, support_cantilever, target_t, wp
   implicit none
   type(prony_t) :: steel
   type(contact_modulus_t) :: modulus
   type(structure_t) :: structure
   type(target_t) :: target
   type(impact_t) :: impact
   type(outcome_t) :: outcome
   type(error_t), allocatable :: error
   integer :: i

   call new_elastic(steel, 210.0e9_wp, error)
   if (.not. allocated(error)) call steel%set_constants(error, 7850.0_wp, 0.3_wp)
   if (.not. allocated(error)) call new_contact_modulus(modulus, steel, steel, .true., error)
   do i = 1, 2
      if (allocated(error)) exit
      if (i == 1) then
         ! modes up to a frequency of some 200 pi over the contact time, and the rest as a few
         call new_beam(structure, steel, length=0.15_wp, width=0.02_wp, thickness=0.003_wp, &
            support=support_cantilever, position=0.15_wp, damping_ratio=0.02_wp, &
            highest=2.0e7_wp, error=error)
      else
         call new_block(structure, mass=0.2_wp, stiffness=1.0e8_wp, damping=0.0_wp, error=error)
      end if
      if (allocated(error)) exit
      call new_target(target, structure)
      call new_impact(impact, velocity=1.0_wp, mass=4.11e-3_wp, radius=0.005_wp, &
         surface_radius=0.0_wp, modulus=modulus, target=target, error=error)
      if (.not. allocated(error)) call solve_impact(impact, outcome, error)
      if (allocated(error)) exit
      print '(a, f9.6, a, i0, a)', 'COR ', outcome%cor_sphere, ', ', outcome%contacts, ' contacts'
   end do
   if (allocated(error)) then
      print '(a)', error%message
      stop 1
   end if
end program from_structure
