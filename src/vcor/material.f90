!> Materials by the name of their model
module vcor_material
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_mittag_leffler, only : mittag_leffler_t, new_mittag_leffler
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, new_sls, prony_t
   use vcor_material_table, only : new_tabulated, tabulated_t
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: material_t, material_data_t, new_material

   !> What describes a material of any model; a model looks at its own components only
   type :: material_data_t
      !> Name that cases call it by
      character(len=:), allocatable :: name
      !> One of rigid, elastic, sls, prony, power_law, cerf, mittag_leffler, table
      character(len=:), allocatable :: model
      !> Mass density [kg/m3]; 0: not known
      real(wp) :: density = 0.0_wp
      !> Poisson's ratio [-]
      real(wp) :: poisson_ratio = 0.5_wp
      !> elastic: Young's modulus [Pa]
      real(wp) :: modulus = 0.0_wp
      !> sls: glassy modulus [Pa]
      real(wp) :: glassy_modulus = 0.0_wp
      !> sls: parameter alpha [1/s]
      real(wp) :: alpha = 0.0_wp
      !> sls: rate of relaxation [1/s]; cerf: its root [s^(-1/2)]
      real(wp) :: beta = 0.0_wp
      !> prony, power_law, cerf, mittag_leffler: equilibrium modulus [Pa]
      real(wp) :: equilibrium_modulus = 0.0_wp
      !> prony: moduli of the terms; table: of the points [Pa], shape (n)
      real(wp), allocatable :: moduli(:)
      !> prony: rates of the terms [1/s], shape (n)
      real(wp), allocatable :: rates(:)
      !> prony: viscosity of a dashpot in parallel [Pa s]
      real(wp) :: viscosity = 0.0_wp
      !> power_law: coefficient [Pa s^a]
      real(wp) :: coefficient = 0.0_wp
      !> power_law, mittag_leffler: exponent a [-]
      real(wp) :: exponent = 0.5_wp
      !> cerf, mittag_leffler: relaxing modulus [Pa]
      real(wp) :: relaxing_modulus = 0.0_wp
      !> mittag_leffler: relaxation time [s]
      real(wp) :: time = 0.0_wp
      !> table: times of the points [s], shape (n)
      real(wp), allocatable :: times(:)
   contains
      !> Set a number by its name
      procedure :: set
      !> Whether another one has the same modulus
      procedure :: deforms_as
   end type material_data_t

contains

   !> Whether two descriptions are of one and the same modulus, whatever their names and densities
   pure function deforms_as(self, other) result(is_same)
      !> The description
      class(material_data_t), intent(in) :: self
      !> The other one
      type(material_data_t), intent(in) :: other
      !> Whether they are
      logical :: is_same

      is_same = self%model == other%model
      if (.not. is_same) return
      is_same = is_equal(numbers(self), numbers(other)) .and. is_equal(self%moduli, other%moduli) &
         .and. is_equal(self%rates, other%rates) .and. is_equal(self%times, other%times)

   contains

      !> The numbers of a description that are part of its modulus
      pure function numbers(data)
         !> The description
         type(material_data_t), intent(in) :: data
         !> Numbers
         real(wp) :: numbers(11)

         numbers = [data%poisson_ratio, data%modulus, data%glassy_modulus, data%alpha, data%beta, &
            data%equilibrium_modulus, data%viscosity, data%coefficient, data%exponent, &
            data%relaxing_modulus, data%time]
      end function numbers

      !> Whether two lists are equal, or both not there
      pure function is_equal(one, another)
         !> A list
         real(wp), intent(in), optional :: one(:)
         !> Another one
         real(wp), intent(in), optional :: another(:)
         !> Whether they are
         logical :: is_equal

         is_equal = present(one) .eqv. present(another)
         if (.not. (is_equal .and. present(one))) return
         is_equal = size(one) == size(another)
         if (is_equal) is_equal = .not. any(abs(one - another) > 0.0_wp)
      end function is_equal
   end function deforms_as

   !> Set a number by its name, that of the component
   pure subroutine set(self, name, value, is_taken)
      !> The description
      class(material_data_t), intent(inout) :: self
      !> Name of a number
      character(len=*), intent(in) :: name
      !> Its value, in the unit of the component
      real(wp), intent(in) :: value
      !> Whether there is a number of this name; otherwise nothing changes
      logical, intent(out) :: is_taken

      is_taken = .true.
      select case (name)
      case ('density')
         self%density = value
      case ('poisson_ratio')
         self%poisson_ratio = value
      case ('modulus')
         self%modulus = value
      case ('glassy_modulus')
         self%glassy_modulus = value
      case ('alpha')
         self%alpha = value
      case ('beta')
         self%beta = value
      case ('equilibrium_modulus')
         self%equilibrium_modulus = value
      case ('viscosity')
         self%viscosity = value
      case ('coefficient')
         self%coefficient = value
      case ('exponent')
         self%exponent = value
      case ('relaxing_modulus')
         self%relaxing_modulus = value
      case ('time')
         self%time = value
      case default
         is_taken = .false.
      end select
   end subroutine set

   !> Build a material
   subroutine new_material(material, data, error)
      !> The material; not allocated on failure
      class(material_t), allocatable, intent(out) :: material
      !> Its description
      type(material_data_t), intent(in) :: data
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(prony_t) :: prony
      type(power_law_t) :: power_law
      type(cerf_t) :: cerf
      type(mittag_leffler_t) :: mittag_leffler
      type(tabulated_t) :: table

      select case (data%model)
      case ('rigid')
         call new_rigid(prony)
         call accept(prony)
      case ('elastic')
         call new_elastic(prony, data%modulus, error)
         call accept(prony)
      case ('sls')
         call new_sls(prony, data%glassy_modulus, data%alpha, data%beta, error)
         call accept(prony)
      case ('prony')
         call new_prony(prony, data%equilibrium_modulus, data%moduli, data%rates, &
            data%viscosity, error)
         call accept(prony)
      case ('power_law')
         call new_power_law(power_law, data%equilibrium_modulus, data%coefficient, &
            data%exponent, error)
         call accept(power_law)
      case ('cerf')
         call new_cerf(cerf, data%equilibrium_modulus, data%relaxing_modulus, data%beta, error)
         call accept(cerf)
      case ('mittag_leffler')
         if (data%exponent < 1.0_wp .or. data%exponent > 1.0_wp &
            .or. .not. data%time > tiny(1.0_wp)) then
            call new_mittag_leffler(mittag_leffler, data%equilibrium_modulus, &
               data%relaxing_modulus, data%exponent, data%time, error)
            call accept(mittag_leffler)
         else
            ! the standard linear solid, a sum of one exponential
            call new_prony(prony, data%equilibrium_modulus, [data%relaxing_modulus], &
               [1.0_wp/data%time], 0.0_wp, error)
            call accept(prony)
         end if
      case ('table')
         call new_tabulated(table, data%times, data%moduli, error)
         call accept(table)
      case default
         call raise(error, error_input, "unknown model '"//data%model &
            //"'; known: rigid, elastic, sls, prony, power_law, cerf, " &
            //'mittag_leffler, table')
      end select

   contains

      !> Take a finished material over
      subroutine accept(built)
         !> The material
         class(material_t), intent(in) :: built

         if (allocated(error)) return
         allocate (material, source=built)
         material%name = data%name
         material%density = data%density
         material%poisson_ratio = data%poisson_ratio
         call material%check_constants(error)
         if (allocated(error)) deallocate (material)
      end subroutine accept
   end subroutine new_material

end module vcor_material
