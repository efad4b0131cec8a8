!> What can be told to be wrong from the values of a case against each other, each within its own
!> range
module vcor_case_consistency
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_solver, only : hereditary_without_papers_scheme, receding_without_ghost, &
      & receding_without_papers_scheme, receding_without_second_term
   use vcor_case_address, only : material_names
   use vcor_case_case, only : address_t, case_t, operator(==)
   use vcor_case_catalogue, only : catalogue, find_key, key_t, wanted
   use vcor_words, only : suggestion
   use vcor_text, only : canonical_name, integer_text, real_text, same_name, &
      & shortened
   implicit none
   private

   public :: check_consistency

contains

   !> Check the values of a case against each other; the first contradiction becomes the error.
   !> Numbers that a sweep varies are there, and in contradiction to nothing
   subroutine check_consistency(self, swept, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      integer :: item

      do item = 1, self%count("material")
         call check_material(self, swept, item, error)
         if (allocated(error)) return
      end do
      call check_bodies(self, swept, error)
      if (allocated(error)) return
      call check_times(self, swept, error)
      if (allocated(error)) return
      call check_choices(self, error)
      if (allocated(error)) return
      call check_mechanics(self, error)
   end subroutine check_consistency

   !> Check the scheme against the method, and the name of the files
   subroutine check_choices(self, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: method, scheme, stem

      call self%get("solver", "method", method)
      call self%get("solver", "scheme", scheme)
      call self%get("output", "stem", stem)
      if (method == "ive" .and. scheme /= "product") then
         call raise(error, error_input, self%location("solver", "scheme")//": scheme = '" &
            & //scheme//"' is one of method = 'direct', found method = 'ive'")
      else if (index(stem, "/") > 0 .or. stem == "." .or. stem == "..") then
         call raise(error, error_input, self%location("output", "stem")//": found stem = '" &
            & //shortened(stem)//"', expected a name without a folder (that is output.directory)")
      end if
   end subroutine check_choices

   !> Check contact law and plate model against the solver
   subroutine check_mechanics(self, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: law, waves, scheme, message
      integer :: order
      logical :: ghost

      call self%get("contact", "law", law)
      call self%get("plate", "waves", waves)
      call self%get("solver", "scheme", scheme)
      call self%get("solver", "volterra_order", order)
      call self%get("solver", "continue_after_separation", ghost)
      if (law == "receding") then
         message = ""
         if (order == 2) then
            message = receding_without_second_term
         else if (scheme /= "product") then
            message = receding_without_papers_scheme
         else if (ghost) then
            message = receding_without_ghost
         end if
         if (len(message) > 0) call raise(error, error_input, self%location("contact", "law") &
            & //": "//message)
      else if (waves == "hereditary" .and. scheme /= "product") then
         call raise(error, error_input, self%location("plate", "waves")//": " &
            & //hereditary_without_papers_scheme)
      end if
   end subroutine check_mechanics

   !> Whether a sweep varies a key
   pure function is_swept(self, swept, group, key, item) result(yes)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      !> Whether it does
      logical :: yes

      yes = any(swept == self%address(group, key, item))
   end function is_swept

   !> Raise an error about a key of a material
   subroutine fail(self, key, item, message, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Name of the key
      character(len=*), intent(in) :: key
      !> Number of the material
      integer, intent(in) :: item
      !> Found and expected
      character(len=*), intent(in) :: message
      !> The error
      type(error_t), allocatable, intent(inout) :: error

      call raise(error, error_input, self%location("material", key, item)//": "//message)
   end subroutine fail

   !> Name of a material, in quotes
   pure function material_name(self, item) result(name)
      !> The case
      type(case_t), intent(in) :: self
      !> Number of the material
      integer, intent(in) :: item
      !> The name
      character(len=:), allocatable :: name
      character(len=:), allocatable :: label

      call self%get("material", "name", label, item)
      name = "'"//shortened(label)//"'"
   end function material_name

   !> Check the values of a material against each other
   subroutine check_material(self, swept, item, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Number of the material
      integer, intent(in) :: item
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: name, other, model
      integer :: i

      call self%get("material", "name", name, item)
      do i = 1, item - 1
         call self%get("material", "name", other, i)
         if (.not. same_name(name, other)) cycle
         call fail(self, "name", item, "there are two materials of the name '"//shortened(name) &
            & //"', the first at "//self%location("material", "name", i) &
            & //"; expected different names", error)
         return
      end do
      call self%get("material", "model", model, item)
      if (model == "sls") call check_sls(self, swept, item, error)
      if (model == "prony") call check_prony(self, swept, item, error)
      if (.not. allocated(error)) call check_band(self, item, error)
   end subroutine check_material

   !> The band of the data that a model was fitted to begins before it ends
   subroutine check_band(self, item, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Number of the material
      integer, intent(in) :: item
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      real(wp) :: first, last

      if (.not. (self%given("material", "valid_from", item) &
         & .and. self%given("material", "valid_to", item))) return
      call self%get("material", "valid_from", first, item)
      call self%get("material", "valid_to", last, item)
      if (.not. first < last) call fail(self, "valid_to", item, "found valid_from = " &
         & //real_text(first)//" and valid_to = "//real_text(last) &
         & //", expected valid_from < valid_to", error)
   end subroutine check_band

   !> A standard linear solid is softer after a long time than at first: alpha <= beta
   subroutine check_sls(self, swept, item, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Number of the material
      integer, intent(in) :: item
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: message
      real(wp) :: alpha, beta

      if (is_swept(self, swept, "material", "alpha", item) .or. &
         & is_swept(self, swept, "material", "beta", item)) return
      call self%get("material", "alpha", alpha, item)
      call self%get("material", "beta", beta, item)
      if (alpha <= beta) return
      message = "alpha = "//real_text(alpha)//" is larger than beta = "//real_text(beta)
      if (beta > 0.0_wp) then
         message = message &
            & //", so the rubbery modulus glassy_modulus*alpha/beta exceeds the glassy one"
      else
         message = message//", which leaves no rubbery modulus glassy_modulus*alpha/beta"
      end if
      call fail(self, "alpha", item, message//"; expected alpha <= beta", error)
   end subroutine check_sls

   !> A Prony series has as many rates, or times, as moduli, and at least one term of any sort
   subroutine check_prony(self, swept, item, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Number of the material
      integer, intent(in) :: item
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      real(wp), allocatable :: moduli(:), rates(:)
      character(len=:), allocatable :: key
      real(wp) :: viscosity, equilibrium_modulus
      logical :: has_terms, is_stiff

      if (self%given("material", "rates", item) .and. self%given("material", "times", item)) then
         call fail(self, "times", item, "found both rates and times, expected one of them", error)
         return
      end if
      key = "rates"
      if (self%given("material", "times", item)) key = "times"
      call self%get("material", "moduli", moduli, item)
      call self%get("material", key, rates, item)
      has_terms = self%given("material", "moduli", item)
      call self%get("material", "viscosity", viscosity, item)
      call self%get("material", "equilibrium_modulus", equilibrium_modulus, item)
      is_stiff = has_terms .or. viscosity > 0.0_wp .or. equilibrium_modulus > 0.0_wp &
         & .or. is_swept(self, swept, "material", "viscosity", item) &
         & .or. is_swept(self, swept, "material", "equilibrium_modulus", item)

      if (has_terms .and. .not. self%given("material", key, item)) then
         call fail(self, "moduli", item, &
            & "found moduli without rates or times, expected one rate or " &
            & //"time for each modulus", error)
      else if (self%given("material", key, item) .and. .not. has_terms) then
         call fail(self, key, item, "found "//key//" without moduli, expected as many moduli", &
            & error)
      else if (size(moduli) /= size(rates)) then
         call fail(self, key, item, "found "//integer_text(size(moduli))//" moduli and " &
            & //integer_text(size(rates))//" "//key//", expected as many of one as of the other", &
            & error)
      else if (.not. is_stiff) then
         call fail(self, "moduli", item, "material "//material_name(self, item) &
            & //" has no stiffness, expected moduli, viscosity > 0 or equilibrium_modulus > 0", &
            & error)
      end if
   end subroutine check_prony

   !> Check sphere and plate against their materials and each other
   subroutine check_bodies(self, swept, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(key_t) :: thickness
      character(len=:), allocatable :: waves
      real(wp) :: radius, surface_radius
      integer :: sphere, plate
      logical :: rigid_sphere, rigid_plate

      call find_body_material(self, "sphere", sphere, rigid_sphere, error)
      if (allocated(error)) return
      call find_body_material(self, "plate", plate, rigid_plate, error)
      if (allocated(error)) return
      if (rigid_sphere .and. rigid_plate) then
         call raise(error, error_input, self%location("plate", "material") &
            & //": sphere and plate are both rigid, expected one that deforms")
         return
      end if
      if (.not. (self%given("sphere", "mass") .or. is_swept(self, swept, "sphere", "mass"))) then
         call need_density(self, swept, sphere, "sphere", "mass in &sphere or density", error)
         if (allocated(error)) return
      end if
      ! A rigid plate does not move, and without waves none does
      call self%get("plate", "waves", waves)
      if (waves /= "none" .and. .not. rigid_plate) then
         if (.not. (self%given("plate", "half_thickness") &
            & .or. is_swept(self, swept, "plate", "half_thickness"))) then
            thickness = catalogue(find_key("plate", "half_thickness"))
            call raise(error, error_input, self%location("plate", "half_thickness") &
               & //": key 'half_thickness' is missing in &plate, expected "//wanted(thickness) &
               & //", or waves = 'none' for a half space")
            return
         end if
         call need_density(self, swept, plate, "plate", &
            & "density, or waves = 'none' for a half space", error)
         if (allocated(error)) return
      end if
      if (is_swept(self, swept, "sphere", "radius") &
         & .or. is_swept(self, swept, "plate", "surface_radius")) return
      call self%get("sphere", "radius", radius)
      call self%get("plate", "surface_radius", surface_radius)
      if (surface_radius < 0.0_wp .and. abs(surface_radius) <= radius) then
         call raise(error, error_input, self%location("plate", "surface_radius") &
            & //": found surface_radius = "//real_text(surface_radius) &
            & //", expected a hollow wider than the sphere, surface_radius < " &
            & //real_text(-radius)//" [m]")
      end if
   end subroutine check_bodies

   !> The material of a body
   subroutine find_body_material(self, body, item, rigid, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Group of the body
      character(len=*), intent(in) :: body
      !> Number of its material
      integer, intent(out) :: item
      !> Whether that is rigid
      logical, intent(out) :: rigid
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: name, model

      rigid = .false.
      call self%get(body, "material", name)
      item = self%find_material(name)
      if (item == 0) then
         call raise(error, error_input, self%location(body, "material") &
            & //": there is no material '"//shortened(name)//"' for &"//body//"; " &
            & //suggestion(canonical_name(name), material_names(self)))
         return
      end if
      call self%get("material", "model", model, item)
      rigid = model == "rigid"
   end subroutine find_body_material

   !> Check that a material has a density
   subroutine need_density(self, swept, item, body, expected, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Number of the material
      integer, intent(in) :: item
      !> Group of the body that needs it
      character(len=*), intent(in) :: body
      !> What is expected
      character(len=*), intent(in) :: expected
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (self%given("material", "density", item) &
         & .or. is_swept(self, swept, "material", "density", item)) return
      call fail(self, "density", item, "key 'density' is missing in &material " &
         & //material_name(self, item)//" of the "//body//", expected "//expected, error)
   end subroutine need_density

   !> Check the times of the solver against each other
   subroutine check_times(self, swept, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      real(wp) :: time_step, end_time

      if (.not. (self%given("solver", "time_step") .and. self%given("solver", "end_time"))) return
      if (is_swept(self, swept, "solver", "time_step") &
         & .or. is_swept(self, swept, "solver", "end_time")) return
      call self%get("solver", "time_step", time_step)
      call self%get("solver", "end_time", end_time)
      if (time_step < end_time) return
      call raise(error, error_input, self%location("solver", "time_step")//": found time_step = " &
         & //real_text(time_step)//" and end_time = "//real_text(end_time) &
         & //", expected time_step < end_time")
   end subroutine check_times

end module vcor_case_consistency
