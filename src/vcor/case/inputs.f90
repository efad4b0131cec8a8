!> The inputs of an impact: what a case says, in SI, with one name for each quantity
!>
!> `vcor_case_reader` makes them from a case and is the only place that knows its keys.
!> `vcor_case_problem` builds impact and solver from them. They are a value: a point of a sweep, or
!> another model of the same impact, is a copy with other components.
!>
!> A new quantity is a component here, a line of `put` if it is a number, its use in
!> `vcor_case_problem`, and its key's row in the catalogue. Two keys for one quantity, such as
!> diameter, are two lines of `put`.
module vcor_case_inputs
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_impact_contact, only : pair_eq1
   use vcor_impact_face, only : base_free
   use vcor_impact_shape, only : shape_parameters, shape_sphere
   use vcor_impact_target, only : waves_relaxing
   use vcor_kinds, only : pi, standard_gravity, unset, wp
   use vcor_material, only : material_data_t
   use vcor_solver_type, only : solver_settings_t
   implicit none
   private

   public :: inputs_t, target_inputs_t, input_key_t, is_same, put_list
   public :: waves_body, of_sphere, of_plate, of_target, positive_or_zero
   public :: target_none, target_plate, target_beam, target_rod, target_block, target_modes

   !> Waves in a plate of any thickness, beside the `waves_*` of a thin one
   integer, parameter :: waves_body = 5
   !> Places of the bodies; the last one is the structure that carries the struck surface
   integer, parameter :: of_sphere = 1, of_plate = 2, of_target = 3
   !> Kinds of structures
   integer, parameter :: target_none = 0, target_plate = 1, target_beam = 2, target_rod = 3, &
      target_block = 4, target_modes = 5

   !> A struck structure; a number that is not given is NaN
   type :: target_inputs_t
      !> One of the `target_*` constants
      integer :: body = target_none
      !> One of the `support_*` constants of `vcor_impact_body`
      integer :: support = 0
      !> Length, width, diameter and thickness [m]
      real(wp) :: length = unset, width = unset, diameter = unset, thickness = unset
      !> Place of the impact along length and width [m]; shape (0): the middle, or the tip
      real(wp), allocatable :: position(:)
      !> Damping ratio of each mode [-]
      real(wp) :: damping_ratio = 0.0_wp
      !> Mass [kg], spring [N/m] and dashpot [N s/m] of a block
      real(wp) :: mass = unset, stiffness = 0.0_wp, damping = 0.0_wp
      !> Flexibility of modes left out [m/N]
      real(wp) :: residual_compliance = 0.0_wp
      !> Frequencies [Hz], damping ratios [-] and modal masses [kg], shape (3, modes)
      real(wp), allocatable :: modes(:, :)
      !> Share of the modes that is kept [-]: less than 1 shows what the others are worth
      real(wp) :: share = 1.0_wp
   contains
      procedure :: put => put_target
   end type target_inputs_t

   !> The inputs; a number that is not given is NaN
   type :: inputs_t
      !> Velocity of approach [m/s], or in its place the height of a drop [m]
      real(wp) :: velocity = unset, drop_height = unset
      !> Gravity along the impact [m/s2]
      real(wp) :: gravity = unset
      !> Place of the shape in `shapes` of `vcor_impact_shape`
      integer :: shape = shape_sphere
      !> Radius of a sphere [m]
      real(wp) :: radius = unset
      !> Mass of the striking body [kg]; not given: that of a sphere of this radius
      real(wp) :: mass = unset
      !> Numbers of other shapes, in the order and the units of `shape_parameters`
      real(wp) :: shape_numbers(size(shape_parameters)) = unset
      !> Materials of sphere, plate and structure; their lists are compared by identities
      type(material_data_t) :: material(3)
      !> Yield strengths of sphere and plate [Pa]
      real(wp) :: yield_strength(2) = unset
      !> Numbers of the materials in the case, for messages; equal: one material; 0: none
      integer :: item(3) = 0
      !> One of base_free, base_bonded and base_sliding
      integer :: base = base_free
      !> One of the `waves_*` constants
      integer :: waves = waves_relaxing
      !> Whether `mechanics` chose the waves for this kind of surface: a second sphere has none
      logical :: waves_are_chosen = .false.
      !> Half the thickness of the plate or layer [m]; 0 if there is none
      real(wp) :: half_thickness = 0.0_wp
      !> Radius of curvature of the surface [m]: 0 = flat, negative = concave
      real(wp) :: surface_radius = 0.0_wp
      !> Distance to the nearest edge of the plate [m]
      real(wp) :: extent = unset
      !> The structure that carries the struck surface
      type(target_inputs_t) :: target
      !> Whether the contact recedes
      logical :: receding = .false.
      !> One of the `pair_*` constants
      integer :: pair = pair_eq1
      !> Settings of the solution
      type(solver_settings_t) :: settings
   contains
      procedure :: put
      procedure :: approach_velocity
      procedure :: striking_mass
      procedure :: target_thickness
      procedure :: is_one_contact
   end type inputs_t

   !> A number of the inputs that varies: the key and the bodies that it belongs to
   type :: input_key_t
      !> Its key
      character(len=26) :: key = ''
      !> Whether it is of the material of the sphere, of the plate, and of the structure
      logical :: of_body(3) = .false.
      !> Whether it is of the structure itself
      logical :: of_structure = .false.
      !> Index of the number in a list; 0: no list
      integer :: element = 0
   end type input_key_t

   !> Whether two sets of inputs, or settings, are the same
   interface is_same
      module procedure same_number
      module procedure same_settings
   end interface is_same

contains

   !> Set a number
   pure subroutine put(self, quantity, value)
      class(inputs_t), intent(inout) :: self
      type(input_key_t), intent(in) :: quantity
      !> In the unit of the key; NaN: not given
      real(wp), intent(in) :: value

      integer :: i

      if (any(quantity%of_body)) then
         do i = 1, size(self%material)
            if (quantity%of_body(i)) call put_material(self, i, quantity, value)
         end do
         return
      else if (quantity%of_structure) then
         call self%target%put(quantity, value)
         return
      end if
      select case (quantity%key)
      case ('velocity')
         self%velocity = value
      case ('drop_height')
         self%drop_height = value
      case ('gravity')
         self%gravity = value
      case ('temperature')
         do i = 1, size(self%material)
            if (self%material(i)%shift%law /= '') self%material(i)%temperature = value
         end do
      case ('radius')
         self%radius = value
      case ('diameter')
         self%radius = 0.5_wp*value
      case ('mass')
         self%mass = value
      case ('half_thickness')
         self%half_thickness = positive_or_zero(value)
      case ('thickness')
         self%half_thickness = 0.5_wp*positive_or_zero(value)
      case ('surface_radius')
         self%surface_radius = value
      case ('extent')
         self%extent = value
      case ('time_step')
         self%settings%time_step = positive_or_zero(value)
      case ('end_time')
         self%settings%end_time = positive_or_zero(value)
      case ('accuracy')
         self%settings%accuracy = positive_or_zero(value)
      case ('volterra_coefficient')
         self%settings%second_coefficient = value
      case default
         where (shape_parameters%parameter%name == quantity%key) self%shape_numbers = value
      end select
   end subroutine put

   !> Set a number of the structure
   pure subroutine put_target(self, quantity, value)
      class(target_inputs_t), intent(inout) :: self
      type(input_key_t), intent(in) :: quantity
      !> In the unit of the key
      real(wp), intent(in) :: value

      select case (quantity%key)
      case ('length')
         self%length = value
      case ('width')
         self%width = value
      case ('diameter')
         self%diameter = value
      case ('thickness')
         self%thickness = value
      case ('position')
         self%position(quantity%element) = value
      case ('damping_ratio')
         self%damping_ratio = value
      case ('mass')
         self%mass = value
      case ('stiffness')
         self%stiffness = value
      case ('damping')
         self%damping = value
      case ('residual_compliance')
         self%residual_compliance = value
      case default
         continue
      end select
   end subroutine put_target

   !> Set a number of a material
   pure subroutine put_material(self, body, quantity, value)
      type(inputs_t), intent(inout) :: self
      !> of_sphere, of_plate or of_target
      integer, intent(in) :: body
      type(input_key_t), intent(in) :: quantity
      real(wp), intent(in) :: value

      if (quantity%key == 'yield_strength') then
         if (body <= size(self%yield_strength)) self%yield_strength(body) = value
      else if (quantity%element == 0) then
         if (.not. ieee_is_nan(value)) call self%material(body)%set(trim(quantity%key), value)
      else
         call put_list(self%material(body), trim(quantity%key), [value], quantity%element)
      end if
   end subroutine put_material

   !> Set a list of a material, or a number of it; relaxation times are rates there
   pure subroutine put_list(material, key, numbers, element)
      type(material_data_t), intent(inout) :: material
      character(len=*), intent(in) :: key
      !> In the unit of the key, shape (n), or (1) for a number of the list
      real(wp), intent(in) :: numbers(:)
      !> Index of the number; absent: the whole list
      integer, intent(in), optional :: element

      real(wp), allocatable :: list(:)
      character(len=len(key)) :: name
      logical :: are_times

      ! those of a table are its points
      are_times = key == 'times' .and. material%model == 'prony'
      name = key
      if (are_times) name = 'rates'
      list = numbers
      if (are_times) list = 1.0_wp/numbers
      if (present(element)) then
         list = [material%list(name), list]
         list(element) = list(size(list))
         list = list(:size(list) - 1)
      end if
      call material%set_list(name, list)
   end subroutine put_list

   !> Velocity of approach
   pure function approach_velocity(self) result(velocity)
      class(inputs_t), intent(in) :: self
      !> [m/s]
      real(wp) :: velocity

      real(wp) :: gravity

      velocity = self%velocity
      if (.not. ieee_is_nan(velocity)) return
      gravity = positive_or_zero(self%gravity)
      velocity = sqrt(2.0_wp*self%drop_height*merge(gravity, standard_gravity, gravity > 0.0_wp))
   end function approach_velocity

   !> Mass of the striking body
   pure function striking_mass(self, density) result(mass)
      class(inputs_t), intent(in) :: self
      !> Density of its material [kg/m3]
      real(wp), intent(in) :: density
      !> [kg]; 0 if neither mass nor density is given
      real(wp) :: mass

      mass = self%mass
      if (ieee_is_nan(mass)) mass = 4.0_wp/3.0_wp*pi*self%radius**3*density
   end function striking_mass

   !> Thickness of the structure: its own, or that of a plate without a base
   pure function target_thickness(self) result(thickness)
      class(inputs_t), intent(in) :: self
      !> [m]; 0 if there is none
      real(wp) :: thickness

      thickness = positive_or_zero(self%target%thickness)
      if (ieee_is_nan(self%target%thickness) .and. self%base == base_free) &
         thickness = 2.0_wp*self%half_thickness
   end function target_thickness

   !> Whether two sets of inputs have contact modulus, plate and face in common, materials aside
   pure function is_one_contact(self, other) result(same)
      class(inputs_t), intent(in) :: self
      class(inputs_t), intent(in) :: other
      logical :: same

      same = self%pair == other%pair .and. self%waves == other%waves .and. self%base == other%base &
         .and. is_same(self%half_thickness, other%half_thickness) &
         .and. self%settings%method == other%settings%method
   end function is_one_contact

   !> Whether two numbers are the same; NaN is the same as NaN
   elemental function same_number(a, b) result(same)
      real(wp), intent(in) :: a, b
      logical :: same

      same = ieee_is_nan(a) .and. ieee_is_nan(b)
      if (ieee_is_nan(a) .or. ieee_is_nan(b)) return
      same = .not. abs(a - b) > 0.0_wp
   end function same_number

   !> Whether two settings are the same
   pure function same_settings(a, b) result(same)
      type(solver_settings_t), intent(in) :: a, b
      logical :: same

      same = all(is_same([a%time_step, a%end_time, a%accuracy, a%second_coefficient], &
         [b%time_step, b%end_time, b%accuracy, b%second_coefficient])) &
         .and. a%method == b%method .and. a%scheme == b%scheme .and. a%form == b%form &
         .and. a%quadrature == b%quadrature .and. (a%ghost .eqv. b%ghost) &
         .and. (a%first_contact .eqv. b%first_contact) .and. a%bounces == b%bounces
   end function same_settings

   !> A positive number; 0 if there is none
   pure function positive_or_zero(number) result(positive)
      !> NaN if there is none
      real(wp), intent(in) :: number
      real(wp) :: positive

      positive = number
      if (ieee_is_nan(number)) positive = 0.0_wp
   end function positive_or_zero

end module vcor_case_inputs
