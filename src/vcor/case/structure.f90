!> The structure that carries the struck surface, from the inputs of an impact
!>
!> Bodies of simple shape have their modes in closed form, up to a frequency that follows from the
!> time scale of the contact; a list of modes is taken as it is.
module vcor_case_structure
   use vcor_case_inputs, only : inputs_t, target_beam, target_block, target_inputs_t, &
      target_plate, target_rod
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_body, only : new_beam, new_block, new_panel, new_rod, support_cantilever, &
      support_clamped, support_free, support_supported
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : new_structure, structure_t
   use vcor_kinds, only : pi, unset, wp
   use vcor_material, only : material_t
   implicit none
   private

   public :: build_structure, highest_of_list

   !> Frequency up to which modes are kept one by one, over pi/(elastic contact time); those beyond
   !> it are kept together (`rest_t` of `vcor_impact_structure`). With a third of it the restitution
   !> changes by less than 1e-9, the largest force by 2e-5 on a thin glass pane that strikes a ball
   !> eight times; with two thirds by 3e-6
   real(wp), parameter :: highest = 300.0_wp

   !> Modal mass from which a mode counts as one that does not move at the struck point [kg]
   real(wp), parameter :: heaviest = 1.0e100_wp

contains

   !> Build the structure
   pure subroutine build_structure(structure, inputs, impact, material, error)
      type(structure_t), intent(out) :: structure
      type(inputs_t), intent(in) :: inputs
      !> The impact, for its time scale and gravity
      type(impact_t), intent(in) :: impact
      !> Material of the body; unallocated if it has none
      class(material_t), allocatable, intent(in) :: material
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: limit

      associate (target => inputs%target)
         limit = target%share*highest*pi/(impact%law%contact_time*impact%time_scale())
         select case (target%body)
         case (target_block)
            call new_block(structure, target%mass, target%stiffness, target%damping, error)
         case (target_beam, target_plate, target_rod)
            call build_body(structure, inputs, material, limit, error)
         case default
            call build_list(structure, target, error)
         end select
      end associate
      if (allocated(error)) return
      if (impact%gravity > 0.0_wp .and. structure%falls()) call raise(error, error_input, &
         'a structure with a mode of frequency 0 falls with the sphere: expected gravity = 0, or ' &
         //'a structure that is held', about='gravity body'//holding(inputs%target%body))
   end subroutine build_structure

   !> The key of a body that says whether it is held
   pure function holding(body) result(key)
      !> The body
      integer, intent(in) :: body
      !> Its name after a blank, filled up with blanks
      character(len=10) :: key

      key = ' support'
      if (body == target_block) key = ' stiffness'
      if (body /= target_block .and. all(body /= [target_beam, target_plate, target_rod])) &
         key = ' file'
   end function holding

   !> Build a plate, a beam or a rod
   pure subroutine build_body(structure, inputs, material, limit, error)
      type(structure_t), intent(out) :: structure
      type(inputs_t), intent(in) :: inputs
      class(material_t), intent(in) :: material
      !> Frequency up to which modes are kept [rad/s]
      real(wp), intent(in) :: limit
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: position(2), thickness

      associate (target => inputs%target)
         call check_support(target, error)
         if (allocated(error)) return
         if (material%rigid) then
            call raise(error, error_input, "the body of &target needs a material that deforms: " &
               //"expected another model, or body = 'block'", about='body')
         else if (.not. material%density() > 0.0_wp) then
            call raise(error, error_input, 'the modes of &target need it', about='density')
         else if (.not. material%glassy() > 0.0_wp) then
            call raise(error, error_input, 'the modes of &target need a material that is more ' &
               //'than a dashpot', about='body')
         end if
         if (allocated(error)) return
         if (target%body == target_rod) then
            call new_rod(structure, material, target%length, target%diameter, target%support, &
               target%damping_ratio, limit, error)
            return
         end if
         thickness = inputs%target_thickness()
         if (.not. thickness > 0.0_wp) then
            call raise(error, error_input, 'the body of &target needs its thickness [m], in ' &
               //'&target where &plate has a base', about='body')
            return
         end if
         call find_position(target, position, error)
         if (allocated(error)) return
         if (target%body == target_beam) then
            call new_beam(structure, material, target%length, target%width, thickness, &
               target%support, position(1), target%damping_ratio, limit, error)
         else
            call new_panel(structure, material, target%length, target%width, thickness, &
               position, target%damping_ratio, limit, error)
         end if
      end associate
   end subroutine build_body

   !> Check that the body can be held as the case says
   pure subroutine check_support(target, error)
      type(target_inputs_t), intent(in) :: target
      type(error_t), allocatable, intent(out) :: error

      select case (target%body)
      case (target_plate)
         if (target%support == support_clamped) then
            call raise(error, error_input, 'the modes of a clamped plate have no closed form: ' &
               //"give its modes from finite elements, with body = 'modes'", about='body support')
         else if (target%support /= support_supported) then
            call raise(error, error_input, "expected support = 'supported' of a plate, or its " &
               //"modes from finite elements, with body = 'modes'", about='body support')
         end if
      case (target_rod)
         if (all(target%support /= [support_free, support_clamped])) call raise(error, &
            error_input, "expected support = 'free' or 'clamped' of the far end of a rod", &
            about='body support')
      case default
         continue
      end select
   end subroutine check_support

   !> Place of the impact on a beam or a plate
   pure subroutine find_position(target, position, error)
      type(target_inputs_t), intent(in) :: target
      !> Along length and width [m]
      real(wp), intent(out) :: position(2)
      type(error_t), allocatable, intent(out) :: error

      integer :: wanted

      position = 0.5_wp*[target%length, target%width]
      if (target%support == support_cantilever) position(1) = target%length
      wanted = merge(2, 1, target%body == target_plate)
      if (size(target%position) == 0) return
      if (size(target%position) /= wanted) then
         if (wanted == 1) call raise(error, error_input, 'expected one number for a beam, the ' &
            //'distance from its left end', about='body position')
         if (wanted == 2) call raise(error, error_input, 'expected two numbers for a plate, ' &
            //'along length and width', about='body position')
         return
      end if
      position(:wanted) = target%position
      if (position(1) > target%length) then
         call raise(error, error_input, 'the impact is beyond the end of the structure: ' &
            //'expected 0 <= position <= length', about='position length')
      else if (wanted == 2 .and. position(2) > target%width) then
         call raise(error, error_input, 'the impact is beside the structure: expected ' &
            //'0 <= position <= width', about='position width')
      end if
   end subroutine find_position

   !> Build a structure of given modes
   pure subroutine build_list(structure, target, error)
      type(structure_t), intent(out) :: structure
      type(target_inputs_t), intent(in) :: target
      type(error_t), allocatable, intent(out) :: error

      real(wp), dimension(size(target%modes, 2)) :: w, damping, yield
      logical :: kept(size(target%modes, 2))

      w = 2.0_wp*pi*target%modes(1, :)
      damping = 2.0_wp*w*(target%modes(2, :) + target%damping_ratio)
      yield = 1.0_wp/target%modes(3, :)
      ! the others have the impact on their node
      kept = target%modes(3, :) < heaviest
      if (target%share < 1.0_wp) kept = kept .and. w <= target%share*maxval(w)
      if (.not. any(kept) .and. .not. target%residual_compliance > 0.0_wp) then
         call raise(error, error_input, 'the impact is on a node of every mode: the structure ' &
            //'does not move', about='file')
         return
      end if
      call new_structure(structure, pack(w**2, kept), pack(damping, kept), pack(yield, kept), &
         error, target%residual_compliance)
   end subroutine build_list

   !> Highest frequency of a list of modes that leaves out the flexibility of those beyond [rad/s];
   !> NaN if there is no such list
   pure function highest_of_list(target) result(frequency)
      type(target_inputs_t), intent(in) :: target
      real(wp) :: frequency

      frequency = unset
      if (.not. allocated(target%modes)) return
      if (target%residual_compliance > 0.0_wp .or. size(target%modes) == 0) return
      frequency = 2.0_wp*pi*maxval(target%modes(1, :))
      ! rigid motion is all that there is
      if (.not. frequency > 0.0_wp) frequency = unset
   end function highest_of_list

end module vcor_case_structure
