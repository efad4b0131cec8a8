!> The command line as a request
module vcor_app_cli
   use vcor_app_argument, only : append_word, argument_t, has_word
   use vcor_app_commands, only : commands, options_of
   use vcor_app_fit_options, only : apply_fit_option, fit_request_t
   use vcor_app_option_value, only : read_positive, read_whole
   use vcor_case_name, only : control_in, name_flaw
   use vcor_error, only : error_t, error_usage, raise
   use vcor_words, only : suggestion
   use vcor_material_moduli, only : time_range_t
   use vcor_sweep_quantity, only : quantity_names
   use vcor_sweep_part, only : most_threads
   use vcor_text, only : printable
   implicit none
   private

   public :: request_t, parse

   !> Most points of --points
   integer, parameter :: most_points = 100000

   !> What the user asks for
   type :: request_t
      !> One of `commands`, or version
      character(len=:), allocatable :: command
      !> Case files, or the topic of help, shape (n)
      type(argument_t), allocatable :: files(:)
      !> Values of --set, shape (n)
      type(argument_t), allocatable :: settings(:)
      !> Names of --print, shape (n)
      type(argument_t), allocatable :: names(:)
      !> Directory of --output; unallocated without it
      character(len=:), allocatable :: directory
      !> Threads of --threads; 0 without it
      integer :: threads = 0
      !> Whether to go on with what is there
      logical :: resume = .false.
      !> Number of the shard; 0 without --shard
      integer :: shard = 0
      !> Number of shards; 0 without --shard
      integer :: shards = 0
      !> Times of --from, --to and --points
      type(time_range_t) :: range
      !> What is to be fitted
      type(fit_request_t) :: fit
      !> Kind of figure of --kind; unallocated without it
      character(len=:), allocatable :: kind
      !> Format of figures of --format; unallocated without it
      character(len=:), allocatable :: format
      !> Texts of --legend, shape (n)
      type(argument_t), allocatable :: legends(:)
      !> Whether the script of a figure is left
      logical :: script = .false.
      !> Nothing on the screen
      logical :: quiet = .false.
      !> Whether help is wanted as JSON
      logical :: json = .false.
   end type request_t

contains

   !> Understand the command line
   subroutine parse(words, request, error)
      !> Words after the name of the program
      type(argument_t), intent(in) :: words(:)
      type(request_t), intent(out) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: known, name
      integer :: i, mark
      logical :: plain

      allocate (request%files(0), request%settings(0), request%names(0), request%legends(0))
      if (size(words) == 0) then
         call raise(error, error_usage, 'no command; known: run, merge, check, material, fit, ' &
            //'plot, verify, help (vcor help says more)')
         return
      end if

      select case (words(1)%text)
      case ('--version')
         request%command = 'version'
         if (size(words) > 1) call raise(error, error_usage, '--version takes nothing, found ' &
            //"'"//printable(words(2)%text)//"'")
         return
      case default
         request%command = words(1)%text
         if (request%command == '--help' .or. request%command == '-h') request%command = 'help'
         if (.not. has_word(commands, request%command)) then
            call raise(error, error_usage, "unknown command '"//printable(request%command)//"'; " &
               //suggestion(request%command, commands//' '//options_of('help')))
            return
         end if
      end select
      known = options_of(request%command)

      plain = .false.
      i = 1
      do while (i < size(words))
         i = i + 1
         name = words(i)%text
         if (plain .or. index(name, '-') /= 1 .or. name == '-') then
            if (request%command /= 'help' .and. control_in(name) /= '') then
               call raise(error, error_usage, "found "//control_in(name)//" in the name '" &
                  //printable(name)//"', expected the name of a file that can be read on one line")
               return
            end if
            call append_word(request%files, name)
            cycle
         end if
         if (name == '--') then
            plain = .true.
            cycle
         end if
         if (name == '-h') name = '--help'

         ! --option=value, or the value is the next word
         mark = index(name, '=')
         if (mark > 0) name = name(:mark - 1)
         if (.not. has_word(known, name)) then
            call raise(error, error_usage, "unknown option '"//printable(name)//"' of " &
               //request%command//'; '//suggestion(name, known))
            return
         end if
         select case (name)
         case ('--help')
            deallocate (request%files)
            allocate (request%files(0))
            if (request%command /= 'help') call append_word(request%files, request%command)
            request%command = 'help'
            return
         case ('--version')
            request%command = 'version'
            return
         case ('--quiet', '--resume', '--shear', '--dynamic', '--script', '--json')
            if (mark > 0) then
               call raise(error, error_usage, 'option '//name//' takes no value')
               return
            end if
            if (name == '--quiet') request%quiet = .true.
            if (name == '--resume') request%resume = .true.
            if (name == '--shear') request%fit%shear = .true.
            if (name == '--dynamic') request%fit%dynamic = .true.
            if (name == '--script') request%script = .true.
            if (name == '--json') request%json = .true.
            cycle
         case default
         end select

         if (mark == 0) then
            i = i + 1
            if (i <= size(words)) then
               if (index(words(i)%text, '--') == 1) i = size(words) + 1
            end if
            if (i > size(words)) then
               call raise(error, error_usage, 'option '//name//' needs a value')
               return
            end if
         end if
         call apply(name, words(i)%text(mark + 1:), request, error)
         if (allocated(error)) return
      end do

      if (size(request%files) == 0) call refuse_no_case(request, error)
      if (request%shards > 0 .and. size(request%names) > 0) call raise(error, error_usage, &
         '--print is for whole sweeps, found --shard as well')
      if (request%command == 'help' .and. size(request%files) > 1) &
         call raise(error, error_usage, "help takes one topic, found '" &
         //printable(request%files(2)%text)//"' as well")
      if (request%json .and. size(request%files) > 0) call raise(error, error_usage, &
         "help --json takes no topic, found '"//printable(request%files(1)%text)//"'")
   end subroutine parse

   !> Refuse a request without a case file where it needs one: verify does for its settings only
   subroutine refuse_no_case(request, error)
      !> The request, without files
      type(request_t), intent(in) :: request
      !> Error of code `error_usage`, unallocated where no case is needed
      type(error_t), allocatable, intent(inout) :: error

      if (request%command == 'help') return
      if (request%command == 'verify' .and. size(request%settings) == 0) return
      if (request%command == 'merge') then
         call raise(error, error_usage, 'no files; expected vcor merge STEM_shard_*.h5')
         return
      end if
      if (request%command == 'fit') return
      if (request%command == 'plot') then
         call raise(error, error_usage, 'no file of results; expected vcor plot RESULT.h5')
      else
         call raise(error, error_usage, 'no case file; expected vcor '//request%command &
            //' CASE.nml')
      end if
   end subroutine refuse_no_case

   !> Take the value of an option
   subroutine apply(option, value, request, error)
      !> Option, a known one
      character(len=*), intent(in) :: option
      character(len=*), intent(in) :: value
      type(request_t), intent(inout) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (len_trim(value) == 0) then
         call raise(error, error_usage, 'option '//option//' needs a value')
         return
      end if
      select case (option)
      case ('--set', '--fix', '--units')
         continue
      case default
         if (control_in(value) /= '') call raise(error, error_usage, option//": found " &
            //control_in(value)//" in '"//printable(value)//"', expected a text that can be read " &
            //'on one line')
         if (allocated(error)) return
      end select
      select case (option)
      case ('--set')
         call append_word(request%settings, value)
      case ('--output')
         request%directory = value
         if (name_flaw(value) /= '') call raise(error, error_usage, "--output: the name '" &
            //printable(value)//"' "//name_flaw(value)//', expected another name')
      case ('--kind')
         request%kind = value
      case ('--format')
         request%format = value
      case ('--legend')
         call append_word(request%legends, value)
      case ('--threads')
         call read_whole(option, value, 1, most_threads, request%threads, error)
      case ('--shard')
         call read_shard(value, request, error)
      case ('--points')
         call read_whole(option, value, 2, most_points, request%range%points, error)
      case ('--from')
         call read_positive(option, value, request%range%first, error)
      case ('--to')
         call read_positive(option, value, request%range%last, error)
      case ('--print', '--quantity')
         call add_names(option, value, request, error)
      case default
         call apply_fit_option(option, value, request%fit, error)
      end select
   end subroutine apply

   !> Read the value of --shard, I/N
   subroutine read_shard(value, request, error)
      !> The value as it is written
      character(len=*), intent(in) :: value
      type(request_t), intent(inout) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: most_shards = 1000000
      integer :: mark

      mark = index(value, '/')
      if (mark == 0) then
         call raise(error, error_usage, "--shard: found '"//printable(trim(value)) &
            //"', expected I/N: shard I of N, as in --shard 1/4")
         return
      end if
      call read_whole('--shard', value(mark + 1:), 1, most_shards, request%shards, error)
      if (allocated(error)) return
      call read_whole('--shard', value(:mark - 1), 1, request%shards, request%shard, error)
   end subroutine read_shard

   !> Split the value of --print or --quantity
   subroutine add_names(option, list, request, error)
      character(len=*), intent(in) :: option
      !> Names separated by commas
      character(len=*), intent(in) :: list
      type(request_t), intent(inout) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: first, last

      first = 1
      do while (first <= len(list) + 1)
         last = first + index(list(first:)//',', ',') - 2
         call add_name(option, trim(adjustl(list(first:last))), request, error)
         if (allocated(error)) return
         first = last + 2
      end do
   end subroutine add_names

   !> Add one name of --print or --quantity
   subroutine add_name(option, name, request, error)
      character(len=*), intent(in) :: option
      character(len=*), intent(in) :: name
      type(request_t), intent(inout) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      ! what has a dot is a parameter of a sweep, and whether there is one the case says
      if (index(name, '.') == 0 .and. .not. has_word(quantity_names(), name)) then
         call raise(error, error_usage, "unknown name '"//printable(name)//"' in "//option//'; ' &
            //suggestion(name, quantity_names()))
      else
         call append_word(request%names, name)
      end if
   end subroutine add_name

end module vcor_app_cli
