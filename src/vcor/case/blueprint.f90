!> The numbers of a case in a form that impacts are built from quickly: nothing is looked up by
!> name twice, what does not change is built once and is not copied either
module vcor_case_blueprint
   use vcor_constants, only : pi
   use vcor_error, only : error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus, pair_eq1, pair_series
   use vcor_impact_plate, only : new_plate, plate_t, waves_constant, waves_frozen, &
      waves_hereditary, waves_none, waves_relaxing
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material, set_constants_of
   use vcor_solver, only : solver_settings_t
   use vcor_case_describe, only : describe_material, describe_solver, number
   use vcor_case_entries, only : entries_t
   use vcor_case_catalogue, only : catalogue, groups
   implicit none
   private

   public :: blueprint_t, new_blueprint, place_t, place_of, solver_place

   !> Place of a number in a case
   type :: place_t
      !> Group
      character(len=len(groups%name)) :: group = ''
      !> Key
      character(len=len(catalogue%name)) :: key = ''
      !> Number of the item
      integer :: item = 1
   end type place_t

   !> One of the two bodies
   type :: body_t
      !> Number of its material
      integer :: item = 0
      !> Description of its material
      type(material_data_t) :: data
      !> Its material; not allocated as long as it was never built
      class(material_t), allocatable :: material
      !> Whether the modulus of the material is that of its description
      logical :: is_current = .false.
   end type body_t

   !> What an impact is built from
   type :: blueprint_t
      private
      !> Velocity of approach [m/s]
      real(wp) :: velocity = 0.0_wp
      !> Radius of the sphere [m]
      real(wp) :: radius = 0.0_wp
      !> Mass of the sphere [kg]; 0: from radius and density
      real(wp) :: mass = 0.0_wp
      !> Radius of the plate's surface [m]: 0 = flat, negative = concave
      real(wp) :: surface_radius = 0.0_wp
      !> Half thickness of the plate [m]; 0: not known
      real(wp) :: half_thickness = 0.0_wp
      !> One of the `waves_*` constants
      integer :: waves = waves_relaxing
      !> Contact law
      type(contact_law_t) :: law
      !> One of the `pair_*` constants
      integer :: pair = pair_eq1
      !> The sphere
      type(body_t) :: sphere
      !> The plate
      type(body_t) :: plate
      !> Whether the Volterra series has its second term
      logical :: second_term = .false.
      !> Whether modulus and plate of the impact that was built last are what they should be
      logical :: contact_is_current = .false.
      !> How the impact is to be solved
      type(solver_settings_t), public :: settings
   contains
      !> Set a number
      procedure :: set
      !> Build the impact
      procedure :: build
   end type blueprint_t

contains

   !> Take the numbers out of a case and build what does not vary
   subroutine new_blueprint(self, case, varying, error, cause)
      !> The blueprint
      type(blueprint_t), intent(out) :: self
      !> A validated case
      class(entries_t), intent(in) :: case
      !> Numbers that will be set, shape (n)
      type(place_t), intent(in) :: varying(:)
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> What in the case the error is about
      type(place_t), intent(out) :: cause

      character(len=:), allocatable :: waves, law, pair
      integer :: order

      self%velocity = number(case, 'impact', 'velocity')
      self%radius = number(case, 'sphere', 'radius')
      self%mass = number(case, 'sphere', 'mass')
      self%surface_radius = number(case, 'plate', 'surface_radius')
      self%half_thickness = number(case, 'plate', 'half_thickness')
      call case%get('plate', 'waves', waves)
      select case (waves)
      case ('none')
         self%waves = waves_none
      case ('constant')
         self%waves = waves_constant
      case ('frozen')
         self%waves = waves_frozen
      case ('hereditary')
         self%waves = waves_hereditary
      case default
         self%waves = waves_relaxing
      end select

      call case%get('contact', 'law', law)
      self%law%receding = law == 'receding'
      call case%get('contact', 'pair', pair)
      if (pair == 'series') self%pair = pair_series

      call describe_solver(case, self%settings)
      call case%get('solver', 'volterra_order', order)
      self%second_term = order == 2

      call describe_body(case, 'sphere', self%sphere)
      call describe_body(case, 'plate', self%plate)
      if (.not. varies(self%sphere%item)) call build_material_of(self%sphere, error, cause)
      if (allocated(error)) return
      if (self%plate%item /= self%sphere%item .and. .not. varies(self%plate%item)) &
         call build_material_of(self%plate, error, cause)

   contains

      !> Whether the modulus of a material varies
      pure function varies(item)
         !> Number of the material
         integer, intent(in) :: item
         !> Whether it does
         logical :: varies

         varies = any(varying%group == 'material' .and. varying%item == item &
            .and. takes_part(varying%key))
      end function varies
   end subroutine new_blueprint

   !> Whether a number of a material takes part in its modulus: points of data need not be fitted
   !> anew for another density
   elemental function takes_part(key)
      !> Key of the number
      character(len=*), intent(in) :: key
      !> Whether it does
      logical :: takes_part

      takes_part = key /= 'density' .and. key /= 'poisson_ratio'
   end function takes_part

   !> Describe the material of a body
   subroutine describe_body(case, group, body)
      !> The case
      class(entries_t), intent(in) :: case
      !> sphere or plate
      character(len=*), intent(in) :: group
      !> The body, its material not built
      type(body_t), intent(out) :: body

      character(len=:), allocatable :: name

      call case%get(group, 'material', name)
      body%item = case%find_material(name)
      call describe_material(case, body%item, body%data)
   end subroutine describe_body

   !> Place of an entry
   pure function place_of(case, handle) result(place)
      !> The case
      class(entries_t), intent(in) :: case
      !> Handle of the entry
      integer, intent(in) :: handle
      !> Its place
      type(place_t) :: place

      integer :: group, row

      call case%locate(handle, group, row, place%item)
      place%group = groups(group)%name
      place%key = catalogue(row)%name
   end function place_of

   !> What in a case an error about the solver is about
   pure function solver_place(settings) result(place)
      !> How the impact is to be solved
      type(solver_settings_t), intent(in) :: settings
      !> Place of the method or its scheme
      type(place_t) :: place

      place = place_t('solver', 'scheme')
      if (settings%scheme == 'product') place%key = 'method'
   end function solver_place

   !> Set a number; nothing is checked before the impact is built
   subroutine set(self, place, value, is_taken)
      !> The blueprint
      class(blueprint_t), intent(inout) :: self
      !> Place of a real number, one of those announced as varying
      type(place_t), intent(in) :: place
      !> Its value, in the unit of the key
      real(wp), intent(in) :: value
      !> Whether an impact is built from it
      logical, intent(out) :: is_taken

      is_taken = .true.
      select case (place%group)
      case ('impact')
         if (place%key == 'velocity') then
            self%velocity = value
         else
            is_taken = .false.
         end if
      case ('sphere')
         select case (place%key)
         case ('radius')
            self%radius = value
         case ('mass')
            self%mass = value
         case default
            is_taken = .false.
         end select
      case ('plate')
         select case (place%key)
         case ('surface_radius')
            self%surface_radius = value
         case ('half_thickness')
            self%half_thickness = value
            self%contact_is_current = .false.
         case default
            is_taken = .false.
         end select
      case ('material')
         self%contact_is_current = .false.
         is_taken = .false.
         call set_in(self%sphere)
         call set_in(self%plate)
      case ('solver')
         call set_in_solver()
      case default
         is_taken = .false.
      end select

   contains

      !> Set it where a body is of the material
      subroutine set_in(body)
         !> The body
         type(body_t), intent(inout) :: body

         if (place%item /= body%item) return
         call body%data%set(place%key, value, is_taken)
         if (takes_part(place%key)) body%is_current = .false.
      end subroutine set_in

      !> Set it in the settings of the solver
      subroutine set_in_solver()
         select case (place%key)
         case ('time_step')
            self%settings%time_step = value
         case ('end_time')
            self%settings%end_time = value
         case ('accuracy')
            self%settings%accuracy = value
         case ('volterra_coefficient')
            is_taken = self%second_term
            if (is_taken) self%settings%second_coefficient = value
         case default
            is_taken = .false.
         end select
      end subroutine set_in_solver
   end subroutine set

   !> Build the impact
   subroutine build(self, impact, error, cause)
      !> The blueprint; its materials are built anew where that has to be
      class(blueprint_t), intent(inout) :: self
      !> The impact; what this blueprint built last or, the first time, nothing
      type(impact_t), intent(inout) :: impact
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> What in the case the error is about
      type(place_t), intent(out) :: cause

      type(impact_t) :: motion
      type(contact_modulus_t) :: no_modulus
      type(plate_t) :: no_plate
      real(wp) :: mass

      if (.not. self%contact_is_current) call build_contact(self, impact, error, cause)
      if (allocated(error)) return
      mass = self%mass
      if (.not. mass > 0.0_wp) &
         mass = 4.0_wp/3.0_wp*pi*self%radius**3*self%sphere%material%density()
      ! modulus and plate are in their place already: copies of them would take longer than all else
      call new_impact(motion, self%velocity, mass, self%radius, self%surface_radius, no_modulus, &
         no_plate, error, self%law)
      if (allocated(error)) then
         cause = place_t('sphere', 'radius')
         return
      end if
      impact%velocity = motion%velocity
      impact%mass = motion%mass
      impact%hertz_factor = motion%hertz_factor
      impact%law = motion%law
   end subroutine build

   !> Build what the sphere meets: modulus and plate of an impact
   subroutine build_contact(self, impact, error, cause)
      !> The blueprint; its materials are built anew where that has to be
      type(blueprint_t), intent(inout) :: self
      !> The impact, its modulus and plate built
      type(impact_t), intent(inout) :: impact
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> What in the case the error is about
      type(place_t), intent(inout) :: cause

      call build_materials(self, error, cause)
      if (allocated(error)) return
      call new_contact_modulus(impact%modulus, self%sphere%material, self%plate%material, &
         self%sphere%data%deforms_as(self%plate%data), error, self%pair)
      if (allocated(error)) then
         cause = place_t('plate', 'material')
         return
      end if
      call new_plate(impact%plate, self%plate%material, self%half_thickness, self%waves, error)
      if (allocated(error)) then
         cause = place_t('plate', 'waves')
         return
      end if
      self%contact_is_current = .true.
   end subroutine build_contact

   !> Build the materials that have changed or were never built, and set what does not take part in
   !> the modulus
   subroutine build_materials(self, error, cause)
      !> The blueprint
      class(blueprint_t), intent(inout) :: self
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> What in the case the error is about
      type(place_t), intent(inout) :: cause

      call build_material_of(self%sphere, error, cause)
      if (allocated(error)) return
      if (self%plate%item /= self%sphere%item) then
         call build_material_of(self%plate, error, cause)
      else if (.not. self%plate%is_current) then
         if (allocated(self%plate%material)) deallocate (self%plate%material)
         allocate (self%plate%material, source=self%sphere%material)
         self%plate%is_current = .true.
      else
         call set_constants_of(self%plate%material, self%plate%data, error)
      end if
   end subroutine build_materials

   !> Build the material of a body where that has to be
   subroutine build_material_of(body, error, cause)
      !> The body
      type(body_t), intent(inout) :: body
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> What in the case the error is about
      type(place_t), intent(inout) :: cause

      if (body%is_current) then
         call set_constants_of(body%material, body%data, error)
         if (allocated(error)) cause = place_t('material', 'name', body%item)
         return
      end if
      call new_material(body%material, body%data, error)
      if (allocated(error)) then
         cause = place_t('material', 'name', body%item)
         return
      end if
      body%is_current = .true.
   end subroutine build_material_of

end module vcor_case_blueprint
