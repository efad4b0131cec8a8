!> Functions for the Python package alone: fits, which need MINPACK and so are not in libvcor.so,
!> and the check of a file of results for damage
module vcor_c_api_fit
   use, intrinsic :: iso_c_binding, only : c_associated, c_double, c_int, c_null_ptr, &
      c_ptr
   use vcor_c_api_values, only : c_numbers, c_text, report_error
   use vcor_case_identified, only : material_text
   use vcor_error, only : error_t, error_usage, raise
   use vcor_fit, only : estimate_t, fit_material, fit_t, samples_t
   use vcor_fit_result, only : fit_json
   use vcor_io_posix, only : fortran => fortran_text
   use vcor_io_seal, only : is_altered
   use vcor_io_sample_file, only : read_samples, read_samples_text, reading_t
   use vcor_kinds, only : wp
   use vcor_material, only : identifiable_models
   use vcor_text, only : printable, text_flaw
   use vcor_words, only : contains_word, suggestion
   implicit none
   private

   public :: vcor_fit_data, vcor_read_moduli, vcor_is_altered

contains

   !> Fit a model to data
   function vcor_fit_data(file, n, columns, data, model, name, terms, m, names, values, &
      poisson_ratio, density, json, error) bind(c) result(code)
      !> Name of the data file; null: `data` has the samples
      type(c_ptr), value :: file
      !> Number of samples; 2 columns for times and relaxation moduli, 3 for angular frequencies,
      !> storage and loss moduli
      integer(c_int), value :: n, columns
      !> The samples [s, Pa] or [rad/s, Pa, Pa], in increasing order of time or frequency
      real(c_double), intent(in) :: data(n, columns)
      !> Model, and name of the material
      type(c_ptr), value :: model, name
      !> Terms of a Prony series; 0: as many as the data support
      integer(c_int), value :: terms
      !> Number of fixed parameters
      integer(c_int), value :: m
      !> Their names
      type(c_ptr), intent(in) :: names(m)
      !> Their values
      real(c_double), intent(in) :: values(m)
      !> Poisson's ratio [-]; above 0.5: unknown, 0.5 is used
      real(c_double), value :: poisson_ratio
      !> Density [kg/m3]; 0: unknown
      real(c_double), value :: density
      !> JSON document of the fit; the caller releases it with free()
      type(c_ptr), intent(out) :: json
      !> `vcor_error`, or null
      type(c_ptr), value :: error
      !> 0 or the code of the error
      integer(c_int) :: code

      type(error_t), allocatable :: trouble
      type(estimate_t) :: fixed(m)
      type(samples_t) :: samples
      type(reading_t) :: reading
      type(fit_t) :: fit
      character(len=:), allocatable :: wanted, note, place
      integer :: i

      json = c_null_ptr
!$omp critical (vcor_c_api)
      wanted = fortran(model)
      place = fortran(name)
      do i = 1, m
         fixed(i)%name = fortran(names(i))
         fixed(i)%value = values(i)
      end do
      if (.not. contains_word(identifiable_models, wanted)) then
         call raise(trouble, error_usage, "unknown model '"//printable(wanted)//"'; " &
            //suggestion(wanted, identifiable_models))
      else if (text_flaw(place) /= '') then
         call raise(trouble, error_usage, 'the name of the material: '//text_flaw(place))
      else if (c_associated(file)) then
         allocate (reading%units(0))
         reading%poisson_ratio = poisson_ratio
         call read_samples(samples, fortran(file), reading, note, place, trouble)
      else
         samples = samples_t(columns == 3, data(:, 1), data(:, 2), pack(data(:, 3:), .true.))
      end if
      if (.not. allocated(trouble)) then
         call fit_material(fit, wanted, int(terms), fixed, samples, trouble)
         if (allocated(trouble)) trouble%message = place//': '//trouble%message
      end if
      if (.not. allocated(trouble)) then
         fit%data%name = fortran(name)
         json = c_text(fit_json(fit, samples, material_text(fit%data, density, &
            min(0.5_wp, poisson_ratio), samples%first_time(), samples%last_time(), samples%keys)))
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_fit_data

   !> Read moduli from the text of a data file like `vcor fit`, in SI units
   function vcor_read_moduli(text, name, poisson_ratio, n, columns, values, error) bind(c) &
      result(code)
      !> The text, and the name of the file for messages
      type(c_ptr), value :: text, name
      !> Poisson's ratio [-] for shear moduli; above 0.5: unknown
      real(c_double), value :: poisson_ratio
      !> Number of samples, and of columns, 2 or 3 as in `vcor_fit_data`
      integer(c_int), intent(out) :: n, columns
      !> The columns, one after the other; the caller releases them with free()
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
      columns = 0
      values = c_null_ptr
!$omp critical (vcor_c_api)
      allocate (reading%units(0))
      reading%poisson_ratio = poisson_ratio
      call read_samples_text(samples, fortran(text), fortran(name), reading, note, place, trouble)
      if (.not. allocated(trouble)) then
         n = size(samples%at)
         columns = merge(3, 2, samples%dynamic)
         values = c_numbers([samples%at, samples%modulus, samples%loss])
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_read_moduli

   !> Whether the seal of a file does not match its contents: HDF5 may crash reading such a file
   function vcor_is_altered(file) bind(c) result(yes)
      !> Name of the file
      type(c_ptr), value :: file
      !> 1 or 0
      integer(c_int) :: yes

!$omp critical (vcor_c_api)
      yes = merge(1_c_int, 0_c_int, is_altered(fortran(file), cut_counts=.false.))
!$omp end critical (vcor_c_api)
   end function vcor_is_altered

end module vcor_c_api_fit
