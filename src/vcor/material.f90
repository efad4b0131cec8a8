!> Materials by the name of their model. A new model is a file of its own under material/ and its
!> lines here: its name, its parameters, and how it is built from values
module vcor_material
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material_cerf, only : cerf_parameters, cerf_t, new_cerf
   use vcor_material_mittag_leffler, only : mittag_leffler_parameters, mittag_leffler_t, &
      new_mittag_leffler
   use vcor_material_parameter, only : density, parameter_t
   use vcor_material_power_law, only : new_power_law, power_law_parameters, power_law_t
   use vcor_material_prony, only : elastic_parameters, new_elastic, new_prony, new_rigid, new_sls, &
      prony_parameters, prony_t, rigid_parameters, sls_parameters
   use vcor_material_shifted, only : new_shifted, shift_parameters, shift_t, shifted_t
   use vcor_material_table, only : new_tabulated, table_parameters, tabulated_t
   use vcor_material_type, only : material_t
   use vcor_words, only : join_words
   implicit none
   private

   public :: material_t, material_data_t, new_material, set_constants_of
   public :: models, identifiable_models, relaxing_models, model_parameter_t, model_parameters
   public :: parameters_of

   !> Names of the models, separated by blanks
   character(len=*), parameter :: models = &
      'rigid elastic sls prony power_law cerf mittag_leffler table'
   !> Those that can be fitted to data
   character(len=*), parameter :: identifiable_models = 'prony sls power_law cerf mittag_leffler'
   !> Those whose times a temperature can shift
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

   !> Most values of a description: more than there are names
   integer, parameter :: most_values = size(model_parameters) + size(shift_parameters) + 1

   !> A value, or a list of them
   type :: value_t
      !> Name of the parameter
      character(len=len(density%name)) :: name = ''
      !> Number
      real(wp) :: number = 0.0_wp
      !> List, shape (n)
      real(wp), allocatable :: list(:)
   end type value_t

   !> What describes a material of any model: values by the names of its parameters
   type :: material_data_t
      !> Name that cases call it by
      character(len=:), allocatable :: name
      !> One of `models`
      character(len=:), allocatable :: model
      !> Whether the moduli are shear moduli G, of which E = 2 (1 + nu) G is made
      logical :: is_shear = .false.
      !> What a temperature does to it; the constants of its law are values
      type(shift_t) :: shift
      !> Temperature [K]; 0: the reference temperature
      real(wp) :: temperature = 0.0_wp
      !> The first name that no model has a parameter of; not allocated if there is none
      character(len=:), allocatable, private :: unknown
      !> Number of values
      integer, private :: n = 0
      !> The values
      type(value_t), private :: value(most_values)
   contains
      procedure :: set
      procedure :: set_list
      procedure :: number
      procedure :: list
      procedure :: deforms_as
      procedure, private :: place_of
      procedure, private :: find
   end type material_data_t

contains

   !> Parameters of a model
   pure function parameters_of(model) result(parameters)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Its parameters; none where there is no such model
      type(parameter_t), allocatable :: parameters(:)

      allocate (parameters, source=pack(model_parameters%parameter, &
         model_parameters%model == model))
   end function parameters_of

   !> Place of a value
   pure function place_of(self, name) result(place)
      class(material_data_t), intent(in) :: self
      character(len=*), intent(in) :: name
      !> Place, 0 where there is none
      integer :: place

      do place = self%n, 1, -1
         if (self%value(place)%name == name) return
      end do
   end function place_of

   !> Find the place of a value, a new one where there is none yet
   pure subroutine find(self, name, place)
      class(material_data_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      !> Place, 0 where no model has such a parameter
      integer, intent(out) :: place

      place = self%place_of(name)
      if (place > 0) return
      if (name == density%name .or. any(model_parameters%parameter%name == name) &
          .or. any(shift_parameters%name == name)) then
         self%n = self%n + 1
         place = self%n
         self%value(place)%name = name
      else if (.not. allocated(self%unknown)) then
         self%unknown = name
      end if
   end subroutine find

   !> Set a number by the name of its parameter
   pure subroutine set(self, name, value)
      class(material_data_t), intent(inout) :: self
      !> `density`, or a parameter of any model; otherwise `new_material` fails
      character(len=*), intent(in) :: name
      !> Its value, in the unit of the parameter
      real(wp), intent(in) :: value

      integer :: place

      call self%find(name, place)
      if (place > 0) self%value(place)%number = value
   end subroutine set

   !> Set a list by the name of its parameter; the points of a table are lists `times` and `moduli`
   pure subroutine set_list(self, name, list)
      class(material_data_t), intent(inout) :: self
      !> A parameter of any model; otherwise `new_material` fails
      character(len=*), intent(in) :: name
      !> Its values, shape (n)
      real(wp), intent(in) :: list(:)

      integer :: place

      call self%find(name, place)
      if (place > 0) self%value(place)%list = list
   end subroutine set_list

   !> A number by the name of its parameter
   pure function number(self, name)
      class(material_data_t), intent(in) :: self
      character(len=*), intent(in) :: name
      !> Its value, 0 where none was set
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
      !> Its values, none where it was not set
      real(wp), allocatable :: list(:)

      integer :: place

      place = self%place_of(name)
      if (place > 0) then
         if (allocated(self%value(place)%list)) list = self%value(place)%list
      end if
      if (.not. allocated(list)) allocate (list(0))
   end function list

   !> Whether two descriptions are of one and the same modulus, whatever their names and densities
   pure function deforms_as(self, other) result(is_same)
      class(material_data_t), intent(in) :: self
      class(material_data_t), intent(in) :: other
      logical :: is_same

      is_same = self%model == other%model .and. (self%is_shear .eqv. other%is_shear) &
         .and. self%shift%law == other%shift%law &
         .and. (self%shift%vertical .eqv. other%shift%vertical) &
         .and. has_all_of(self, other) .and. has_all_of(other, self)
      if (is_same .and. allocated(self%shift%temperatures)) is_same = &
         size(self%shift%temperatures) == size(other%shift%temperatures)
      if (is_same .and. allocated(self%shift%temperatures)) is_same = .not. &
         (any(abs(self%shift%temperatures - other%shift%temperatures) > 0.0_wp) &
         .or. any(abs(self%shift%logarithms - other%shift%logarithms) > 0.0_wp))
   end function deforms_as

   !> Whether a description has all values of another but its density
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
            if (.not. (yes .and. allocated(value%list))) cycle
            yes = size(self%list(value%name)) == size(value%list)
            if (yes) yes = .not. any(abs(self%list(value%name) - value%list) > 0.0_wp)
         end associate
      end do
   end function has_all_of

   !> Give a material the density and Poisson's ratio of a description, as far as it has them, and
   !> its temperature
   pure subroutine set_constants_of(material, data, error)
      class(material_t), intent(inout) :: material
      type(material_data_t), intent(in) :: data
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: a, b
      integer :: i

      if (data%place_of('density') > 0) &
         call material%set_constants(error, density=data%number('density'))
      if (allocated(error)) return
      if (data%place_of('poisson_ratio') > 0) &
         call material%set_constants(error, poisson_ratio=data%number('poisson_ratio'))
      if (allocated(error)) return
      select type (material)
      type is (shifted_t)
         call data%shift%find_factors(data%temperature, &
            [(data%number(shift_parameters(i)%name), i=1, size(shift_parameters))], a, b, error)
         if (.not. allocated(error)) call material%take_factors(a, b)
      end select
   end subroutine set_constants_of

   !> A description with tensile moduli in place of shear moduli
   pure function tensile(data)
      !> Of shear moduli
      type(material_data_t), intent(in) :: data
      type(material_data_t) :: tensile

      character(len=*), parameter :: pascal = 'Pa'
      type(parameter_t) :: parameter
      real(wp) :: factor
      integer :: i

      tensile = data
      tensile%is_shear = .false.
      factor = 2.0_wp*(1.0_wp + data%number('poisson_ratio'))
      do i = 1, data%n
         associate (value => tensile%value(i))
            if (all(model_parameters%parameter%name /= value%name)) cycle
            parameter = model_parameters(findloc(model_parameters%parameter%name == value%name, &
               .true., dim=1))%parameter
            ! Pa, and Pa times a power of time
            if (parameter%unit(:len(pascal)) /= pascal) cycle
            value%number = factor*value%number
            if (allocated(value%list)) value%list(:) = factor*value%list
         end associate
      end do
   end function tensile

   !> Build a material
   recursive subroutine new_material(material, data, error)
      !> The material; not allocated on failure
      class(material_t), allocatable, intent(out) :: material
      type(material_data_t), intent(in) :: data
      type(error_t), allocatable, intent(out) :: error

      type(shifted_t) :: shifted
      type(prony_t) :: prony
      type(power_law_t) :: power_law
      type(cerf_t) :: cerf
      type(mittag_leffler_t) :: mittag_leffler
      type(tabulated_t) :: table
      real(wp), allocatable :: rates(:)
      real(wp) :: exponent, time

      if (data%is_shear) then
         call new_material(material, tensile(data), error)
         return
      end if
      if (allocated(data%unknown)) then
         call raise(error, error_input, "a material has no parameter '"//data%unknown//"'")
         return
      end if
      select case (data%model)
      case ('rigid')
         call new_rigid(prony)
         call accept(prony)
      case ('elastic')
         call new_elastic(prony, data%number('modulus'), error)
         call accept(prony)
      case ('sls')
         call new_sls(prony, data%number('glassy_modulus'), data%number('alpha'), &
            data%number('beta'), error)
         call accept(prony)
      case ('prony')
         rates = data%list('rates')
         if (size(rates) == 0) rates = 1.0_wp/data%list('times')
         call new_prony(prony, data%number('equilibrium_modulus'), data%list('moduli'), &
            rates, data%number('viscosity'), error)
         call accept(prony)
      case ('power_law')
         call new_power_law(power_law, data%number('equilibrium_modulus'), &
            data%number('coefficient'), data%number('exponent'), error)
         call accept(power_law)
      case ('cerf')
         call new_cerf(cerf, data%number('equilibrium_modulus'), data%number('relaxing_modulus'), &
            data%number('beta'), error)
         call accept(cerf)
      case ('mittag_leffler')
         exponent = data%number('exponent')
         time = data%number('time')
         if (exponent < 1.0_wp .or. exponent > 1.0_wp .or. .not. time > tiny(time)) then
            call new_mittag_leffler(mittag_leffler, data%number('equilibrium_modulus'), &
               data%number('relaxing_modulus'), exponent, time, error)
            call accept(mittag_leffler)
         else
            ! the standard linear solid, a sum of one exponential
            call new_prony(prony, data%number('equilibrium_modulus'), &
               [data%number('relaxing_modulus')], [1.0_wp/time], 0.0_wp, error)
            call accept(prony)
         end if
      case ('table')
         call new_tabulated(table, data%list('times'), data%list('moduli'), error)
         call accept(table)
      case default
         call raise(error, error_input, "unknown model '"//data%model//"'; known: " &
            //join_words(models))
      end select

   contains

      !> Take a finished material over
      subroutine accept(built)
         class(material_t), intent(in) :: built

         if (allocated(error)) return
         allocate (material, source=built)
         material%name = data%name
         if (data%shift%law /= '') then
            call new_shifted(shifted, material)
            deallocate (material)
            allocate (material, source=shifted)
         end if
         call set_constants_of(material, data, error)
         if (allocated(error)) deallocate (material)
      end subroutine accept
   end subroutine new_material

end module vcor_material
