!> The command fit: identification of a material from data, or from another model
module vcor_app_fit
   use vcor_app_cli, only : request_t
   use vcor_app_job, only : file_read, find_window, job_t, prepare, window_t
   use vcor_app_screen, only : percent, short, significant
   use vcor_case_address, only : material_names
   use vcor_case_case, only : case_t
   use vcor_case_identified, only : material_text, put_material
   use vcor_case_problem, only : material_of_case, solve_case
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_fit, only : check_fixed, fit_material, fit_t, moduli_of, samples_t, state_bound, &
      state_fixed, unseen_earlier, unseen_later
   use vcor_fit_result, only : fit_json, parameter_name, shift_note
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_file, only : write_file, write_stdout
   use vcor_io_path, only : directory_exists, file_exists, folder_of, join_path, make_directory, &
      same_file
   use vcor_io_sample_file, only : read_samples, standard_input
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t
   use vcor_material_moduli, only : sampled_times, time_range_t
   use vcor_text, only : integer_text, printable, text_flaw
   use vcor_version, only : version
   use vcor_words, only : suggestion
   implicit none
   private

   public :: fit_data

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Message about systematic misfits
   character(len=*), parameter :: systematic = 'the model does not follow the data: its misfits ' &
      //'are no noise'

   !> Poisson's ratio if none is given: that of rubber, which is incompressible
   real(wp), parameter :: incompressible = 0.5_wp

   !> Decades before and after the contact time that are sampled by default
   integer, parameter :: before = 5, after = 1

   !> A sampled material
   type :: sampled_t
      !> The impact of the case
      type(window_t) :: window
      !> Index of the material in the case
      integer :: item = 0
      class(material_t), allocatable :: material
   end type sampled_t

contains

   !> Fit a model, show it and write it
   subroutine fit_data(request, error)
      type(request_t), intent(in) :: request
      type(error_t), allocatable, intent(out) :: error

      type(sampled_t) :: sampled
      type(samples_t) :: samples
      type(fit_t) :: fit
      character(len=:), allocatable :: source, place, note, path, group, remarks, tail
      real(wp) :: density, poisson_ratio

      call check_options(request, error)
      if (allocated(error)) return
      if (allocated(request%source)) then
         source = request%source
         place = printable(source)
         call sample_model(request, source, sampled, samples, note, error)
      else
         source = request%files(1)%text
         call read_samples(samples, source, request%reading, note, place, error)
         if (source == standard_input) source = 'stdin'
      end if
      if (allocated(error)) return
      call fit_material(fit, request%model, request%terms, request%fixed, samples, error)
      if (allocated(error)) then
         error%message = place//': '//error%message
         return
      end if

      density = request%density
      poisson_ratio = incompressible
      fit%data%name = stem_of(source)
      tail = ''
      if (allocated(request%source)) then
         fit%data%name = sampled%material%name
         if (.not. density > 0.0_wp) density = sampled%material%density()
         poisson_ratio = sampled%material%poisson_ratio()
         tail = sampled%window%notes//compare_impacts(sampled, fit%data)
      end if
      if (allocated(request%name)) fit%data%name = request%name
      if (text_flaw(fit%data%name) /= '') call raise(error, error_usage, &
         'the name of the material: '//text_flaw(fit%data%name)//'; give another one with --name')
      if (allocated(error)) return
      if (request%reading%poisson_ratio <= incompressible) &
         poisson_ratio = request%reading%poisson_ratio
      remarks = fit_remarks(fit, printable(source)//place_of_shift(sampled), samples)
      group = material_text(fit%data, density, poisson_ratio, samples%first_time(), &
         samples%last_time(), samples%keys)
      path = ''
      if (allocated(request%directory)) then
         call choose_path(request%directory, source, sampled, path, error)
         if (.not. allocated(error)) call write_file(path, remarks//group, error)
         if (allocated(error)) return
         tail = tail//'  written '//path//nl
      end if
      if (allocated(request%json)) then
         if (same_file(request%json, path)) call raise(error, error_usage, &
            '--json and --output are the same file '//printable(path))
         if (.not. allocated(error)) call refuse_input_file(request%json, source, sampled, error)
         if (.not. allocated(error)) call make_directory(folder_of(request%json), error)
         if (.not. allocated(error)) &
            call write_file(request%json, fit_json(fit, samples, group), error)
         if (allocated(error)) return
         tail = tail//'  written '//request%json//nl
      end if
      if (request%quiet) return
      if (.not. (request%reading%poisson_ratio <= incompressible .or. allocated(request%source))) &
         tail = tail//'  note: poisson_ratio is taken as 0.5, --poisson-ratio gives another' &
         //nl
      if (.not. density > 0.0_wp) tail = tail//'  note: the density is not known, --density ' &
         //'gives it'//nl
      call write_stdout(fit_report(fit, source, note, samples, tail)//remarks//group, error)
   end subroutine fit_data

   !> Check that the options of fit are compatible
   subroutine check_options(request, error)
      type(request_t), intent(in) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      logical :: samples

      samples = allocated(request%source)
      if (samples .and. size(request%files) > 0) then
         call raise(error, error_usage, '--from-model takes the place of a data file, found both')
      else if (samples .and. (size(request%reading%units) > 0 .or. request%reading%shear)) then
         call raise(error, error_usage, '--units and --shear are for data files, found ' &
            //'--from-model')
      else if (.not. samples .and. size(request%files) /= 1) then
         call raise(error, error_usage, 'fit takes one data file, or --from-model CASE.nml')
      else if (.not. samples .and. request%dynamic) then
         call raise(error, error_usage, '--dynamic is for --from-model; data tell by their ' &
            //'columns, or by --units, what they are')
      else if (request%terms > 0 .and. request%model /= 'prony') then
         call raise(error, error_usage, '--terms is for --model prony, found --model ' &
            //request%model)
      end if
      if (allocated(error)) return
      call check_fixed(request%model, request%fixed, error)
      if (allocated(error)) then
         error%message = '--fix: '//error%message
      else if (.not. samples .and. (max(request%range%first, request%range%last) > 0.0_wp &
               .or. request%range%points > 0 .or. size(request%settings) > 0)) then
         call raise(error, error_usage, '--from, --to, --points and --set are for --from-model')
      end if
   end subroutine check_options

   !> Choose the file of the group, --output or a file in that directory, but none that was read
   subroutine choose_path(output, source, sampled, path, error)
      !> Value of --output
      character(len=*), intent(in) :: output
      !> The data file or the case
      character(len=*), intent(in) :: source
      !> The sampled material, if any
      type(sampled_t), intent(in) :: sampled
      character(len=:), allocatable, intent(out) :: path
      !> Error of code `error_input` if the file was read; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: name
      integer :: mark

      path = trim(output)
      call refuse_input_file(path, source, sampled, error)
      if (allocated(error)) return
      name = path(len(folder_of(path)) + 1:)
      mark = index(name, '.', back=.true.)
      if (directory_exists(path)) mark = 0
      if (mark < 2) then
         call make_directory(path, error)
         path = join_path(path, stem_of(source)//'_fit.nml')
      else if (name(mark:) == '.nml') then
         call make_directory(folder_of(path), error)
      else
         call raise(error, error_usage, "unknown format '"//printable(name(mark + 1:))//"' of '" &
            //printable(path)//"'; expected .nml; the name of a folder ends with a slash")
      end if
      if (.not. allocated(error)) call refuse_input_file(path, source, sampled, error)
   end subroutine choose_path

   !> Refuse the name of a file that was read
   subroutine refuse_input_file(name, source, sampled, error)
      !> Name of a file to be written
      character(len=*), intent(in) :: name
      !> The data file or the case
      character(len=*), intent(in) :: source
      !> The sampled material, if any
      type(sampled_t), intent(in) :: sampled
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      logical :: taken

      if (sampled%item == 0) then
         taken = same_file(name, source)
      else
         taken = file_read(sampled%window%case, name) /= ''
      end if
      if (taken) call raise(error, error_input, printable(source)//': the fit would replace ' &
         //name//', which is read: give another name')
   end subroutine refuse_input_file

   !> Name of a file without directory and ending
   pure function stem_of(path) result(stem)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: stem

      integer :: mark

      stem = trim(path(index(path, '/', back=.true.) + 1:))
      mark = index(stem, '.', back=.true.)
      if (mark > 1) stem = stem(:mark - 1)
   end function stem_of

   !> Sample a material of a case
   subroutine sample_model(request, source, sampled, samples, note, error)
      type(request_t), intent(in) :: request
      !> CASE.nml or CASE.nml:MATERIAL
      character(len=*), intent(in) :: source
      type(sampled_t), intent(out) :: sampled
      type(samples_t), intent(out) :: samples
      !> Description of the samples
      character(len=:), allocatable, intent(out) :: note
      type(error_t), allocatable, intent(out) :: error

      type(request_t) :: reading
      type(job_t), allocatable :: jobs(:)
      type(time_range_t) :: range
      character(len=:), allocatable :: filename, name
      real(wp), allocatable :: moduli(:)
      integer :: n

      call take_name(source, filename, name)
      reading = request
      deallocate (reading%files)
      allocate (reading%files(1))
      reading%files(1)%text = filename
      call prepare(reading, jobs, error)
      if (.not. allocated(error)) call find_window(jobs(1), sampled%window, error)
      if (.not. allocated(error)) call find_material(sampled, filename, name, error)
      if (allocated(error)) return

      range = request%range
      associate (reference => log10(sampled%window%reference))
         if (.not. range%first > 0.0_wp) range%first = 10.0_wp**(floor(reference) - before)
         if (.not. range%last > 0.0_wp) range%last = 10.0_wp**(ceiling(reference) + after)
      end associate
      if (.not. range%first < range%last) then
         call raise(error, error_usage, 'expected --from before --to')
         return
      end if
      samples%dynamic = request%dynamic
      if (samples%dynamic) range = time_range_t(1.0_wp/range%last, 1.0_wp/range%first, range%points)
      samples%at = sampled_times(range)
      n = size(samples%at)
      allocate (samples%modulus(n), samples%loss(merge(n, 0, samples%dynamic)))
      moduli = moduli_of(sampled%material, samples)
      samples%modulus = moduli(:n)
      samples%loss = moduli(n + 1:)
      note = integer_text(n)//' samples of '//printable(sampled%material%name) &
         //place_of_shift(sampled)//', '
      if (samples%dynamic) then
         note = note//'angular frequency [rad/s], storage modulus [Pa], loss modulus [Pa]'
      else
         note = note//'time [s], relaxation modulus [Pa]'
      end if
      if (.not. all(moduli > tiny(1.0_wp))) call raise(error, error_input, filename//': the ' &
         //'modulus vanishes in the range of the samples, expected a narrower one (--from, --to)')
   end subroutine sample_model

   !> Temperature of a sampled material that is shifted from its constants, ' at 303.15 K', because
   !> the fit has no shift
   function place_of_shift(sampled) result(text)
      type(sampled_t), intent(in) :: sampled
      !> The text; empty for other materials and for data
      character(len=:), allocatable :: text

      text = ''
      if (.not. allocated(sampled%material)) return
      if (.not. abs(sampled%material%time_factor - 1.0_wp) > 0.0_wp) return
      associate (case => sampled%window%case)
         text = ' at '//trim(adjustl(significant(case%number(case%address('impact', &
            'temperature')), 7)))//' K'
      end associate
   end function place_of_shift

   !> Split CASE.nml:NAME; an existing file of that name is a case
   subroutine take_name(source, filename, name)
      !> Argument of the option
      character(len=*), intent(in) :: source
      character(len=:), allocatable, intent(out) :: filename
      !> The material; empty if none is named
      character(len=:), allocatable, intent(out) :: name

      integer :: mark

      filename = source
      name = ''
      if (file_exists(source)) return
      mark = index(source, ':', back=.true.)
      if (mark < 2) return
      filename = source(:mark - 1)
      name = source(mark + 1:)
   end subroutine take_name

   !> Find the material: the named one, otherwise the plate's if it relaxes, or the sphere's
   subroutine find_material(sampled, filename, name, error)
      !> The sampled material, its case set
      type(sampled_t), intent(inout) :: sampled
      character(len=*), intent(in) :: filename
      !> Name of the material, or empty
      character(len=*), intent(in) :: name
      !> Error of code `error_usage` if there is none, `error_input` if it does not relax;
      !> unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: other, model

      associate (case => sampled%window%case)
         other = name
         if (name == '') then
            call case%get('plate', 'material', other)
            call case%get('material', 'model', model, case%find_material(other))
            if (model == 'rigid' .or. model == 'elastic') &
               call case%get('sphere', 'material', other)
         end if
         sampled%item = case%find_material(other)
         if (sampled%item == 0) then
            call raise(error, error_usage, "--from-model: there is no material '" &
               //printable(other)//"' in "//printable(filename)//'; ' &
               //suggestion(other, material_names(case)))
            return
         end if
         call material_of_case(case, sampled%item, sampled%material, error)
         if (allocated(error)) return
      end associate
      associate (material => sampled%material)
         if (material%rigid .or. material%elastic()) then
            call raise(error, error_input, filename//": the material '"//printable(material%name) &
               //"' does not relax: nothing is there to be fitted")
         else if (material%viscosity > 0.0_wp) then
            call raise(error, error_input, filename//": the material '"//printable(material%name) &
               //"' has a dashpot in parallel (viscosity), expected one that relaxes only")
         end if
      end associate
   end subroutine find_material

   !> Compare the impact of the case with the sampled material and with the fitted one
   function compare_impacts(sampled, data) result(text)
      type(sampled_t), intent(in) :: sampled
      type(material_data_t), intent(in) :: data
      !> A line; empty if the impact has no result
      character(len=:), allocatable :: text

      type(case_t) :: case
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      character(len=96) :: line

      text = ''
      if (.not. sampled%window%contact_time > 0.0_wp) return
      case = sampled%window%case
      call put_material(case, sampled%item, data)
      call solve_case(case, outcome, error)
      if (allocated(error)) then
         text = '  the impact of the case cannot be solved with the fit'//nl
      else if (outcome%status /= contact_separated) then
         text = '  the impact of the case does not end in separation with the fit'//nl
      else
         write (line, '(a, f10.7, a, f10.7, a, es9.1)') '  cor of the impact   ', &
            sampled%window%cor, '  with the fit ', outcome%cor, '  difference ', &
            outcome%cor - sampled%window%cor
         text = trim(line)//nl
      end if
   end function compare_impacts

   !> Report of a fit
   function fit_report(fit, source, note, samples, tail) result(text)
      type(fit_t), intent(in) :: fit
      character(len=*), intent(in) :: source
      character(len=*), intent(in) :: note
      type(samples_t), intent(in) :: samples
      !> Notes and files, one per line
      character(len=*), intent(in) :: tail
      character(len=:), allocatable :: text

      integer :: i

      text = 'vcor '//version//'  '//printable(source)//nl//note//nl//nl//'  ' &
         //fit%data%model//terms_of(fit)//nl
      do i = 1, size(fit%parameters)
         text = text//line(fit, i)
      end do
      text = text//nl &
         //'  rms misfit          '//percent(fit%rms)//nl &
         //'  largest misfit      '//percent(fit%largest)//place_of(fit, samples)//nl &
         //'  band of the data    '//short(samples%first_time())//' to ' &
         //short(samples%last_time())//' s'
      if (samples%dynamic) text = text//', from '//short(samples%at(1))//' to ' &
         //short(samples%at(size(samples%at)))//' rad/s'
      text = text//nl
      if (fit%structured) text = text//'  note: '//systematic//', its standard errors mean ' &
         //'little'//nl
      if (shift_note(samples) /= '') text = text//'  note: '//shift_note(samples)//nl
      if (is_open(fit)) text = text//'  note: the modulus still falls where the data end: ' &
         //'equilibrium_modulus holds all that relaxes later'//nl
      text = text//tail//nl
   end function fit_report

   !> Comments before a group: the data of the fit, and its quality
   function fit_remarks(fit, source, samples) result(text)
      type(fit_t), intent(in) :: fit
      !> Source of the data, printable
      character(len=*), intent(in) :: source
      type(samples_t), intent(in) :: samples
      character(len=:), allocatable :: text

      integer :: i

      text = '! vcor '//version//' fit of '//fit%data%model//terms_of(fit)//' to ' &
         //source//nl &
         //'! rms misfit '//percent(fit%rms)//', largest ' &
         //percent(fit%largest)//place_of(fit, samples)//nl
      if (fit%structured) text = text//'! '//systematic//nl
      if (is_open(fit)) text = text//'! equilibrium_modulus is not seen: 0 to ' &
         //short(upper_limit(fit))//' Pa'//nl
      do i = 1, size(fit%parameters)
         associate (parameter => fit%parameters(i))
            if (parameter%state == state_bound) text = text//'! '//parameter_name(fit, i) &
               //' is at its bound: '//short(parameter%value)//' +- '//short(parameter%error) &
               //' '//trim(parameter%unit)//nl
         end associate
      end do
   end function fit_remarks

   !> Whether the equilibrium modulus of a series may be only what has not relaxed by the end of the
   !> data, of which later relaxation may leave nothing
   pure function is_open(fit) result(yes)
      type(fit_t), intent(in) :: fit
      logical :: yes

      associate (first => fit%parameters(1))
         yes = fit%data%model == 'prony' .and. first%unseen == unseen_later &
            .and. first%error < first%value
      end associate
   end function is_open

   !> Upper limit of the first parameter, three standard errors above its value
   pure function upper_limit(fit) result(value)
      type(fit_t), intent(in) :: fit
      real(wp) :: value

      value = fit%parameters(1)%value + 3.0_wp*fit%parameters(1)%error
   end function upper_limit

   !> Number of terms of a Prony series
   function terms_of(fit) result(text)
      type(fit_t), intent(in) :: fit
      !> In words; empty for other models
      character(len=:), allocatable :: text

      text = ''
      if (fit%data%model /= 'prony') return
      text = ', '//integer_text(size(fit%data%list('moduli')))//' terms'
      if (size(fit%data%list('moduli')) == 1) text = ', 1 term'
   end function terms_of

   !> Place of the largest misfit
   pure function place_of(fit, samples) result(text)
      type(fit_t), intent(in) :: fit
      type(samples_t), intent(in) :: samples
      character(len=:), allocatable :: text

      if (.not. samples%dynamic) then
         text = ' at '//short(fit%largest_at)//' s'
      else if (fit%largest_in_loss) then
         text = ' of the loss modulus at '//short(fit%largest_at)//' rad/s'
      else
         text = ' of the storage modulus at '//short(fit%largest_at)//' rad/s'
      end if
   end function place_of

   !> Condition for the validity of a standard error
   pure function condition(fit, i) result(text)
      type(fit_t), intent(in) :: fit
      integer, intent(in) :: i
      !> In words; empty if the data show all that matters
      character(len=:), allocatable :: text

      text = ' if the model holds '
      if (fit%data%model == 'prony') text = ' if nothing relaxes '
      select case (fit%parameters(i)%unseen)
      case (unseen_earlier)
         text = text//'earlier'
      case (unseen_later)
         text = text//'later'
      case default
         text = ''
      end select
   end function condition

   !> Line of a parameter
   function line(fit, i) result(text)
      type(fit_t), intent(in) :: fit
      integer, intent(in) :: i
      character(len=:), allocatable :: text

      character(len=24) :: name
      character(len=8) :: unit

      associate (parameter => fit%parameters(i))
         name = parameter_name(fit, i)
         unit = parameter%unit
         if (unit == '1') unit = ''
         text = '    '//name//significant(parameter%value)//' '//unit
         if (parameter%state == state_fixed) then
            text = text//'given'
         else if (i == 1 .and. is_open(fit)) then
            text = text//'not seen: 0 to '//short(upper_limit(fit))
         else
            text = text//'+- '//short(parameter%error)
            if (parameter%state == state_bound) text = text//', at its bound'
            ! not even the order of magnitude is known; for a value of 0 the error is a limit
            if (parameter%value > 0.0_wp .and. .not. parameter%error < parameter%value) then
               text = text//', the data do not determine it'
            else
               text = text//condition(fit, i)
            end if
         end if
      end associate
      text = text//nl
   end function line

end module vcor_app_fit
