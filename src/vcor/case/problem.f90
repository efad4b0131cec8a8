!> From a case to the impact that it describes and the solver that it asks for
!>
!> `update` follows the numbers of the case: whatever depends on a number that has changed is made
!> anew, and nothing else. Threads of a sweep call it, so it calls no function that returns a text
!> of deferred length, whose length gfortran 12 keeps in static storage.
module vcor_case_problem
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan, ieee_quiet_nan, ieee_value
   use vcor_case_case, only : address_t, case_t
   use vcor_case_catalogue, only : catalogue, find_group, find_key, first_row, last_row
   use vcor_constants, only : pi, standard_gravity
   use vcor_error, only : error_t
   use vcor_impact_contact, only : new_contact_modulus, pair_eq1, pair_series
   use vcor_impact_plate, only : new_plate, waves_constant, waves_frozen, waves_hereditary, &
      waves_none, waves_relaxing
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_impact_validity, only : assess, surroundings_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material, parameters_of, &
      set_constants_of
   use vcor_material_parameter, only : density, parameter_t
   use vcor_solver, only : check_settings, new_solver, solve_impact, solver_settings_t, &
      solver_t
   implicit none
   private

   public :: problem_t, problem_of_case, material_of_case

   !> A material of the case
   type :: body_t
      !> Group and item in the case
      type(address_t) :: address
      !> Number of changes of the item when it was read last, -1: never
      integer :: revision = -1
      !> Rows of its numbers in the catalogue, shape (n)
      integer, allocatable :: rows(:)
      !> The numbers as they were read last, nan where there is none, shape (n)
      real(wp), allocatable :: numbers(:)
      !> Its description
      type(material_data_t) :: data
      !> The material; allocated once it was built
      class(material_t), allocatable :: material
      !> Whether the modulus of the material is that of its description
      logical :: is_current = .false.
   end type body_t

   !> Addresses of the numbers that an impact is made from
   type :: numbers_t
      type(address_t) :: velocity, drop_height, radius, mass, surface_radius, half_thickness
      type(address_t) :: extent, yield_strength(2)
      type(address_t) :: time_step, end_time, accuracy, second_coefficient
   end type numbers_t

   !> Impact and solver of a case
   type :: problem_t
      !> The impact
      type(impact_t) :: impact
      !> The solver
      class(solver_t), allocatable :: solver
      !> How the impact is to be solved
      type(solver_settings_t) :: settings
      !> What its measures of validity know beside it
      type(surroundings_t) :: around
      !> Material of the sphere
      type(body_t), private :: sphere
      !> Material of the plate
      type(body_t), private :: plate
      !> Where the numbers stand
      type(numbers_t), private :: at
      !> Half thickness of the plate that was built [m]; 0: not known
      real(wp), private :: half_thickness = 0.0_wp
      !> One of the `waves_*` constants
      integer, private :: waves = waves_relaxing
      !> One of the `pair_*` constants
      integer, private :: pair = pair_eq1
      !> Whether the Volterra series has its second term
      logical, private :: second_term = .false.
      !> Whether modulus and plate of the impact are those of the materials
      logical, private :: contact_is_current = .false.
      !> Number of changes of &solver when the solver was built, -1: never
      integer, private :: solver_revision = -1
      !> What in the case the last error is about
      type(address_t) :: cause
   contains
      !> Follow the numbers of the case
      procedure :: update
      !> Solve and judge the impact
      procedure :: solve
   end type problem_t

contains

   !> The impact and the solver of a case; what a sweep varies is as the case has it
   subroutine problem_of_case(self, case, error)
      !> The problem
      type(problem_t), intent(out) :: self
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Error of code `error_input` that says where its cause stands, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: text
      integer :: order

      self%at%velocity = case%address('impact', 'velocity')
      self%at%drop_height = case%address('impact', 'drop_height')
      self%at%radius = case%address('sphere', 'radius')
      self%at%mass = case%address('sphere', 'mass')
      self%at%surface_radius = case%address('plate', 'surface_radius')
      self%at%half_thickness = case%address('plate', 'half_thickness')
      self%at%extent = case%address('plate', 'extent')
      self%at%time_step = case%address('solver', 'time_step')
      self%at%end_time = case%address('solver', 'end_time')
      self%at%accuracy = case%address('solver', 'accuracy')
      self%at%second_coefficient = case%address('solver', 'volterra_coefficient')

      call case%get('plate', 'waves', text)
      select case (text)
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
      call case%get('contact', 'law', text)
      self%impact%law%receding = text == 'receding'
      call case%get('contact', 'pair', text)
      self%pair = merge(pair_series, pair_eq1, text == 'series')

      call case%get('solver', 'method', text)
      self%settings%method = text
      call case%get('solver', 'scheme', text)
      self%settings%scheme = text
      call case%get('solver', 'form', text)
      self%settings%form = text
      call case%get('solver', 'quadrature', text)
      self%settings%quadrature = text
      call case%get('solver', 'volterra_order', order)
      self%second_term = order == 2
      call case%get('solver', 'continue_after_separation', self%settings%ghost)

      call case%get('sphere', 'material', text)
      call describe(self%sphere, case, case%find_material(text))
      call case%get('plate', 'material', text)
      call describe(self%plate, case, case%find_material(text))
      self%at%yield_strength = [ &
         case%address('material', 'yield_strength', self%sphere%address%item), &
         case%address('material', 'yield_strength', self%plate%address%item)]
      call self%update(case, error)
      if (allocated(error)) error%message = case%location(self%cause)//': '//error%message
   end subroutine problem_of_case

   !> A material of a case
   subroutine material_of_case(case, item, material, error)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Number of the material
      integer, intent(in) :: item
      !> The material
      class(material_t), allocatable, intent(out) :: material
      !> Error of code `error_input` that says where its cause stands, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(body_t) :: body
      type(address_t) :: cause
      logical :: has_changed

      call describe(body, case, item)
      call update_body(body, case, has_changed, cause, error)
      if (allocated(error)) then
         error%message = case%location(cause)//': '//error%message
      else
         call move_alloc(body%material, material)
      end if
   end subroutine material_of_case

   !> Describe a material but for its numbers
   subroutine describe(body, case, item)
      !> The material, not built
      type(body_t), intent(out) :: body
      !> The case
      type(case_t), intent(in) :: case
      !> Number of the material
      integer, intent(in) :: item

      type(parameter_t), allocatable :: parameters(:)
      integer :: group, row

      group = find_group('material')
      body%address = case%address('material', 'name', item)
      call case%get('material', 'name', body%data%name, item)
      call case%get('material', 'model', body%data%model, item)
      allocate (parameters, source=[density, parameters_of(body%data%model)])
      body%rows = pack([(row, row=first_row(group), last_row(group))], &
         [(is_number(row), row=first_row(group), last_row(group))])
      allocate (body%numbers(size(body%rows)), source=ieee_value(1.0_wp, ieee_quiet_nan))

   contains

      !> Whether a row is that of a number of the model
      pure function is_number(row)
         !> The row
         integer, intent(in) :: row
         !> Whether it is
         logical :: is_number

         is_number = any(catalogue(row)%name == parameters%name .and. .not. parameters%is_list)
         if (is_number) is_number = find_key('material', catalogue(row)%name) == row
      end function is_number
   end subroutine describe

   !> Follow the numbers of the case
   subroutine update(self, case, error)
      !> The problem, made of this case
      class(problem_t), intent(inout) :: self
      !> The case
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success; `cause` is what it is about
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: half_thickness
      logical :: has_changed(2)

      call update_body(self%sphere, case, has_changed(1), self%cause, error)
      if (allocated(error)) return
      has_changed(2) = .false.
      if (self%plate%address%item /= self%sphere%address%item) &
         call update_body(self%plate, case, has_changed(2), self%cause, error)
      if (allocated(error)) return
      half_thickness = number_or_zero(case, self%at%half_thickness)
      if (any(has_changed) .or. abs(half_thickness - self%half_thickness) > 0.0_wp) &
         self%contact_is_current = .false.
      self%half_thickness = half_thickness
      if (.not. self%contact_is_current) then
         if (self%plate%address%item == self%sphere%address%item) then
            call build_contact(self%impact, self%sphere, self%sphere, self%pair, half_thickness, &
               self%waves, case, self%cause, error)
         else
            call build_contact(self%impact, self%sphere, self%plate, self%pair, half_thickness, &
               self%waves, case, self%cause, error)
         end if
         if (allocated(error)) return
         self%contact_is_current = .true.
      end if
      call launch(self, case, error)
      if (allocated(error)) return
      call look_around(self, case)
      call update_solver(self, case, error)
   end subroutine update

   !> Solve the impact, and judge whether the model holds
   subroutine solve(self, trajectory, outcome, error)
      !> The problem
      class(problem_t), intent(in) :: self
      !> Course of its impact
      type(trajectory_t), intent(inout) :: trajectory
      !> Its outcome with the measures of validity
      type(outcome_t), intent(out) :: outcome
      !> Error of code `error_numerical` as that of `solve_impact`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      call solve_impact(self%solver, self%impact, trajectory, outcome, error)
      if (allocated(error) .or. outcome%status /= contact_separated) return
      if (self%plate%address%item == self%sphere%address%item) then
         call assess(outcome, self%impact, trajectory, self%around, self%sphere%material, &
            self%sphere%material)
      else
         call assess(outcome, self%impact, trajectory, self%around, self%sphere%material, &
            self%plate%material)
      end if
   end subroutine solve

   !> Follow what the measures of validity know beside the impact
   subroutine look_around(self, case)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      !> The case
      type(case_t), intent(in) :: case

      real(wp) :: yield_strength(2)

      self%around%radius = case%number(self%at%radius)
      self%around%is_sphere = case%number(self%at%surface_radius) > 0.0_wp
      self%around%thickness = 2.0_wp*case%number(self%at%half_thickness)
      self%around%extent = case%number(self%at%extent)
      self%around%drops = .not. ieee_is_nan(case%number(self%at%drop_height))
      yield_strength = [case%number(self%at%yield_strength(1)), &
         case%number(self%at%yield_strength(2))]
      if (ieee_is_nan(yield_strength(1))) yield_strength(1) = yield_strength(2)
      if (.not. any(ieee_is_nan(yield_strength))) yield_strength(1) = minval(yield_strength)
      self%around%yield_strength = yield_strength(1)
      associate (plate => self%plate)
         if (plate%address%item == self%sphere%address%item) then
            call self%around%follow(self%sphere%material%poisson_ratio())
         else
            call self%around%follow(plate%material%poisson_ratio())
         end if
      end associate
   end subroutine look_around

   !> Set the impact's motion
   subroutine launch(self, case, error)
      !> The problem, its contact built
      type(problem_t), intent(inout) :: self
      !> The case
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: velocity, mass, radius

      velocity = case%number(self%at%velocity)
      if (ieee_is_nan(velocity)) &
         velocity = sqrt(2.0_wp*standard_gravity*case%number(self%at%drop_height))
      radius = case%number(self%at%radius)
      mass = case%number(self%at%mass)
      if (ieee_is_nan(mass)) mass = 4.0_wp/3.0_wp*pi*radius**3*self%sphere%material%density()
      call self%impact%launch(velocity, mass, radius, &
         case%number(self%at%surface_radius), error)
      if (allocated(error)) self%cause = self%at%radius
   end subroutine launch

   !> Follow the numbers of the solver
   subroutine update_solver(self, case, error)
      !> The problem, its impact built
      type(problem_t), intent(inout) :: self
      !> The case
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: revision

      revision = case%revision(self%at%accuracy%group, 1)
      if (self%solver_revision /= revision) then
         self%settings%time_step = number_or_zero(case, self%at%time_step)
         self%settings%end_time = number_or_zero(case, self%at%end_time)
         self%settings%accuracy = number_or_zero(case, self%at%accuracy)
         self%settings%second_coefficient = 0.0_wp
         if (self%second_term) &
            self%settings%second_coefficient = case%number(self%at%second_coefficient)
      end if
      call check_settings(self%settings, self%impact, error)
      if (.not. allocated(error) .and. self%solver_revision /= revision) then
         call new_solver(self%solver, self%settings, error)
         if (.not. allocated(error)) self%solver_revision = revision
      end if
      if (.not. allocated(error)) return
      self%cause = case%address('solver', 'scheme')
      if (self%settings%scheme == 'product') self%cause = case%address('solver', 'method')
   end subroutine update_solver

   !> Number at an address, 0 if there is none
   pure function number_or_zero(case, address) result(number)
      !> The case
      type(case_t), intent(in) :: case
      !> The address
      type(address_t), intent(in) :: address
      !> The number
      real(wp) :: number

      number = case%number(address)
      if (ieee_is_nan(number)) number = 0.0_wp
   end function number_or_zero

   !> Build what the sphere meets: modulus and plate of an impact
   subroutine build_contact(impact, sphere, plate, pair, half_thickness, waves, case, cause, error)
      !> The impact, its modulus and plate built
      type(impact_t), intent(inout) :: impact
      !> Material of the sphere
      type(body_t), intent(in) :: sphere
      !> Material of the plate
      type(body_t), intent(in) :: plate
      !> One of the `pair_*` constants
      integer, intent(in) :: pair
      !> Half thickness of the plate [m]; 0: not known
      real(wp), intent(in) :: half_thickness
      !> One of the `waves_*` constants
      integer, intent(in) :: waves
      !> The case
      type(case_t), intent(in) :: case
      !> What in the case the error is about
      type(address_t), intent(inout) :: cause
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      call new_contact_modulus(impact%modulus, sphere%material, plate%material, &
         sphere%data%deforms_as(plate%data), error, pair)
      if (allocated(error)) then
         cause = case%address('plate', 'material')
         return
      end if
      call new_plate(impact%plate, plate%material, half_thickness, waves, error)
      if (allocated(error)) cause = case%address('plate', 'waves')
   end subroutine build_contact

   !> Follow the numbers of a material: it is built anew if its modulus has changed
   subroutine update_body(body, case, has_changed, cause, error)
      !> The material, described
      type(body_t), intent(inout) :: body
      !> The case
      type(case_t), intent(in) :: case
      !> Whether the material is another one than before
      logical, intent(out) :: has_changed
      !> What in the case the error is about
      type(address_t), intent(inout) :: cause
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: number
      integer :: i, revision

      revision = case%revision(body%address%group, body%address%item)
      has_changed = body%revision /= revision .or. .not. body%is_current
      if (.not. has_changed) return
      do i = 1, size(body%rows)
         number = case%number(address_t(body%address%group, body%address%item, body%rows(i)))
         if (ieee_is_nan(number)) cycle
         if (.not. ieee_is_nan(body%numbers(i))) then
            if (.not. abs(number - body%numbers(i)) > 0.0_wp) cycle
         end if
         body%numbers(i) = number
         associate (name => catalogue(body%rows(i))%name)
            call body%data%set(name, number)
            ! points of data need not be fitted anew for another density
            if (name /= 'density' .and. name /= 'poisson_ratio') body%is_current = .false.
         end associate
      end do
      call update_lists(body, case)
      body%revision = revision
      cause = body%address
      if (body%is_current) then
         call set_constants_of(body%material, body%data, error)
      else
         call new_material(body%material, body%data, error)
      end if
      body%is_current = .not. allocated(error)
   end subroutine update_body

   !> Follow the lists of a material, that is the terms of a Prony series and the points of a table
   subroutine update_lists(body, case)
      !> The material; not current if a list has changed
      type(body_t), intent(inout) :: body
      !> The case
      type(case_t), intent(in) :: case

      real(wp), allocatable :: moduli(:), rates(:)
      character(len=5) :: key

      ! the points of a table are read once
      if (body%data%model == 'table') then
         if (body%is_current) return
      else if (body%data%model /= 'prony') then
         return
      end if
      key = 'rates'
      if (body%data%model == 'table' .or. case%given('material', 'times', body%address%item)) &
         key = 'times'
      call case%get('material', 'moduli', moduli, body%address%item)
      call case%get('material', key, rates, body%address%item)
      if (body%data%model == 'prony' .and. key == 'times') then
         key = 'rates'
         rates = 1.0_wp/rates
      end if
      if (.not. (is_same(moduli, body%data%list('moduli')) &
          .and. is_same(rates, body%data%list(key)))) body%is_current = .false.
      call body%data%set_list('moduli', moduli)
      call body%data%set_list(key, rates)
   end subroutine update_lists

   !> Whether two lists are the same
   pure function is_same(one, other) result(same)
      !> One, shape (n)
      real(wp), intent(in) :: one(:)
      !> The other, shape (m)
      real(wp), intent(in) :: other(:)
      !> Whether they are
      logical :: same

      same = size(one) == size(other)
      if (same) same = .not. any(abs(one - other) > 0.0_wp)
   end function is_same

end module vcor_case_problem
