!> Time-temperature superposition: at temperature T all times of a material are a_T times those at
!> its reference temperature, and its moduli are b_T times as large
!>
!>     E(t; T) = b_T E(t/a_T; T_ref),   Q(s; T) = b_T Q(a_T s; T_ref),   b_T = T/T_ref or 1
!>
!>     wlf         log10 a_T = -C1 (T - T_ref)/(C2 + T - T_ref)
!>     arrhenius   ln a_T = (E_a/R) (1/T - 1/T_ref)
!>     table       log10 a_T interpolated in given points
!>
!> M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701,
!> doi:10.1021/ja01619a008. The ratio of densities in their b_T is left out.
module vcor_material_shift
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : gas_constant, wp
   use vcor_material_type, only : parameter_t
   use vcor_number, only : identity_of, positive
   use vcor_numeric_monotone, only : cubic, monotone_slopes, piece
   implicit none
   private

   public :: shift_t, shift_laws, shift_parameters, shift_keys, keys_needed, key_laws, &
      coldest

   !> Names of the laws, separated by blanks
   character(len=*), parameter :: shift_laws = 'wlf arrhenius table'
   !> Constants of the laws
   type(parameter_t), parameter :: shift_parameters(*) = [ &
      parameter_t('reference_temperature', 'Temperature at which the constants of the model hold', &
      'K', positive, required=.false.), &
      parameter_t('wlf_c1', 'Constant C1 of the WLF law, to base 10', '', positive, &
      required=.false.), &
      parameter_t('wlf_c2', 'Constant C2 of the WLF law', 'K', positive, required=.false.), &
      parameter_t('activation_energy', 'Activation energy of the Arrhenius law', 'J/mol', &
      positive, required=.false.)]

   !> Keys that belong to `shift`
   character(len=*), parameter :: shift_keys(*) = [character(len=26) :: shift_parameters%name, &
      'shift_file', 'vertical_shift', 'valid_temperature_from', 'valid_temperature_to']
   !> The first so many keys are required by the laws to which they belong
   integer, parameter :: keys_needed = size(shift_parameters) + 1
   !> Temperature below which a number is probably one in degrees Celsius [K]: all polymers are
   !> glasses there, and few are used above 100 C
   real(wp), parameter :: coldest = 100.0_wp
   !> Laws to which each key belongs
   character(len=*), parameter :: key_laws(*) = [character(len=len(shift_laws)) :: shift_laws, &
      'wlf', 'wlf', 'arrhenius', 'table', shift_laws, shift_laws, shift_laws]

   !> Effect of temperature on a material
   type :: shift_t
      !> One of `shift_laws`; empty: none
      character(len=9) :: law = ''
      !> Whether the moduli are proportional to the absolute temperature
      logical :: vertical = .false.
      !> Temperatures of the table [K], increasing, shape (n)
      real(wp), allocatable :: temperatures(:)
      !> log10 a_T there, not increasing, shape (n)
      real(wp), allocatable :: logarithms(:)
      !> Identity of the table, see `identity_of`
      integer(int64) :: identity = 0_int64
   contains
      procedure :: set_table
      !> a_T and b_T at a temperature
      procedure :: find_factors
   end type shift_t

contains

   !> Set the table
   pure subroutine set_table(self, temperatures, logarithms)
      class(shift_t), intent(inout) :: self
      !> Temperatures [K], increasing, and log10 a_T there, not increasing, shape (n)
      real(wp), intent(in) :: temperatures(:), logarithms(:)

      self%temperatures = temperatures
      self%logarithms = logarithms
      self%identity = identity_of([temperatures, logarithms])
   end subroutine set_table

   !> a_T and b_T at a temperature; both are exactly 1 at the reference temperature and without a
   !> law
   pure subroutine find_factors(self, temperature, constants, a, b, error)
      class(shift_t), intent(in) :: self
      !> Temperature [K], > 0; 0: the reference temperature
      real(wp), intent(in) :: temperature
      !> Values of `shift_parameters`, 0 for those that the law does not have
      real(wp), intent(in) :: constants(size(shift_parameters))
      !> a_T [-]
      real(wp), intent(out) :: a
      !> b_T [-]
      real(wp), intent(out) :: b
      !> Error of code `error_input` where the law does not hold, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      ! largest |log10 a_T|: squares of rates, at most 1e60 of the case times this, are then numbers
      real(wp), parameter :: farthest = 60.0_wp
      ! long enough for any two finite numbers
      character(len=640) :: reach
      character(len=48) :: hint
      real(wp) :: decades, distance

      a = 1.0_wp
      b = 1.0_wp
      if (self%law == '' .or. .not. temperature > 0.0_wp) return
      hint = ''
      if (temperature < coldest) write (hint, '(a, f0.2, a, f0.2, a)') '; ', temperature, &
         ' C is ', temperature + 273.15_wp, ' K'
      associate (reference => constants(1), c1 => constants(2), c2 => constants(3), &
                 activation_energy => constants(4))
         distance = temperature - reference
         select case (self%law)
         case ('wlf')
            if (.not. c2 + distance > 0.0_wp) then
               call raise(error, error_input, 'expected a temperature above ' &
                  //'reference_temperature - wlf_c2 [K], below which the WLF law does not ' &
                  //'hold'//trim(hint), &
                  about='temperature reference_temperature wlf_c2')
               return
            end if
            decades = -c1*distance/(c2 + distance)
         case ('arrhenius')
            decades = -activation_energy/(gas_constant*log(10.0_wp))*distance &
               /(temperature*reference)
         case default
            associate (first => self%temperatures(1), &
                       last => self%temperatures(size(self%temperatures)))
               if (min(temperature, reference) < first .or. max(temperature, reference) > last) then
                  write (reach, '(f0.2, a, f0.2)') first, ' K to ', last
                  call raise(error, error_input, 'expected temperatures in the table of shift ' &
                     //'factors, '//trim(reach)//' K, which is not extrapolated'//trim(hint), &
                     about='temperature reference_temperature shift_file')
                  return
               end if
            end associate
            decades = tabulated(self, temperature) - tabulated(self, reference)
         end select
         if (.not. abs(decades) <= farthest) then
            call raise(error, error_input, 'expected a shift factor a_T between 1e-60 and 1e60, ' &
               //'outside of which nothing can be computed'//trim(hint), &
               about='temperature reference_temperature')
            return
         end if
         if (self%vertical) b = temperature/reference
      end associate
      a = 10.0_wp**decades
   end subroutine find_factors

   !> log10 a_T of the table, a monotone piecewise cubic
   pure function tabulated(self, temperature) result(decades)
      class(shift_t), intent(in) :: self
      !> Temperature [K], within the table
      real(wp), intent(in) :: temperature
      real(wp) :: decades

      real(wp) :: slopes(size(self%temperatures)), slope
      integer :: i

      slopes = monotone_slopes(self%temperatures, self%logarithms)
      i = piece(self%temperatures, temperature)
      call cubic(self%temperatures(i), self%temperatures(i + 1), self%logarithms(i), &
         self%logarithms(i + 1), slopes(i), slopes(i + 1), temperature, decades, slope)
   end function tabulated

end module vcor_material_shift
