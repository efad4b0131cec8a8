!> A material of a case in place of measured data
module vcor_app_sampling
   use vcor_app_cli, only : request_t
   use vcor_app_job, only : job_t, prepare
   use vcor_app_window, only : find_window, window_t
   use vcor_case_problem, only : material_of_case, solve_case
   use vcor_case_case, only : case_t
   use vcor_case_identified, only : put_material
   use vcor_case_address, only : material_names
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_fit, only : moduli_of, samples_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_text, only : integer_text, printable
   use vcor_io_path, only : file_exists
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t
   use vcor_words, only : suggestion
   use vcor_material_moduli, only : sampled_times, time_range_t
   implicit none
   private

   public :: sampled_t, sample_model, compare_impacts

   !> Decades before and after the contact time that are sampled unless the user says otherwise
   integer, parameter :: before = 5, after = 1

   !> What was sampled
   type :: sampled_t
      !> The impact of the case
      type(window_t) :: window
      !> Number of the material in the case
      integer :: item = 0
      class(material_t), allocatable :: material
   end type sampled_t

contains

   !> Sample a material of a case
   subroutine sample_model(request, source, dynamic, sampled, samples, note, error)
      type(request_t), intent(in) :: request
      !> CASE.nml or CASE.nml:MATERIAL
      character(len=*), intent(in) :: source
      logical, intent(in) :: dynamic
      type(sampled_t), intent(out) :: sampled
      type(samples_t), intent(out) :: samples
      !> What they are, in words
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
      samples%dynamic = dynamic
      if (samples%dynamic) range = time_range_t(1.0_wp/range%last, 1.0_wp/range%first, range%points)
      samples%at = sampled_times(range)
      n = size(samples%at)
      allocate (samples%modulus(n), samples%loss(merge(n, 0, dynamic)))
      moduli = moduli_of(sampled%material, samples)
      samples%modulus = moduli(:n)
      samples%loss = moduli(n + 1:)
      note = integer_text(n)//' samples of '//printable(sampled%material%name)//', '
      if (dynamic) then
         note = note//'angular frequency [rad/s], storage modulus [Pa], loss modulus [Pa]'
      else
         note = note//'time [s], relaxation modulus [Pa]'
      end if
      if (.not. all(moduli > tiny(1.0_wp))) call raise(error, error_input, filename//': the ' &
         //'modulus vanishes in the range of the samples, expected a narrower one (--from, --to)')
   end subroutine sample_model

   !> Take CASE.nml:NAME apart; a file of this name is a case
   subroutine take_name(source, filename, name)
      !> What the user gave
      character(len=*), intent(in) :: source
      character(len=:), allocatable, intent(out) :: filename
      !> The material, empty where none is named
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

   !> Find the material: the one that is named, else that of the plate unless it is rigid
   subroutine find_material(sampled, filename, name, error)
      !> What is sampled, its case set
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

   !> The impact of the case with the material that was sampled and with the one that was found
   function compare_impacts(sampled, data) result(text)
      type(sampled_t), intent(in) :: sampled
      type(material_data_t), intent(in) :: data
      !> Line, or nothing where the impact has no result
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
         text = '  the impact of the case cannot be solved with the fit'//new_line('a')
      else if (outcome%status /= contact_separated) then
         text = '  the impact of the case does not end in separation with the fit'//new_line('a')
      else
         write (line, '(a, f10.7, a, f10.7, a, es9.1)') '  cor of the impact   ', &
            sampled%window%cor, '  with the fit ', outcome%cor, '  difference ', &
            outcome%cor - sampled%window%cor
         text = trim(line)//new_line('a')
      end if
   end function compare_impacts

end module vcor_app_sampling
