!> Options of `vcor fit`
module vcor_app_fit_options
   use vcor_app_argument, only : has_word
   use vcor_app_option_value, only : read_number, read_positive, read_whole
   use vcor_error, only : error_t, error_usage, raise
   use vcor_fit, only : estimate_t, fixable_parameters
   use vcor_material, only : identifiable_models
   use vcor_io_sample_file, only : reading_t
   use vcor_io_units, only : frequency_units, modulus_units, time_units
   use vcor_kinds, only : wp
   use vcor_words, only : suggestion
   use vcor_text, only : printable
   implicit none
   private

   public :: fit_request_t, apply_fit_option, check_fit

   !> Most terms of --terms
   integer, parameter :: most_terms = 60
   !> A Poisson's ratio that was not given
   real(wp), parameter :: no_ratio = 1.0_wp

   !> What is to be fitted
   type :: fit_request_t
      character(len=:), allocatable :: model
      !> Terms of a Prony series; 0: as many as the data support
      integer :: terms = 0
      !> Parameters that are given, shape (n)
      type(estimate_t), allocatable :: fixed(:)
      !> Units of the columns, separated by commas; unallocated: the file tells
      character(len=:), allocatable :: units
      !> Whether the moduli are shear moduli
      logical :: shear = .false.
      !> Poisson's ratio [-]; 1: not given
      real(wp) :: poisson_ratio = no_ratio
      !> Density [kg/m3]; 0: not given
      real(wp) :: density = 0.0_wp
      !> Name of the material; unallocated: made from that of the file
      character(len=:), allocatable :: name
      !> Case, and perhaps material, to be sampled in place of data
      character(len=:), allocatable :: source
      !> Whether storage and loss modulus are sampled
      logical :: dynamic = .false.
   end type fit_request_t

contains

   !> Take the value of an option of fit
   subroutine apply_fit_option(option, value, request, error)
      !> Option, one of those that fit alone has, with a value
      character(len=*), intent(in) :: option
      !> Its value, not blank
      character(len=*), intent(in) :: value
      type(fit_request_t), intent(inout) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: expected = 'a number in (-1, 0.5]'

      select case (option)
      case ('--model')
         request%model = trim(adjustl(value))
         if (has_word(identifiable_models, request%model)) return
         call raise(error, error_usage, "--model: found '"//printable(request%model) &
            //"', expected one of "//commas(identifiable_models)//'; ' &
            //suggestion(request%model, identifiable_models))
      case ('--terms')
         call read_whole(option, value, 1, most_terms, request%terms, error)
      case ('--fix')
         call add_fixed(value, request, error)
      case ('--units')
         request%units = trim(adjustl(value))
      case ('--poisson-ratio')
         call read_number(option, value, expected, request%poisson_ratio, error)
         if (allocated(error)) return
         if (.not. (request%poisson_ratio > -1.0_wp .and. request%poisson_ratio <= 0.5_wp)) &
            call raise(error, error_usage, option//': found '//printable(value)//', expected ' &
            //expected)
      case ('--density')
         call read_positive(option, value, request%density, error)
      case ('--name')
         request%name = trim(adjustl(value))
      case default
         request%source = value
      end select
   end subroutine apply_fit_option

   !> Words with commas between them
   pure function commas(words) result(text)
      !> Words separated by blanks
      character(len=*), intent(in) :: words
      !> The same with commas
      character(len=:), allocatable :: text

      integer :: i

      text = ''
      do i = 1, len(words)
         if (words(i:i) == ' ') text = text//','
         text = text//words(i:i)
      end do
   end function commas

   !> Take KEY=VALUE of --fix
   subroutine add_fixed(value, request, error)
      !> KEY=VALUE
      character(len=*), intent(in) :: value
      type(fit_request_t), intent(inout) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(estimate_t) :: parameter
      integer :: mark

      if (.not. allocated(request%fixed)) allocate (request%fixed(0))
      mark = index(value, '=')
      if (mark < 2) then
         call raise(error, error_usage, "--fix: found '"//printable(value) &
            //"', expected KEY=VALUE, such as --fix exponent=0.5")
         return
      end if
      parameter%name = adjustl(value(:mark - 1))
      call read_number('--fix '//printable(value(:mark - 1)), value(mark + 1:), 'a number', &
         parameter%value, error)
      if (.not. allocated(error)) request%fixed = [request%fixed, parameter]
   end subroutine add_fixed

   !> Check the options of fit against each other, and fill in the defaults
   subroutine check_fit(request, files, reading, error)
      type(fit_request_t), intent(inout) :: request
      !> Number of data files
      integer, intent(in) :: files
      !> What the options say about the file
      type(reading_t), intent(out) :: reading
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, k

      if (.not. allocated(request%model)) request%model = 'prony'
      if (.not. allocated(request%fixed)) allocate (request%fixed(0))
      if (allocated(request%source)) then
         if (files > 0) then
            call raise(error, error_usage, '--from-model takes the place of a data file, found ' &
               //'both')
         else if (allocated(request%units) .or. request%shear) then
            call raise(error, error_usage, '--units and --shear are for data files, found ' &
               //'--from-model')
         end if
      else if (files /= 1) then
         call raise(error, error_usage, 'fit takes one data file, or --from-model CASE.nml')
      else if (request%dynamic) then
         call raise(error, error_usage, '--dynamic is for --from-model; data tell by their ' &
            //'columns, or by --units, what they are')
      end if
      if (allocated(error)) return
      if (request%terms > 0 .and. request%model /= 'prony') then
         call raise(error, error_usage, '--terms is for --model prony, found ' &
            //'--model '//request%model)
         return
      end if
      do i = 1, size(request%fixed)
         associate (fixed => request%fixed(i))
            if (.not. has_word(fixable_parameters(request%model), trim(fixed%name))) then
               call raise(error, error_usage, "--fix: found '"//printable(trim(fixed%name)) &
                  //"', expected a parameter of model "//request%model//': ' &
                  //commas(fixable_parameters(request%model)))
            else if (.not. in_range(fixed, request%model)) then
               call raise(error, error_usage, '--fix: the value of '//trim(fixed%name) &
                  //' is out of range, expected '//range_of(fixed, request%model))
            end if
            do k = 1, i - 1
               if (request%fixed(k)%name == fixed%name) call raise(error, error_usage, &
                  '--fix: '//trim(fixed%name)//' is given twice')
            end do
         end associate
         if (allocated(error)) return
      end do
      if (request%model == 'sls' .and. value_of('alpha') > value_of('beta')) &
         call raise(error, error_usage, '--fix: found alpha above beta, expected alpha <= beta: ' &
         //'the rubbery modulus is glassy_modulus*alpha/beta')
      if (allocated(error)) return
      reading%shear = request%shear
      reading%poisson_ratio = request%poisson_ratio
      allocate (reading%units(0))
      if (allocated(request%units)) call take_units(request%units, reading, error)

   contains

      !> Value that is given for a parameter
      pure function value_of(name) result(value)
         !> Name of the parameter
         character(len=*), intent(in) :: name
         !> Its value; that of alpha is 0 and that of others is huge where none is given
         real(wp) :: value

         integer :: j

         value = merge(0.0_wp, huge(1.0_wp), name == 'alpha')
         do j = 1, size(request%fixed)
            if (request%fixed(j)%name == name) value = request%fixed(j)%value
         end do
      end function value_of
   end subroutine check_fit

   !> Values that a parameter may have
   pure function range_of(parameter, model) result(text)
      type(estimate_t), intent(in) :: parameter
      !> Model that it belongs to
      character(len=*), intent(in) :: model
      !> In words
      character(len=:), allocatable :: text

      select case (parameter%name)
      case ('exponent')
         text = 'a number in (0, 1)'
         if (model == 'mittag_leffler') text = 'a number in (0, 1]'
      case ('equilibrium_modulus', 'alpha')
         text = 'a number >= 0, at most 1e30'
      case default
         text = 'a number > 0, at most 1e30'
      end select
   end function range_of

   !> Whether a parameter has a value that it may have
   pure function in_range(parameter, model) result(yes)
      type(estimate_t), intent(in) :: parameter
      !> Model that it belongs to
      character(len=*), intent(in) :: model
      !> Whether it has
      logical :: yes

      real(wp), parameter :: largest = 1.0e30_wp, smallest = 1.0e-30_wp

      yes = parameter%value >= smallest .and. parameter%value <= largest
      if (parameter%name == 'exponent') yes = yes .and. (parameter%value < 1.0_wp &
         .or. model == 'mittag_leffler' .and. parameter%value <= 1.0_wp)
      if (parameter%name == 'equilibrium_modulus' .or. parameter%name == 'alpha') &
         yes = yes .or. .not. abs(parameter%value) > 0.0_wp
   end function in_range

   !> Take the units of --units: time and modulus, or frequency and one or two moduli
   subroutine take_units(list, reading, error)
      !> Units with commas between them
      character(len=*), intent(in) :: list
      !> What the options say about the file
      type(reading_t), intent(inout) :: reading
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=len(reading%units)) :: words(3)
      integer :: first, last, n, i
      logical :: good

      n = 0
      first = 1
      words = ''
      good = .true.
      do while (first <= len(list) + 1 .and. good)
         last = first + index(list(first:)//',', ',') - 2
         n = n + 1
         good = n <= 3
         if (good) words(n) = adjustl(list(first:last))
         first = last + 2
      end do
      good = good .and. n >= 2
      if (good) then
         do i = 2, n
            good = good .and. has_word(modulus_units, trim(words(i)))
         end do
         if (has_word(time_units, trim(words(1)))) then
            good = good .and. n == 2
         else
            good = good .and. has_word(frequency_units, trim(words(1)))
            if (n == 2) words(3) = words(2)
            n = 3
         end if
      end if
      if (.not. good) then
         call raise(error, error_usage, "--units: found '"//printable(list)//"', expected " &
            //'TIME,MODULUS or FREQUENCY,MODULUS, such as s,MPa or Hz,MPa; units of time are ' &
            //commas(time_units)//', of frequency '//commas(frequency_units)//', of modulus ' &
            //commas(modulus_units))
         return
      end if
      reading%units = words(:n)
   end subroutine take_units

end module vcor_app_fit_options
