!> Fits for the Python package; they need MINPACK, so they are not in libvcor.so
module vcor_fit_c_api
   use, intrinsic :: iso_c_binding, only : c_associated, c_double, c_f_pointer, c_int, &
      c_null_ptr, c_ptr
   use vcor_c_api, only : c_numbers, c_text, told
   use vcor_case_identified, only : material_text
   use vcor_error, only : error_t, error_usage, raise
   use vcor_fit, only : estimate_t, fit_material, fit_t, samples_t
   use vcor_fit_json, only : fit_json
   use vcor_io_posix, only : fortran => fortran_text
   use vcor_io_sample_file, only : read_samples, reading_t
   use vcor_kinds, only : wp
   use vcor_material, only : identifiable_models
   use vcor_text, only : printable
   use vcor_words, only : contains_word, join_words, suggestion
   implicit none
   private

   public :: c_fit_t, vcor_fit_data, vcor_read_moduli

   !> What is to be fitted, and what was found
   type, bind(c) :: c_fit_t
      !> Data file; null: the samples are given
      type(c_ptr) :: file
      !> Model
      type(c_ptr) :: model
      !> Name of the material
      type(c_ptr) :: name
      !> Terms of a Prony series; 0: as many as the data support
      integer(c_int) :: terms
      !> Whether the samples are storage and loss moduli
      integer(c_int) :: dynamic
      !> Number of samples
      integer(c_int) :: n
      !> Number of parameters that are given
      integer(c_int) :: fixed_count
      !> Times [s] or angular frequencies [rad/s], rising, shape (n)
      type(c_ptr) :: at
      !> Relaxation or storage moduli [Pa], shape (n)
      type(c_ptr) :: modulus
      !> Loss moduli [Pa], shape (n)
      type(c_ptr) :: loss
      !> Names of the parameters that are given, with blanks between them
      type(c_ptr) :: fixed_names
      !> Their values, shape (fixed_count)
      type(c_ptr) :: fixed_values
      !> Poisson's ratio [-]; beyond 0.5: not given, 0.5 is taken
      real(c_double) :: poisson_ratio
      !> Density [kg/m3]; 0: not known
      real(c_double) :: density
      !> Found: the document of `vcor_fit_json`; released by free()
      type(c_ptr) :: json
   end type c_fit_t

contains

   !> Fit a model to data
   function vcor_fit_data(c_fit, error) bind(c) result(code)
      !> What is to be fitted; its last component is set
      type(c_fit_t), intent(inout) :: c_fit
      !> `vcor_error`, or null
      type(c_ptr), value :: error
      !> 0 or the code of the error
      integer(c_int) :: code

      type(error_t), allocatable :: trouble
      type(estimate_t), allocatable :: fixed(:)
      type(samples_t) :: samples
      type(reading_t) :: reading
      type(fit_t) :: fit
      character(len=:), allocatable :: model, note, place

      c_fit%json = c_null_ptr
!$omp critical (vcor_c_api)
      allocate (reading%units(0))
      reading%poisson_ratio = c_fit%poisson_ratio
      model = fortran(c_fit%model)
      place = fortran(c_fit%name)
      call take_fixed(c_fit, fixed)
      if (.not. contains_word(identifiable_models, model)) then
         call raise(trouble, error_usage, "found model '"//printable(model)//"', expected one of " &
            //join_words(identifiable_models)//'; '//suggestion(model, identifiable_models))
      else if (c_associated(c_fit%file)) then
         call read_samples(samples, fortran(c_fit%file), reading, note, place, trouble)
      else
         call take_samples(c_fit, samples)
      end if
      if (.not. allocated(trouble)) then
         call fit_material(fit, model, int(c_fit%terms), fixed, samples, trouble)
         if (allocated(trouble)) trouble%message = place//': '//trouble%message
      end if
      if (.not. allocated(trouble)) then
         fit%data%name = fortran(c_fit%name)
         c_fit%json = c_text(fit_json(fit, samples, material_text(fit%data, &
            real(c_fit%density, wp), min(0.5_wp, real(c_fit%poisson_ratio, wp)), &
            samples%first_time(), samples%last_time(), samples%keys)))
      end if
!$omp end critical (vcor_c_api)
      code = told(trouble, error)
   end function vcor_fit_data

   !> Read moduli from a data file as `vcor fit` does, in SI units
   function vcor_read_moduli(file, poisson_ratio, n, dynamic, values, error) bind(c) result(code)
      !> Name of the file
      type(c_ptr), value :: file
      !> Poisson's ratio for shear moduli; beyond 0.5: not given
      real(c_double), value :: poisson_ratio
      !> Number of samples, and whether they are storage and loss moduli
      integer(c_int), intent(out) :: n, dynamic
      !> Times or angular frequencies, moduli, and loss moduli if dynamic; released by free()
      type(c_ptr), intent(out) :: values
      !> `vcor_error`, or null
      type(c_ptr), value :: error
      !> 0 or the code of the error
      integer(c_int) :: code

      type(error_t), allocatable :: trouble
      type(samples_t) :: samples
      type(reading_t) :: reading
      character(len=:), allocatable :: note, place

      n = 0
      dynamic = 0
      values = c_null_ptr
!$omp critical (vcor_c_api)
      allocate (reading%units(0))
      reading%poisson_ratio = poisson_ratio
      call read_samples(samples, fortran(file), reading, note, place, trouble)
      if (.not. allocated(trouble)) then
         n = size(samples%at)
         dynamic = merge(1_c_int, 0_c_int, samples%dynamic)
         values = c_numbers([samples%at, samples%modulus, samples%loss])
      end if
!$omp end critical (vcor_c_api)
      code = told(trouble, error)
   end function vcor_read_moduli

   !> Samples that are given
   subroutine take_samples(c_fit, samples)
      !> What is to be fitted
      type(c_fit_t), intent(in) :: c_fit
      type(samples_t), intent(out) :: samples

      real(c_double), pointer :: numbers(:)

      samples%dynamic = c_fit%dynamic /= 0
      call c_f_pointer(c_fit%at, numbers, [c_fit%n])
      allocate (samples%at, source=numbers)
      call c_f_pointer(c_fit%modulus, numbers, [c_fit%n])
      allocate (samples%modulus, source=numbers)
      allocate (samples%loss(0))
      if (.not. samples%dynamic) return
      call c_f_pointer(c_fit%loss, numbers, [c_fit%n])
      samples%loss = numbers
   end subroutine take_samples

   !> Parameters that are given
   subroutine take_fixed(c_fit, fixed)
      !> What is to be fitted
      type(c_fit_t), intent(in) :: c_fit
      !> The parameters
      type(estimate_t), allocatable, intent(out) :: fixed(:)

      real(c_double), pointer :: numbers(:)
      character(len=:), allocatable :: names

      allocate (fixed(c_fit%fixed_count))
      if (c_fit%fixed_count == 0) return
      names = fortran(c_fit%fixed_names)
      read (names, *) fixed%name
      call c_f_pointer(c_fit%fixed_values, numbers, [c_fit%fixed_count])
      fixed%value = numbers
   end subroutine take_fixed

end module vcor_fit_c_api
