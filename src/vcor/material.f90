!> Factory of materials by the name of their model. A new model is a file under material/ and its
!> lines here: name, parameters, and how it is built from values
module vcor_material
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material_cerf, only : cerf_parameters, cerf_t, new_cerf
   use vcor_material_mittag_leffler, only : mittag_leffler_parameters, mittag_leffler_t, &
      new_mittag_leffler
   use vcor_material_power_law, only : new_power_law, power_law_parameters, power_law_t
   use vcor_material_prony, only : elastic_parameters, new_elastic, new_prony, new_rigid, new_sls, &
      prony_parameters, prony_t, rigid_parameters, sls_parameters
   use vcor_material_shift, only : shift_parameters, shift_t
   use vcor_material_table, only : new_tabulated, table_parameters, tabulated_t
   use vcor_material_type, only : density, material_t, parameter_t, power_of_time
   use vcor_number, only : identity_of
   use vcor_words, only : join_words
   implicit none
   private

   public :: material_t, material_data_t, new_material
   public :: models, identifiable_models, relaxing_models, model_parameter_t, model_parameters
   public :: parameters_of

   !> Names of the models, separated by blanks
   character(len=*), parameter :: models = &
      'rigid elastic sls prony power_law cerf mittag_leffler table'
   !> Models that can be fitted to data
   character(len=*), parameter :: identifiable_models = 'prony sls power_law cerf mittag_leffler'
   !> Models whose times depend on temperature
   character(len=*), parameter :: relaxing_models = identifiable_models//' table'

   !> A parameter and its model
   type :: model_parameter_t
      !> Name of the model
      character(len=56) :: model = ''
      !> The parameter
      type(parameter_t) :: parameter
   end type model_parameter_t

   integer :: i
   !> The parameters of all models
   type(model_parameter_t), parameter :: model_parameters(*) = [ &
      (model_parameter_t('elastic', elastic_parameters(i)), i=1, size(elastic_parameters)), &
      (model_parameter_t('sls', sls_parameters(i)), i=1, size(sls_parameters)), &
      (model_parameter_t('prony', prony_parameters(i)), i=1, size(prony_parameters)), &
      (model_parameter_t('power_law', power_law_parameters(i)), i=1, size(power_law_parameters)), &
      (model_parameter_t('cerf', cerf_parameters(i)), i=1, size(cerf_parameters)), &
      (model_parameter_t('mittag_leffler', mittag_leffler_parameters(i)), &
      i=1, size(mittag_leffler_parameters)), &
      (model_parameter_t('table', table_parameters(i)), i=1, size(table_parameters)), &
      (model_parameter_t('rigid', rigid_parameters(i)), i=1, size(rigid_parameters))]

   !> A value: a number or a list
   type :: value_t
      !> Name of the parameter
      character(len=len(density%name)) :: name = ''
      !> Number
      real(wp) :: number = 0.0_wp
      !> List, shape (n)
      real(wp), allocatable :: list(:)
      !> Identity of the list, see `identity_of`; 0 if there is none
      integer(int64) :: identity = 0_int64
   end type value_t

   !> Description of a material of any model: values by the names of parameters
   type :: material_data_t
      !> Name in the case
      character(len=:), allocatable :: name
      !> One of `models`
      character(len=:), allocatable :: model
      !> Whether the moduli are shear moduli G, converted to E = 2 (1 + nu) G
      logical :: is_shear = .false.
      !> Effect of temperature; the constants of its law are among the values
      type(shift_t) :: shift
      !> Temperature [K]; 0: the reference temperature
      real(wp) :: temperature = 0.0_wp
      !> First name that is no parameter of any model; not allocated if there is none
      character(len=:), allocatable, private :: unknown
      !> Number of values
      integer, private :: n = 0
      !> The values, shape (n)
      type(value_t), allocatable, private :: value(:)
      !> Material made from the points of a table, once they have been fitted
      type(tabulated_t), allocatable, private :: fitted
   contains
      procedure :: set
      procedure :: set_list
      procedure :: fit_points
      procedure :: number
      procedure :: list
      !> a_T and b_T at its temperature
      procedure :: find_factors
      procedure :: deforms_as
      procedure :: is_same_as
      procedure, private :: place_of
      procedure, private :: find
   end type material_data_t

contains

   !> Parameters of a model
   pure function parameters_of(model) result(parameters)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Its parameters; empty for an unknown model
      type(parameter_t), allocatable :: parameters(:)

      allocate (parameters, source=pack(model_parameters%parameter, &
         model_parameters%model == model))
   end function parameters_of

   !> Index of a value
   pure function place_of(self, name) result(place)
      class(material_data_t), intent(in) :: self
      character(len=*), intent(in) :: name
      !> Index, 0 if it has not been set
      integer :: place

      do place = self%n, 1, -1
         if (self%value(place)%name == name) return
      end do
   end function place_of

   !> Find the index of a value; a name that is new gets one
   pure subroutine find(self, name, place)
      class(material_data_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      !> Index, 0 if no model has such a parameter
      integer, intent(out) :: place

      type(value_t), allocatable :: longer(:)

      place = self%place_of(name)
      if (place > 0) return
      if (name == density%name .or. any(model_parameters%parameter%name == name) &
          .or. any(shift_parameters%name == name)) then
         place = self%n + 1
         allocate (longer(place))
         if (self%n > 0) longer(:self%n) = self%value
         longer(place)%name = name
         call move_alloc(longer, self%value)
         self%n = place
      else if (.not. allocated(self%unknown)) then
         self%unknown = name
      end if
   end subroutine find

   !> Set a number by the name of its parameter
   pure subroutine set(self, name, value)
      class(material_data_t), intent(inout) :: self
      !> `density`, or a parameter of any model; for other names `new_material` fails
      character(len=*), intent(in) :: name
      !> Its value, in the unit of the parameter
      real(wp), intent(in) :: value

      integer :: place

      call self%find(name, place)
      if (place > 0) self%value(place)%number = value
   end subroutine set

   !> Set a list by the name of its parameter; the points of a table are lists `times` and `moduli`,
   !> those of a Prony series are `rates` and `moduli`
   pure subroutine set_list(self, name, list)
      class(material_data_t), intent(inout) :: self
      !> A parameter of any model; for other names `new_material` fails
      character(len=*), intent(in) :: name
      !> Its values, shape (n)
      real(wp), intent(in) :: list(:)

      integer :: place

      ! the fit of a table remains valid if its points do not change
      if (allocated(self%fitted)) then
         if (is_same(self%list(name), list)) return
         deallocate (self%fitted)
      end if
      call self%find(name, place)
      if (place == 0) return
      self%value(place)%list = list
      self%value(place)%identity = identity_of(list)
   end subroutine set_list

   !> Whether two lists are the same
   pure function is_same(one, other) result(same)
      !> First list, shape (n)
      real(wp), intent(in) :: one(:)
      !> Second list, shape (m)
      real(wp), intent(in) :: other(:)
      logical :: same

      same = size(one) == size(other)
      if (same) same = .not. any(abs(one - other) > 0.0_wp)
   end function is_same

   !> Whether two lists are the same but for their rounding
   pure function is_near(one, other) result(near)
      !> First list, shape (n)
      real(wp), intent(in) :: one(:)
      !> Second list, shape (m)
      real(wp), intent(in) :: other(:)
      logical :: near

      ! a rate and the inverse of its time are decimal numbers and a quotient, each rounded by half
      ! of epsilon
      real(wp), parameter :: rounding = 2.0_wp*epsilon(1.0_wp)

      near = size(one) == size(other)
      if (near) near = .not. any(abs(one - other) > rounding*abs(other))
   end function is_near

   !> Fit the points of a table once for all temperatures; otherwise `new_material` fits them each
   !> time. If the points are invalid, `new_material` reports why
   pure subroutine fit_points(self)
      class(material_data_t), intent(inout) :: self

      type(error_t), allocatable :: error

      if (self%model /= 'table' .or. allocated(self%fitted)) return
      allocate (self%fitted)
      call new_tabulated(self%fitted, self%list('times'), self%list('moduli'), error)
      if (allocated(error)) deallocate (self%fitted)
   end subroutine fit_points

   !> A number by the name of its parameter
   pure function number(self, name)
      class(material_data_t), intent(in) :: self
      character(len=*), intent(in) :: name
      !> Its value, 0 if it was not set
      real(wp) :: number

      integer :: place

      number = 0.0_wp
      place = self%place_of(name)
      if (place > 0) number = self%value(place)%number
   end function number

   !> A list by the name of its parameter
   pure function list(self, name)
      class(material_data_t), intent(in) :: self
      character(len=*), intent(in) :: name
      !> Its values, empty if it was not set
      real(wp), allocatable :: list(:)

      integer :: place

      place = self%place_of(name)
      if (place > 0) then
         if (allocated(self%value(place)%list)) list = self%value(place)%list
      end if
      if (.not. allocated(list)) allocate (list(0))
   end function list

   !> a_T and b_T at the temperature; both are 1 without a shift
   pure subroutine find_factors(self, a, b, error)
      class(material_data_t), intent(in) :: self
      !> a_T [-]
      real(wp), intent(out) :: a
      !> b_T [-]
      real(wp), intent(out) :: b
      !> Error of code `error_input` where the law does not hold, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      call self%shift%find_factors(self%temperature, &
         [(self%number(shift_parameters(i)%name), i=1, size(shift_parameters))], a, b, error)
   end subroutine find_factors

   !> Whether two descriptions are the same in all numbers, at the same temperature; lists are
   !> compared by their identities
   pure function is_same_as(self, other) result(same)
      class(material_data_t), intent(in) :: self
      class(material_data_t), intent(in) :: other
      logical :: same

      integer :: i

      same = self%n == other%n .and. self%model == other%model &
         .and. (self%is_shear .eqv. other%is_shear) .and. self%shift%law == other%shift%law &
         .and. (self%shift%vertical .eqv. other%shift%vertical) &
         .and. self%shift%identity == other%shift%identity &
         .and. .not. abs(self%temperature - other%temperature) > 0.0_wp
      do i = 1, self%n
         if (.not. same) return
         same = self%value(i)%name == other%value(i)%name &
            .and. self%value(i)%identity == other%value(i)%identity &
            .and. .not. abs(self%value(i)%number - other%value(i)%number) > 0.0_wp
      end do
   end function is_same_as

   !> Whether two descriptions give the same modulus; names and densities do not matter
   pure function deforms_as(self, other) result(yes)
      class(material_data_t), intent(in) :: self
      class(material_data_t), intent(in) :: other
      logical :: yes

      yes = self%model == other%model .and. (self%is_shear .eqv. other%is_shear) &
         .and. self%shift%law == other%shift%law &
         .and. (self%shift%vertical .eqv. other%shift%vertical) &
         .and. has_all_of(self, other) .and. has_all_of(other, self)
      if (yes .and. allocated(self%shift%temperatures)) yes = &
         is_same(self%shift%temperatures, other%shift%temperatures) &
         .and. is_same(self%shift%logarithms, other%shift%logarithms)
   end function deforms_as

   !> Whether a description has all values of another except its density
   pure function has_all_of(self, other) result(yes)
      class(material_data_t), intent(in) :: self
      class(material_data_t), intent(in) :: other
      logical :: yes

      integer :: i

      yes = .true.
      do i = 1, other%n
         associate (value => other%value(i))
            if (value%name == density%name) cycle
            yes = yes .and. .not. abs(self%number(value%name) - value%number) > 0.0_wp
            if (yes .and. allocated(value%list)) yes = is_near(self%list(value%name), value%list)
         end associate
      end do
   end function has_all_of

   !> Build a material at its temperature, with tensile moduli
   subroutine new_material(material, data, error)
      !> The material; not allocated on failure
      class(material_t), allocatable, intent(out) :: material
      type(material_data_t), intent(in) :: data
      type(error_t), allocatable, intent(out) :: error

      type(prony_t) :: prony
      type(power_law_t) :: power_law
      type(cerf_t) :: cerf
      type(mittag_leffler_t) :: mittag_leffler
      type(tabulated_t) :: table
      !> Factors of times and of moduli
      real(wp) :: a, b
      real(wp) :: exponent, time

      if (allocated(data%unknown)) then
         call raise(error, error_input, "a material has no parameter '"//data%unknown//"'")
         return
      end if
      call data%find_factors(a, b, error)
      if (allocated(error)) return
      if (data%is_shear) b = 2.0_wp*(1.0_wp + data%number('poisson_ratio'))*b
      select case (data%model)
      case ('rigid')
         call new_rigid(prony)
         call accept(prony)
      case ('elastic')
         call new_elastic(prony, value('modulus'), error)
         call accept(prony)
      case ('sls')
         call new_sls(prony, value('glassy_modulus'), value('alpha'), value('beta'), error)
         call accept(prony)
      case ('prony')
         call new_prony(prony, value('equilibrium_modulus'), values('moduli'), values('rates'), &
            value('viscosity'), error)
         call accept(prony)
      case ('power_law')
         call new_power_law(power_law, value('equilibrium_modulus'), value('coefficient'), &
            value('exponent'), error)
         call accept(power_law)
      case ('cerf')
         call new_cerf(cerf, value('equilibrium_modulus'), value('relaxing_modulus'), &
            value('beta'), error)
         call accept(cerf)
      case ('mittag_leffler')
         exponent = value('exponent')
         time = value('time')
         if (exponent < 1.0_wp .or. exponent > 1.0_wp .or. .not. time > tiny(time)) then
            call new_mittag_leffler(mittag_leffler, value('equilibrium_modulus'), &
               value('relaxing_modulus'), exponent, time, error)
            call accept(mittag_leffler)
         else
            ! the standard linear solid, a sum of one exponential
            call new_prony(prony, value('equilibrium_modulus'), &
               [value('relaxing_modulus')], [1.0_wp/time], 0.0_wp, error)
            call accept(prony)
         end if
      case ('table')
         if (allocated(data%fitted)) then
            table = data%fitted
         else
            call new_tabulated(table, data%list('times'), data%list('moduli'), error)
         end if
         if (.not. allocated(error)) call table%rescale(a, b)
         call accept(table)
      case default
         call raise(error, error_input, "unknown model '"//data%model//"'; known: " &
            //join_words(models))
      end select

   contains

      !> A number at the temperature, shear moduli converted to tensile ones
      pure function value(name)
         !> A parameter of the model
         character(len=*), intent(in) :: name
         real(wp) :: value

         value = factor(name)*data%number(name)
      end function value

      !> A list at the temperature, shear moduli converted to tensile ones
      pure function values(name)
         !> A parameter of the model
         character(len=*), intent(in) :: name
         !> Its values, empty if it was not set
         real(wp), allocatable :: values(:)

         values = factor(name)*data%list(name)
      end function values

      !> Factor of a parameter due to shear modulus and temperature, from its unit
      pure function factor(name)
         character(len=*), intent(in) :: name
         real(wp) :: factor

         character(len=*), parameter :: pascal = 'Pa'
         character(len=len(density%unit)) :: unit
         integer :: place

         do place = 1, size(model_parameters)
            if (model_parameters(place)%parameter%name /= name) cycle
            if (model_parameters(place)%model == data%model) exit
         end do
         unit = model_parameters(place)%parameter%unit
         factor = 1.0_wp
         if (unit(:len(pascal)) == pascal) then
            factor = b
            unit = adjustl(unit(len(pascal) + 1:))
         end if
         if (unit == 's^a') then
            factor = factor*a**data%number('exponent')
         else
            factor = factor*a**power_of_time(unit)
         end if
      end function factor

      !> Take over a finished material
      subroutine accept(built)
         class(material_t), intent(in) :: built

         if (allocated(error)) return
         allocate (material, source=built)
         material%name = data%name
         material%time_factor = a
         if (data%place_of('density') > 0) &
            call material%set_constants(error, density=data%number('density'))
         if (.not. allocated(error) .and. data%place_of('poisson_ratio') > 0) &
            call material%set_constants(error, poisson_ratio=data%number('poisson_ratio'))
         if (allocated(error)) deallocate (material)
      end subroutine accept
   end subroutine new_material

end module vcor_material
