!> Meshes of an impact: steps, springs and hats of each level, and scales of its window and radius
module vcor_solver_coupled_plan
   use vcor_impact_face, only : face_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver_coupled_kernel, only : mesh_t
   use vcor_tuning, only : most_iterations
   implicit none
   private

   public :: first_steps, is_curved, mesh_of, precise, rounded, scale_t, scales, with_more_hats

   !> Scales to which window and radius are rounded
   type :: scale_t
      !> Time [s] and length [m]
      real(wp) :: time = 0.0_wp, length = 0.0_wp
   end type scale_t

   !> Steps of the coarsest mesh
   integer, parameter :: first_steps = 160
   !> Exponent of the law of a cone, which has no length
   real(wp), parameter :: cone = 2.0_wp
   !> Accuracy of a time scale, so that results do not depend on units
   real(wp), parameter :: precise = 1.0e-12_wp

contains

   !> Mesh of a level: twice the steps of the level before, with more springs and hats. The edge of
   !> the contact lies between springs, so that few suffice: from 192 to 112 the coefficient of
   !> restitution of 50 random impacts changes by 2e-6 at most. With a dashpot the pressure ends
   !> with a step there, and 112 springs would err by up to 2e-5. The response of a layer varies
   !> over its thickness, which the longest hats resolve
   pure function mesh_of(level, face, window, radius) result(mesh)
      !> Level, from 0
      integer, intent(in) :: level
      type(face_t), intent(in) :: face
      !> Duration of all steps [s]
      real(wp), intent(in) :: window
      !> Radius of the row of springs [m]
      real(wp), intent(in) :: radius
      type(mesh_t) :: mesh

      ! of a contact of eight thicknesses; a kernel takes operations with the square of all hats, of
      ! a wider contact a hundred times those of a half space
      integer, parameter :: most_for_layer = 24
      integer, parameter :: springs = 112, springs_of_viscous = 192

      mesh = mesh_t(first_steps*2**level, nint(real(merge(springs_of_viscous, springs, &
         face%is_viscous()), wp)*1.5_wp**level), 8 + 2*level, window, radius)
      if (face%thickness > 0.0_wp) mesh%hats = mesh%hats &
         + int(min(3.0_wp*radius/face%thickness, real(most_for_layer, wp)))
   end function mesh_of

   !> Mesh with twice the elements of hats
   pure function with_more_hats(mesh) result(wide)
      type(mesh_t), intent(in) :: mesh
      type(mesh_t) :: wide

      wide = mesh
      wide%hats = 2*mesh%hats - 1
   end function with_more_hats

   !> Scales of an impact that do not depend on its velocity, so that a sweep of velocities shares
   !> kernels, and not on units: the length at which the body is as deep as it is wide, and the time
   !> in which the contact would push the body as far. A cone has no such length but that of the
   !> layer, or else of its own impact
   pure function scales(impact) result(scale)
      type(impact_t), intent(in) :: impact
      type(scale_t) :: scale

      ! digits of the time scale beyond which rounding would keep the iteration going
      real(wp), parameter :: same = 1.0e-13_wp
      real(wp) :: guess, stiffness
      integer :: i

      scale%time = impact%time_scale(precise)
      if (abs(impact%law%start_exponent - cone) > 0.0_wp) then
         scale%length = impact%factor**(1.0_wp/(cone - impact%law%start_exponent))
      else if (impact%face%thickness > 0.0_wp) then
         scale%length = impact%face%thickness
      else
         scale%length = scale%time*impact%speed_scale(scale%time)
         return
      end if
      ! from no time of its own, for neighbours share it to the last bit
      guess = 1.0_wp
      ! the map contracts by half of the exponent of a power law at least
      do i = 1, most_iterations
         stiffness = (impact%kernel_integral(guess) + impact%kernel_viscosity())/guess &
            *scale%length**(impact%law%start_exponent - 1.0_wp)
         scale%time = sqrt(impact%mass/stiffness)
         if (abs(scale%time - guess) <= same*guess) exit
         guess = scale%time
      end do
   end function scales

   !> Whether the contact has no fixed radius, which only that of a flat punch has
   pure function is_curved(impact)
      type(impact_t), intent(in) :: impact
      logical :: is_curved

      is_curved = impact%law%start_exponent > 1.0_wp
   end function is_curved

   !> Round up to a scale times a power of a ratio
   pure function rounded(value, ratio, scale)
      !> Number, > 0
      real(wp), intent(in) :: value
      !> Ratio, > 1
      real(wp), intent(in) :: ratio
      !> Scale, > 0
      real(wp), intent(in) :: scale
      real(wp) :: rounded

      rounded = scale*ratio**ceiling(log(value/scale)/log(ratio))
   end function rounded

end module vcor_solver_coupled_plan
