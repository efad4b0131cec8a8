!> The C interface: moduli of the materials of a case; include/vcor.h documents the functions
module vcor_c_api_moduli
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan
   use, intrinsic :: iso_c_binding, only : c_double, c_int, c_ptr
   use vcor_c_api_handle, only : find_body, find_item
   use vcor_c_api_values, only : get_array, report_error
   use vcor_case_body, only : time_factors_of_case
   use vcor_case_case, only : case_t
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: vcor_relaxation, vcor_complex_modulus, vcor_time_factor, vcor_time_factors

contains

   !> Compute the relaxation modulus of a material
   function vcor_relaxation(self, material, n, times, moduli, error) bind(c) result(code)
      type(c_ptr), value :: self, material
      integer(c_int), value :: n
      type(c_ptr), value :: times, moduli, error
      integer(c_int) :: code

      class(material_t), allocatable :: body
      type(error_t), allocatable :: trouble
      real(c_double), pointer :: t(:), modulus(:)
      integer :: i

      call find_body(self, material, body, trouble)
      call get_array(n, times, 'times', t, trouble)
      call get_array(n, moduli, 'moduli', modulus, trouble)
      if (.not. allocated(trouble)) then
         if (any(ieee_is_nan(t))) call raise(trouble, error_input, &
            'found a time that is not a number, expected times >= 0 [s]')
      end if
      if (.not. allocated(trouble)) then
         if (any(t < 0.0_wp)) &
            call raise(trouble, error_input, 'found a negative time, expected times >= 0 [s]')
      end if
      if (.not. allocated(trouble)) then
         do i = 1, n
            modulus(i) = body%relaxation(t(i))
         end do
      end if
      code = report_error(trouble, error)
   end function vcor_relaxation

   !> Compute storage and loss modulus of a material
   function vcor_complex_modulus(self, material, n, frequencies, storage, loss, error) bind(c) &
      result(code)
      type(c_ptr), value :: self, material
      integer(c_int), value :: n
      type(c_ptr), value :: frequencies, storage, loss, error
      integer(c_int) :: code

      class(material_t), allocatable :: body
      type(error_t), allocatable :: trouble
      real(c_double), pointer :: omega(:), real_part(:), imaginary_part(:)
      complex(wp) :: modulus
      integer :: i

      call find_body(self, material, body, trouble)
      call get_array(n, frequencies, 'frequencies', omega, trouble)
      call get_array(n, storage, 'storage', real_part, trouble)
      call get_array(n, loss, 'loss', imaginary_part, trouble)
      if (.not. allocated(trouble)) then
         if (.not. all(ieee_is_finite(omega))) call raise(trouble, error_input, &
            'found a frequency that is not a number or infinite, expected them >= 0 [rad/s]')
      end if
      if (.not. allocated(trouble)) then
         if (any(omega < 0.0_wp)) call raise(trouble, error_input, &
            'found a negative frequency, expected them >= 0 [rad/s]')
      end if
      if (.not. allocated(trouble)) then
         do i = 1, n
            modulus = body%complex_modulus(cmplx(0.0_wp, omega(i), wp))
            real_part(i) = real(modulus, wp)
            imaginary_part(i) = aimag(modulus)
         end do
      end if
      code = report_error(trouble, error)
   end function vcor_complex_modulus

   !> Get the factor by which the temperature of the impact multiplies all times of a material
   function vcor_time_factor(self, material, factor, error) bind(c) result(code)
      type(c_ptr), value :: self, material, factor, error
      integer(c_int) :: code

      class(material_t), allocatable :: body
      type(error_t), allocatable :: trouble
      real(c_double), pointer :: place(:)

      call find_body(self, material, body, trouble)
      call get_array(1_c_int, factor, 'factor', place, trouble)
      if (.not. allocated(trouble)) place = body%time_factor
      code = report_error(trouble, error)
   end function vcor_time_factor

   !> Get the factors by which temperatures multiply all times of a material
   function vcor_time_factors(self, material, n, temperatures, factors, error) bind(c) result(code)
      type(c_ptr), value :: self, material
      integer(c_int), value :: n
      type(c_ptr), value :: temperatures, factors, error
      integer(c_int) :: code

      type(case_t) :: case
      type(error_t), allocatable :: trouble
      real(c_double), pointer :: kelvin(:), factor(:)
      integer :: item

      call find_item(self, material, case, item, trouble)
      call get_array(n, temperatures, 'temperatures', kelvin, trouble)
      call get_array(n, factors, 'factors', factor, trouble)
      if (.not. allocated(trouble)) then
         if (.not. all(ieee_is_finite(kelvin))) call raise(trouble, error_input, &
            'found a temperature that is not a number or infinite, expected them > 0 [K]')
      end if
      if (.not. allocated(trouble)) then
         if (.not. all(kelvin > 0.0_wp)) call raise(trouble, error_input, &
            'found a temperature that is not positive, expected them > 0 [K]')
      end if
      if (.not. allocated(trouble)) then
!$omp critical (vcor_c_api)
         call time_factors_of_case(case, item, kelvin, factor, trouble)
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_time_factors

end module vcor_c_api_moduli
