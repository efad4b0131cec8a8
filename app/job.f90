!> The cases of a call, read and ready to run
module vcor_app_job
   use vcor_app_cli, only : request_t
   use vcor_app_screen, only : significant
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, key_t, real_key
   use vcor_case_checks, only : validate
   use vcor_case_grid, only : grid_t
   use vcor_case_unread, only : refuse_unread
   use vcor_case_values, only : range_message
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_case_reader, only : add_materials, override, read_case
   use vcor_io_data_file, only : data_file, read_data
   use vcor_io_path, only : directory_exists, folder_of, join_path, same_file
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, name_flaw, printable
   use vcor_words, only : contains_word, suggestion
   use vcor_solver, only : method_for
   use vcor_sweep_part, only : new_part, part_t
   use vcor_sweep_quantity, only : quantity_names
   use vcor_sweep_points, only : new_sweep, solve_point, sweep_t, worker_t
   implicit none
   private

   public :: job_t, window_t, prepare, find_window, file_read, name_files, directory_of, shard_text

   !> Letters of the longest ending
   integer, parameter :: longest_ending = 24

   !> One case of a call, ready to run
   type :: job_t
      type(case_t) :: case
      !> Its impacts
      type(sweep_t) :: sweep
      !> Those of them that are to be solved
      type(part_t) :: part
      !> Its impact where it has one only
      type(impact_t) :: impact
      character(len=:), allocatable :: method
      !> Directory and stem of its files
      character(len=:), allocatable :: path
      !> What the names of its files end with
      character(len=longest_ending), allocatable :: endings(:)
      !> Which of its files it writes, in the order of `endings`
      logical, allocatable :: writes(:)
      !> Whether there is a time history in them
      logical :: history = .true.
   contains
      procedure :: file, written, coordinates, case_at
   end type job_t

   !> The impact of a case as that on which commands about its materials look: its contact time
   !> tells what of them matters
   type :: window_t
      !> The case; of a sweep its first point, which stands for all of them
      type(case_t) :: case
      !> Contact time [s]; 0: the impact has no result
      real(wp) :: contact_time = 0.0_wp
      !> Coefficient of restitution [-], where there is a contact time
      real(wp) :: cor = 0.0_wp
      !> Contact time or, where there is none, a time in its place [s]; that of any impact
      real(wp) :: reference = 1.0e-3_wp
      !> Notes about them, one to a line
      character(len=:), allocatable :: notes
   end type window_t

   !> What the names of the files of run end with
   character(len=*), parameter :: run_endings(3) = [character(len=longest_ending) :: &
      '_summary.csv', '.csv', '.h5']
   !> What the names of the files of material end with
   character(len=*), parameter :: material_endings(4) = [character(len=longest_ending) :: &
      '_material.csv', '_material_relaxation.csv', '_material_dynamic.csv', '_material.h5']

contains

   !> Name of a file
   pure function file(self, i)
      class(job_t), intent(in) :: self
      integer, intent(in) :: i
      !> The name; empty if the file is not written
      character(len=:), allocatable :: file

      file = ''
      if (self%writes(i)) file = self%path//trim(self%endings(i))
   end function file

   !> Names of the files that are written, one to a line of the screen
   pure function written(self) result(text)
      class(job_t), intent(in) :: self
      character(len=:), allocatable :: text

      integer :: i

      text = ''
      do i = 1, size(self%endings)
         if (self%writes(i)) text = text//'  written '//self%file(i)//new_line('a')
      end do
   end function written

   !> Names and values of the swept parameters at a point
   function coordinates(self, point) result(text)
      class(job_t), intent(in) :: self
      integer, intent(in) :: point
      character(len=:), allocatable :: text

      integer :: i, places(size(self%sweep%grid%axes))

      places = self%sweep%grid%places(point)
      text = ''
      do i = 1, size(places)
         if (i > 1) text = text//', '
         associate (axis => self%sweep%grid%axes(i))
            text = text//axis%name//' = '//significant(axis%values(places(i)), 8, 0)
         end associate
      end do
   end function coordinates

   !> The case with the values of a point of its sweep
   pure function case_at(self, point) result(case)
      class(job_t), intent(in) :: self
      integer, intent(in) :: point
      type(case_t) :: case

      integer :: i, places(size(self%sweep%grid%axes))

      places = self%sweep%grid%places(point)
      case = self%case
      do i = 1, size(places)
         associate (axis => self%sweep%grid%axes(i))
            call case%oust(axis%address, always=.true.)
            call case%set(axis%address, axis%values(places(i)))
         end associate
      end do
   end function case_at

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
         call prepare_job(request, jobs(i), error)
         if (.not. allocated(error)) call name_files(request, jobs(i), size(jobs) == 1, error)
         do j = 1, i
            if (.not. allocated(error)) call refuse_clash(jobs(i), jobs(j), i == j, error)
         end do
         if (allocated(error)) return
      end do
   end subroutine prepare

   !> Read the files of a request: the cases, each completed by the files of materials behind it
   subroutine read_cases(request, jobs, error)
      type(request_t), intent(in) :: request
      !> The cases, as they were read
      type(job_t), allocatable, intent(out) :: jobs(:)
      type(error_t), allocatable, intent(out) :: error

      type(case_t) :: cases(size(request%files))
      logical :: completes(size(request%files))
      integer :: i, j

      do i = 1, size(cases)
         call read_case(cases(i), request%files(i)%text, error)
         if (allocated(error)) return
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

   !> Override, validate and build one case
   subroutine prepare_job(request, job, error)
      type(request_t), intent(in) :: request
      !> The case as it was read; the names of its files are left out
      type(job_t), intent(inout) :: job
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      do i = 1, size(request%settings)
         if (.not. allocated(error)) call override(job%case, &
            request%settings(i)%text, error, option='--set')
      end do
      if (.not. allocated(error)) call validate(job%case, error)
      if (.not. allocated(error)) call refuse_unread(job%case, &
         any(request%command == ['material', 'fit     ']), error)
      if (.not. allocated(error)) call read_data(job%case, error)
      if (.not. allocated(error)) call new_sweep(job%sweep, job%case, error)
      if (allocated(error)) return
      if (.not. job%sweep%is_grid()) then
         job%impact = job%sweep%problem%impact
      else if (request%command == 'verify') then
         call job%case%refuse('sweep', 'parameter', 1, &
            'verify takes single impacts, found a &sweep group', error)
      end if
      if (.not. allocated(error)) call check_names(request, job%sweep%grid, error)
      job%method = method_for(job%sweep%problem%settings%method, &
         job%sweep%problem%settings%scheme)
   end subroutine prepare_job

   !> Find out which files a case writes, and where
   subroutine name_files(request, job, is_alone, error)
      type(request_t), intent(in) :: request
      !> A case that was read
      type(job_t), intent(inout) :: job
      !> Whether it is the only one
      logical, intent(in) :: is_alone
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: directory, stem
      logical :: csv, hdf5

      call job%case%get('output', 'directory', directory)
      if (allocated(request%directory)) directory = request%directory
      call job%case%get('output', 'stem', stem)
      call check_output_name(job, 'directory', directory, error)
      if (.not. allocated(error)) call check_output_name(job, 'stem', stem, error)
      if (allocated(error)) return
      job%path = join_path(directory, stem)
      call job%case%get('output', 'csv', csv)
      call job%case%get('output', 'hdf5', hdf5)
      call job%case%get('output', 'history', job%history)
      ! a time history is that of one impact
      job%history = job%history .and. .not. job%sweep%is_grid()
      if (request%command == 'material') then
         job%endings = material_endings
         job%writes = [csv, csv, csv, hdf5]
      else
         job%endings = run_endings
         job%writes = [csv, csv .and. job%history, hdf5]
      end if
      ! bare numbers are for scripts, which would be surprised by files
      if (size(request%names) > 0 .and. .not. allocated(request%directory)) job%writes = .false.
      if (request%command == 'verify' .or. request%command == 'fit') job%writes = .false.
      job%history = job%history .and. any(job%writes)
      job%part = new_part(job%sweep%grid%count(), 1, 1)
      call take_shard(request, job, error)
      if (allocated(error)) return
      if (is_alone) call take_file_name(request, job)
      if (request%shards > 0) job%path = job%path//'_shard_'//integer_text(request%shard) &
         //'_of_'//integer_text(request%shards)
      if (request%resume .and. .not. any(job%writes)) call raise(error, error_usage, &
         '--resume: no file is written that could be resumed; --print needs --output for it')
   end subroutine name_files

   !> Check a name that files are written under
   subroutine check_output_name(job, key, name, error)
      type(job_t), intent(in) :: job
      !> Key of &output
      character(len=*), intent(in) :: key
      !> Its value, or what stands for it
      character(len=*), intent(in) :: name
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: flaw

      flaw = name_flaw(name)
      if (flaw /= '') call job%case%refuse('output', key, 1, 'output.'//key//": the name '" &
         //printable(name)//"' "//flaw//', expected another name', error)
   end subroutine check_output_name

   !> Take the part of --shard
   subroutine take_shard(request, job, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(inout) :: job
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: number, parts

      if (request%shards == 0) return
      number = integer_text(request%shard)
      parts = integer_text(request%shards)
      if (.not. job%sweep%is_grid()) then
         call raise(error, error_usage, '--shard takes a part of a sweep, but ' &
            //job%case%source//' has no &sweep group')
         return
      else if (request%shards > job%part%points) then
         call raise(error, error_usage, '--shard: found '//number//'/'//parts//', but ' &
            //job%case%source//' has '//integer_text(job%part%points) &
            //' points; expected no more shards than points')
         return
      end if
      job%part = new_part(job%part%points, request%shard, request%shards)
      ! what vcor merge reads
      job%writes = [.false., .false., .true.]
   end subroutine take_shard

   !> The value of --output is the file itself, where one file is written and the name ends as its
   !> name does
   subroutine take_file_name(request, job)
      type(request_t), intent(in) :: request
      !> The case, whose path and ending change
      type(job_t), intent(inout) :: job

      character(len=:), allocatable :: directory, extension, name
      integer :: one, last
      logical :: is_file

      if (.not. allocated(request%directory) .or. count(job%writes) /= 1) return
      one = findloc(job%writes, .true., dim=1)
      extension = trim(job%endings(one)(index(job%endings(one), '.'):))
      directory = folder_of(request%directory)
      name = request%directory(len(directory) + 1:)
      last = len(name) - len(extension)
      is_file = .not. directory_exists(request%directory)
      if (is_file .and. last > 0) is_file = name(last + 1:) == extension
      if (is_file .and. last > 0) then
         job%path = directory//name(:last)
         job%endings(one) = extension
      end if
   end subroutine take_file_name

   !> Directory of the files of a case
   pure function directory_of(job) result(directory)
      type(job_t), intent(in) :: job
      !> Its path, empty for the current one
      character(len=:), allocatable :: directory

      integer :: slash

      slash = index(job%path, '/', back=.true.)
      if (slash > 1) slash = slash - 1
      directory = job%path(:slash)
   end function directory_of

   !> Which shard, for messages
   function shard_text(part) result(text)
      type(part_t), intent(in) :: part
      !> Words, or nothing
      character(len=:), allocatable :: text

      text = ''
      if (part%parts > 1) text = ' of shard '//integer_text(part%number)//' of ' &
         //integer_text(part%parts)
   end function shard_text

   !> Names of --print with a dot are parameters that the case sweeps
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
               //"' in --print, but the case sweeps nothing; expected names of columns")
            return
         end if
         call raise(error, error_usage, "unknown name '"//printable(request%names(i)%text) &
            //"' in --print; "//suggestion(request%names(i)%text, known))
         return
      end do
   end subroutine check_names

   !> No file of one case may be a file of another, nor a case file itself, nor a data file
   subroutine refuse_clash(new, old, is_same, error)
      type(job_t), intent(in) :: new
      !> One that comes no later
      type(job_t), intent(in) :: old
      logical, intent(in) :: is_same
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, j

      call keep_inputs(new, old)
      if (is_same .or. allocated(error)) return
      call keep_inputs(old, new)
      do i = 1, size(new%endings)
         do j = 1, size(old%endings)
            if (allocated(error)) return
            if (.not. (new%writes(i) .and. old%writes(j))) cycle
            if (same_file(new%file(i), old%file(j))) call raise(error, error_input, &
               new%case%source//': its files would replace those of '//old%case%source &
               //': give one of them another output.stem')
         end do
      end do

   contains

      !> No file that is written may be one that is read
      subroutine keep_inputs(writer, reader)
         type(job_t), intent(in) :: writer, reader

         character(len=:), allocatable :: path, kind

         do i = 1, size(writer%endings)
            if (.not. writer%writes(i)) cycle
            path = file_read(reader%case, writer%file(i))
            kind = trim(merge('case', 'data', path == reader%case%source))
            if (path /= '') call raise(error, error_input, writer%case%source//': its results ' &
               //'would replace the '//kind//' file '//path//': give it another output.stem')
            if (allocated(error)) return
         end do
      end subroutine keep_inputs
   end subroutine refuse_clash

   !> Which of the files that a case reads a name leads to
   function file_read(case, name) result(path)
      type(case_t), intent(in) :: case
      !> Name of a file
      character(len=*), intent(in) :: name
      !> The case file or one of those of its materials; empty if it is none of them
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
      path = ''
   end function file_read

   !> Solve the impact of a case, the first one of a sweep
   subroutine find_window(job, window, error)
      type(job_t), intent(in) :: job
      type(window_t), intent(out) :: window
      !> Error of code `error_input`, unallocated on success, with or without a result
      type(error_t), allocatable, intent(out) :: error

      !> Contact times are about three times the time scale of Hertz's impact
      real(wp), parameter :: hertz = 3.0_wp
      type(worker_t) :: worker
      type(outcome_t) :: outcome
      type(error_t), allocatable :: trouble
      character(len=:), allocatable :: message
      type(key_t) :: key
      integer :: i

      window%case = job%case_at(1)
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
