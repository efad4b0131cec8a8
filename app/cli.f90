!> Parses the command line into a request
module vcor_app_cli
   use vcor_app_commands, only : commands, missing_package, options_of, package_names
   use vcor_number, only : read_real
   use vcor_error, only : error_t, error_usage, raise
   use vcor_kinds, only : wp
   use vcor_material_moduli, only : time_range_t
   use vcor_io_crc, only : crc32
   use vcor_sweep_points, only : most_threads
   use vcor_text, only : control_in, integer_text, name_flaw, printable
   use vcor_words, only : contains_word, join_words, suggestion
   implicit none
   private

   public :: argument_t, request_t, get_arguments, sum_of_words, parse

   !> A word of the command line
   type :: argument_t
      character(len=:), allocatable :: text
   end type argument_t

   !> Request of the user
   type :: request_t
      !> One of `commands`, or version
      character(len=:), allocatable :: command
      !> Files, or the topic of help, shape (n)
      type(argument_t), allocatable :: files(:)
      !> Values of --set, shape (n)
      type(argument_t), allocatable :: settings(:)
      !> Names of --print, shape (n)
      type(argument_t), allocatable :: names(:)
      !> Value of --output; unallocated without it
      character(len=:), allocatable :: directory
      integer :: threads = 0
      !> Whether to continue with existing results
      logical :: resume = .false.
      !> Times of --from, --to and --points
      type(time_range_t) :: range
      !> Whether to print only requested numbers
      logical :: quiet = .false.
      !> Whether help prints JSON
      logical :: json = .false.
   end type request_t

   !> What takes the place of shards
   character(len=*), parameter :: instead = 'expected mpirun -n N vcor run CASE.nml, or a pool ' &
      //'of the Python package (docs/python.md)'

contains

   !> All words after the name of the program
   subroutine get_arguments(words)
      type(argument_t), allocatable, intent(out) :: words(:)

      integer :: i, length

      allocate (words(command_argument_count()))
      do i = 1, size(words)
         call get_command_argument(i, length=length)
         allocate (character(len=length) :: words(i)%text)
         if (length > 0) call get_command_argument(i, words(i)%text)
      end do
   end subroutine get_arguments

   !> Check sum by which ranks compare their command lines; the value of --threads is ignored
   pure function sum_of_words(words) result(sum)
      type(argument_t), intent(in) :: words(:)
      integer :: sum

      integer :: i
      logical :: counts

      sum = 0
      counts = .true.
      do i = 1, size(words)
         if (counts .and. index(words(i)%text, '--threads') /= 1) &
            sum = crc32(words(i)%text//achar(0), sum)
         counts = words(i)%text /= '--threads'
      end do
   end function sum_of_words

   !> Append a word. (gfortran 12 writes past the end of a deferred-length component in an array
   !> constructor of structure constructors, so there is none.)
   subroutine append(words, text)
      type(argument_t), allocatable, intent(inout) :: words(:)
      character(len=*), intent(in) :: text

      type(argument_t), allocatable :: longer(:)
      integer :: i

      allocate (longer(size(words) + 1))
      do i = 1, size(words)
         call move_alloc(words(i)%text, longer(i)%text)
      end do
      longer(size(longer))%text = text
      call move_alloc(longer, words)
   end subroutine append

   !> Parse the command line
   subroutine parse(words, request, error)
      !> Words after the name of the program
      type(argument_t), intent(in) :: words(:)
      type(request_t), intent(out) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: name, value
      integer :: i, mark
      logical :: plain, flag

      allocate (request%files(0), request%settings(0), request%names(0))
      if (size(words) == 0) then
         call raise(error, error_usage, 'no command; known: run, check, material, ' &
            //'verify, help (vcor help says more)')
         return
      end if
      request%command = words(1)%text
      if (request%command == '--version') then
         request%command = 'version'
         if (size(words) > 1) call raise(error, error_usage, '--version takes nothing, found ' &
            //"'"//printable(words(2)%text)//"'")
         return
      end if
      if (request%command == '--help' .or. request%command == '-h') request%command = 'help'
      if (.not. contains_word(commands(), request%command)) then
         name = missing_package(request%command)
         if (request%command == 'merge') name = 'vcor merge and --shard have gone; '//instead
         if (name == '' .and. index(request%command, '.nml', back=.true.) &
            == max(len(request%command) - 3, 1)) name = "unknown command '" &
            //printable(request%command)//"'; did you mean vcor run " &
            //printable(request%command)//'?'
         if (name == '') name = "unknown command '"//printable(request%command)//"'; " &
            //suggestion(request%command, commands()//' '//package_names()//' --help --version')
         call raise(error, error_usage, name)
         return
      end if

      plain = .false.
      value = ''
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
            call append(request%files, name)
            cycle
         end if
         if (name == '--') then
            plain = .true.
            cycle
         end if
         if (name == '-h') name = '--help'

         ! --option=value; otherwise the value is the next word
         mark = index(name, '=')
         if (mark > 0) name = name(:mark - 1)
         if (request%command == 'run' .and. name == '--shard') then
            call raise(error, error_usage, '--shard has gone; '//instead)
            return
         end if
         if (.not. contains_word(options_of(request%command), name)) then
            call raise(error, error_usage, "unknown option '"//printable(name)//"' of " &
               //request%command//'; '//suggestion(name, options_of(request%command)))
            return
         end if
         if (name == '--help') then
            request%files = request%files(:0)
            if (request%command /= 'help') call append(request%files, request%command)
            request%command = 'help'
            return
         else if (name == '--version') then
            request%command = 'version'
            return
         end if
         flag = contains_word(options_of(request%command, flags_only=.true.), name)
         if (flag .and. mark > 0) then
            call raise(error, error_usage, 'option '//name//' takes no value')
         else if (.not. flag .and. mark == 0) then
            i = i + 1
            if (i <= size(words)) then
               if (index(words(i)%text, '--') == 1) i = size(words) + 1
            end if
            if (i > size(words)) call raise(error, error_usage, 'option '//name//' needs a value')
         end if
         if (allocated(error)) return
         value = words(i)%text(merge(len(words(i)%text), mark, flag) + 1:)
         if (.not. flag .and. i < size(words)) call refuse_blank(name, value, &
            words(i + 1)%text, error)
         if (allocated(error)) return
         if (.not. flag .and. len_trim(value) == 0) then
            call raise(error, error_usage, 'option '//name//' needs a value')
         else if (name /= '--set' .and. control_in(value) /= '') then
            call raise(error, error_usage, name//": found "//control_in(value)//" in '" &
               //printable(value)//"', expected a text that can be read on one line")
         else
            call apply(request, name, value, error)
         end if
         if (allocated(error)) return
      end do
      call check_request(request, error)
   end subroutine parse

   !> Refuse a value that a blank has cut, such as `--print cor, contact_time`: its second part
   !> would be the name of a file
   subroutine refuse_blank(option, value, next, error)
      character(len=*), intent(in) :: option, value
      !> Word after the value
      character(len=*), intent(in) :: next
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: meant

      if (len_trim(value) == 0) return
      if (option == '--print' .and. (ends_with(value, ',') .or. index(next, ',') == 1)) then
         meant = 'cor,contact_time'
      else if (option == '--set' .and. (ends_with(value, '=') .or. index(next, '=') == 1)) then
         meant = 'impact.velocity=2'
      else
         return
      end if
      call raise(error, error_usage, option//": found a blank between '"//printable(trim(value)) &
         //"' and '"//printable(next)//"', expected none, such as "//option//' '//meant)
   end subroutine refuse_blank

   !> Whether a text ends with a letter, blanks apart
   pure function ends_with(text, letter) result(does)
      character(len=*), intent(in) :: text
      character, intent(in) :: letter
      logical :: does

      does = index(text, letter, back=.true.) == max(len_trim(text), 1)
   end function ends_with

   !> Apply an option to a request
   subroutine apply(request, option, value, error)
      type(request_t), intent(inout) :: request
      character(len=*), intent(in) :: option
      !> Its value; empty if it takes none
      character(len=*), intent(in) :: value
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: most_points = 100000

      select case (option)
      case ('--quiet')
         request%quiet = .true.
      case ('--resume')
         request%resume = .true.
      case ('--set')
         call append(request%settings, value)
      case ('--output')
         call read_name(option, value, request%directory, error)
      case ('--threads')
         call read_whole(option, value, 1, most_threads, request%threads, error)
      case ('--points')
         call read_whole(option, value, 2, most_points, request%range%points, error)
      case ('--from')
         call read_positive(option, value, request%range%first, error)
      case ('--to')
         call read_positive(option, value, request%range%last, error)
      case ('--print')
         call add_names(value, request)
      case default
         ! --json
         request%json = .true.
      end select
   end subroutine apply

   !> Read the name of a file or a folder
   subroutine read_name(option, value, name, error)
      character(len=*), intent(in) :: option, value
      character(len=:), allocatable, intent(out) :: name
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      name = value
      if (name_flaw(value) /= '') call raise(error, error_usage, option//": the name '" &
         //printable(value)//"' "//name_flaw(value)//', expected another name')
   end subroutine read_name

   !> Check that the parts of a request are compatible
   subroutine check_request(request, error)
      type(request_t), intent(in) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (size(request%files) == 0) then
         select case (request%command)
         case ('help')
            continue
         case default
            ! verify requires a case only if there are settings
            if (request%command /= 'verify' .or. size(request%settings) > 0) &
               call raise(error, error_usage, 'no case file; expected vcor '//request%command &
               //' CASE.nml')
         end select
      end if
      if (request%command == 'help' .and. size(request%files) > 1) &
         call raise(error, error_usage, "help takes one topic, found '" &
         //printable(request%files(2)%text)//"' as well")
      if (request%json .and. size(request%files) > 0) &
         call raise(error, error_usage, "help --json takes no topic, found '" &
         //printable(request%files(1)%text)//"'")
   end subroutine check_request

   !> Read the names of --print, which are checked with the case, as they may be swept parameters
   subroutine add_names(list, request)
      !> Names separated by commas
      character(len=*), intent(in) :: list
      type(request_t), intent(inout) :: request

      integer :: first, last

      first = 1
      do while (first <= len(list) + 1)
         last = first + index(list(first:)//',', ',') - 2
         call append(request%names, trim(adjustl(list(first:last))))
         first = last + 2
      end do
   end subroutine add_names

   !> Read a whole number within limits
   subroutine read_whole(option, value, least, most, number, error)
      character(len=*), intent(in) :: option, value
      integer, intent(in) :: least, most
      integer, intent(out) :: number
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: most_digits = 9
      character(len=:), allocatable :: digits
      integer :: status

      number = least - 1
      digits = trim(adjustl(value))
      status = 0
      if (len(digits) <= most_digits .and. verify(digits, '0123456789') == 0) &
         read (digits, *, iostat=status) number
      if (status /= 0 .or. number < least .or. number > most) call raise(error, error_usage, &
         option//": found '"//printable(digits)//"', expected a whole number from " &
         //integer_text(least)//' to '//integer_text(most))
   end subroutine read_whole

   !> Read a number > 0
   subroutine read_positive(option, value, number, error)
      character(len=*), intent(in) :: option, value
      real(wp), intent(out) :: number
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp), parameter :: smallest = 1.0e-30_wp, largest = 1.0e30_wp
      character(len=*), parameter :: expected = 'a number from 1e-30 to 1e30'

      call read_number(option, value, expected, number, error)
      if (allocated(error)) return
      if (.not. (number >= smallest .and. number <= largest)) call raise(error, error_usage, &
         option//': found '//printable(trim(adjustl(value)))//', expected '//expected)
   end subroutine read_positive

   !> Read a number
   subroutine read_number(option, value, expected, number, error)
      character(len=*), intent(in) :: option, value
      !> Expected value, for the message
      character(len=*), intent(in) :: expected
      real(wp), intent(out) :: number
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: message

      call read_real(trim(adjustl(value)), expected, number, message)
      if (allocated(message)) call raise(error, error_usage, option//': '//message)
   end subroutine read_number

end module vcor_app_cli
