!> The cases of a command, read and ready to run
module vcor_app_job
   use vcor_app_cli, only : request_t
   use vcor_app_files, only : files_t, name_files
   use vcor_rounded, only : significant
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, key_t, real_key
   use vcor_case_checks, only : validate
   use vcor_case_grid, only : grid_t
   use vcor_case_mechanics, only : method_of
   use vcor_case_values, only : range_message
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_case_reader, only : add_materials, override, read_case
   use vcor_io_data_file, only : data_file, modes_file, read_data
   use vcor_io_path, only : same_file
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, printable
   use vcor_words, only : contains_word, suggestion
   use vcor_sweep_quantity, only : quantity_names
   use vcor_sweep_points, only : new_sweep, solve_point, sweep_t, worker_t
   implicit none
   private

   public :: job_t, window_t, prepare, find_window, file_read

   !> A case of a command, ready to run
   type :: job_t
      type(case_t) :: case
      !> Its impacts
      type(sweep_t) :: sweep
      character(len=:), allocatable :: method
      !> Its files
      type(files_t) :: files
   end type job_t

   !> The impact of a case, as needed by commands about materials: its contact time is the window of
   !> times that matter
   type :: window_t
      !> The case; for a sweep its first point, which represents all
      type(case_t) :: case
      !> Contact time [s]; 0 if the impact has no result
      real(wp) :: contact_time = 0.0_wp
      !> Coefficient of restitution [-], if there is a contact time
      real(wp) :: cor = 0.0_wp
      !> Contact time, or without a result the time of a typical impact [s]
      real(wp) :: reference = 1.0e-3_wp
      !> Notes, one per line
      character(len=:), allocatable :: notes
   end type window_t

contains

   !> Read, override, validate and build all cases of a request
   subroutine prepare(request, jobs, error)
      type(request_t), intent(in) :: request
      !> The cases, shape (files of the request)
      type(job_t), allocatable, intent(out) :: jobs(:)
      type(error_t), allocatable, intent(out) :: error

      integer :: i, j

      call read_cases(request, jobs, error)
      if (allocated(error)) return
      do i = 1, size(jobs)
         associate (job => jobs(i))
            do j = 1, size(request%settings)
               if (.not. allocated(error)) call override(job%case, request%settings(j)%text, &
                  error, option='--set')
            end do
            if (.not. allocated(error)) call validate(job%case, error)
            if (.not. allocated(error)) call read_data(job%case, error)
            if (.not. allocated(error)) call new_sweep(job%sweep, job%case, error, &
               all_materials=request%command == 'material')
            if (allocated(error)) return
            if (request%command == 'verify' .and. job%sweep%is_grid()) call job%case%refuse( &
               'sweep', 'parameter', 1, 'verify takes single impacts, found a &sweep group', error)
            if (.not. allocated(error)) call check_names(request, job%sweep%grid, error)
            job%method = trim(method_of(job%case))
            if (.not. allocated(error)) call name_files(request, job%case, job%sweep%grid, &
               size(jobs) == 1, job%files, error)
         end associate
         do j = 1, i
            if (.not. allocated(error)) call refuse_clash(jobs(i), jobs(j), i == j, error)
         end do
         if (allocated(error)) return
      end do
   end subroutine prepare

   !> Add to the error of a file that is no case which command reads it, by the end of its name
   subroutine name_command(path, error)
      character(len=*), intent(in) :: path
      !> The error, of code `error_input` where the file has been read
      type(error_t), allocatable, intent(inout) :: error

      if (error%code /= error_input) return
      select case (path(max(index(path, '.', back=.true.), 1):))
      case ('.h5')
         error%message = error%message//'; vcor plot draws files of results'
      case ('.xlsx', '.csv', '.tsv', '.txt', '.dat', '.lvm')
         error%message = error%message//'; vcor fit, master, identify and table read data'
      case default
         continue
      end select
   end subroutine name_command

   !> Read the files of a request: the cases, each completed by files of materials after it
   subroutine read_cases(request, jobs, error)
      type(request_t), intent(in) :: request
      !> The cases, without overrides
      type(job_t), allocatable, intent(out) :: jobs(:)
      type(error_t), allocatable, intent(out) :: error

      type(case_t) :: cases(size(request%files))
      logical :: completes(size(request%files))
      integer :: i, j

      do i = 1, size(cases)
         call read_case(cases(i), request%files(i)%text, error)
         if (allocated(error)) then
            call name_command(request%files(i)%text, error)
            return
         end if
         completes(i) = cases(i)%is_materials()
      end do
      if (size(cases) > 1 .and. completes(1)) then
         call raise(error, error_usage, request%files(1)%text//': a file with nothing but ' &
            //'&material groups completes the cases before it, expected a case first')
         return
      end if
      completes(1) = .false.
      allocate (jobs(count(.not. completes)))
      do i = 1, size(cases)
         if (completes(i)) then
            do j = 1, count(.not. completes(:i))
               call add_materials(jobs(j)%case, cases(i))
            end do
         else
            jobs(count(.not. completes(:i)))%case = cases(i)
         end if
      end do
   end subroutine read_cases

   !> Check that names of --print with a dot are swept parameters
   subroutine check_names(request, grid, error)
      type(request_t), intent(in) :: request
      type(grid_t), intent(in) :: grid
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: known
      integer :: i, j

      known = quantity_names()
      do j = 1, size(grid%axes)
         known = known//' '//grid%axes(j)%name
      end do
      do i = 1, size(request%names)
         if (contains_word(known, request%names(i)%text)) cycle
         if (index(request%names(i)%text, '.') > 0 .and. size(grid%axes) == 0) then
            call raise(error, error_usage, "found '"//printable(request%names(i)%text) &
               //"' in --print, but the case sweeps nothing: its values are those that vcor " &
               //"check prints; expected names of columns (vcor help output)")
            return
         end if
         call raise(error, error_usage, "unknown name '"//printable(request%names(i)%text) &
            //"' in --print; "//suggestion(request%names(i)%text, known))
         return
      end do
   end subroutine check_names

   !> Refuse files of a case that are files of another case, or files that are read
   subroutine refuse_clash(new, old, is_same, error)
      type(job_t), intent(in) :: new
      !> A case that is not later
      type(job_t), intent(in) :: old
      logical, intent(in) :: is_same
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, j

      call refuse_inputs(new, old)
      if (is_same .or. allocated(error)) return
      call refuse_inputs(old, new)
      do i = 1, size(new%files%writes)
         do j = 1, size(old%files%writes)
            if (allocated(error)) return
            if (.not. (new%files%writes(i) .and. old%files%writes(j))) cycle
            if (same_file(new%files%name(i), old%files%name(j))) call raise(error, error_input, &
               new%case%source//': its files would replace those of '//old%case%source &
               //': give one of them another output.stem')
         end do
      end do

   contains

      !> Refuse to write a file that is read
      subroutine refuse_inputs(writer, reader)
         type(job_t), intent(in) :: writer, reader

         character(len=:), allocatable :: path, kind

         do i = 0, size(writer%files%writes)
            path = writer%files%part
            if (i > 0) path = writer%files%name(i)
            if (path == '') cycle
            path = file_read(reader%case, path)
            kind = trim(merge('case', 'data', path == reader%case%source))
            if (path /= '') call raise(error, error_input, writer%case%source//': its results ' &
               //'would replace the '//kind//' file '//path//': give it another output.stem')
            if (allocated(error)) return
         end do
      end subroutine refuse_inputs
   end subroutine refuse_clash

   !> The file of a case to which a name leads
   function file_read(case, name) result(path)
      type(case_t), intent(in) :: case
      !> Name of a file
      character(len=*), intent(in) :: name
      !> The case file, or a file of its materials or of its structure; empty if it is none of them
      character(len=:), allocatable :: path

      integer :: i

      path = case%source
      if (same_file(name, path)) return
      do i = 1, case%count('material')
         path = case%source_of(i)
         if (same_file(name, path)) return
         path = data_file(case, i)
         if (same_file(name, path)) return
         path = data_file(case, i, 'shift_file')
         if (same_file(name, path)) return
      end do
      path = modes_file(case)
      if (same_file(name, path)) return
      path = ''
   end function file_read

   !> Solve the impact of a case, for a sweep that of the first point
   subroutine find_window(job, window, error)
      type(job_t), intent(in) :: job
      type(window_t), intent(out) :: window
      !> Error of code `error_input`, unallocated on success, even without a result
      type(error_t), allocatable, intent(out) :: error

      !> Contact time divided by the time scale of Hertz's impact, about
      real(wp), parameter :: hertz = 3.0_wp
      type(worker_t) :: worker
      type(outcome_t) :: outcome
      type(error_t), allocatable :: trouble
      character(len=:), allocatable :: message
      type(key_t) :: key
      integer :: i

      window%case = job%sweep%grid%case_at(job%case, 1)
      window%notes = ''
      do i = 1, size(job%sweep%grid%axes)
         associate (axis => job%sweep%grid%axes(i))
            key = catalogue(window%case%row(axis%address))
            if (axis%address%element > 0) key%value_kind = real_key
            message = range_message(key, window%case%entry(axis%address))
            if (message /= '') then
               call raise(error, error_input, axis%name//': '//message)
               return
            end if
            window%notes = window%notes//'  note: the case varies '//axis%name//', here it is ' &
               //significant(axis%values(1), 8, 0)//new_line('a')
         end associate
      end do
      call solve_point(job%sweep, 1, worker, outcome, trouble)
      if (allocated(trouble)) then
         window%notes = window%notes//'  note: the impact cannot be solved ('//trouble%message &
            //'): its window is not known'//new_line('a')
      else if (outcome%status /= contact_separated) then
         window%reference = hertz*worker%problem%impact%time_scale()
         window%notes = window%notes//'  note: the impact does not end in separation: its window ' &
            //'is not known'//new_line('a')
      else
         window%contact_time = outcome%contact_time
         window%reference = outcome%contact_time
         window%cor = outcome%cor
      end if
   end subroutine find_window

end module vcor_app_job
