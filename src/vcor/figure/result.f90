!> A file of results, as figures need it: what is in it, and its columns by name
module vcor_figure_result
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use vcor_error, only : error_input, error_t, raise
   use vcor_io_table, only : column_t, integer_column, real_column, text_column
   use vcor_io_drawing, only : split_path
   use vcor_io_hdf5_reader, only : close_hdf5, dataset_t, list_members, member_t, &
      number_attribute, open_hdf5, read_dataset, reader_t, text_attribute
   use vcor_kinds, only : wp
   use vcor_words, only : suggestion
   use vcor_text, only : printable, shortened
   implicit none
   private

   public :: result_t, read_result, has_group, column_names
   public :: get_axes, get_column, get_number, get_texts, get_window

   !> A group of a file with all it holds
   type :: group_t
      !> Its path
      character(len=:), allocatable :: name
      !> Its datasets, in their order
      type(dataset_t), allocatable :: datasets(:)
      !> Window of the impact that moduli are for, contact time [s] and lowest frequency [rad/s];
      !> NaN if the file does not tell
      real(wp) :: contact_time, min_frequency
   end type group_t

   !> What one file holds
   type :: result_t
      !> The file, as messages name it
      character(len=:), allocatable :: path
      !> Name of the file without folder and extension
      character(len=:), allocatable :: stem
      !> Title of the case, may be empty
      character(len=:), allocatable :: title
      !> The case with all its defaults, may be empty
      character(len=:), allocatable :: case_text
      !> Groups with datasets in them, shape (n)
      type(group_t), allocatable :: groups(:)
   end type result_t

contains

   !> Read a file
   subroutine read_result(result, filename, error)
      !> What is in it
      type(result_t), intent(out) :: result
      !> Its name
      character(len=*), intent(in) :: filename
      !> Error of code `error_file` or `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(reader_t) :: reader
      type(member_t), allocatable :: members(:)
      character(len=:), allocatable :: directory
      integer :: count, i, last

      call open_hdf5(reader, filename, error)
      if (allocated(error)) return
      result%path = reader%path
      call split_path(trim(filename), directory, result%stem)
      last = index(result%stem, '.', back=.true.)
      if (last > 1) result%stem = result%stem(:last - 1)
      result%title = printable(text_attribute(reader, '/', 'title'))
      result%case_text = text_attribute(reader, '/', 'case')
      call list_members(reader, '/', members, error)
      if (.not. allocated(error)) then
         allocate (result%groups(size(members)))
         count = 0
         do i = 1, size(members)
            if (.not. members(i)%is_group) cycle
            count = count + 1
            call read_group(reader, members(i)%name, result%groups(count), error)
            if (allocated(error)) exit
         end do
         result%groups = result%groups(:count)
      end if
      call close_hdf5(reader)
      if (allocated(error)) return
      if (size(result%groups) == 0) call raise(error, error_input, result%path &
         //': there are no results in this file, expected those of vcor run')
   end subroutine read_result

   !> Read the datasets of a group
   subroutine read_group(reader, name, group, error)
      !> Open file
      type(reader_t), intent(in) :: reader
      !> Name of the group
      character(len=*), intent(in) :: name
      type(group_t), intent(out) :: group
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(member_t), allocatable :: members(:)
      integer :: i, j, count

      group%name = name
      group%contact_time = number_attribute(reader, name, 'contact_time')
      group%min_frequency = number_attribute(reader, name, 'min_frequency')
      call list_members(reader, name, members, error)
      if (allocated(error)) return
      count = 0
      do i = 1, size(members)
         if (.not. members(i)%is_group) count = count + 1
      end do
      allocate (group%datasets(count))
      j = 0
      do i = 1, size(members)
         if (members(i)%is_group) cycle
         j = j + 1
         call read_dataset(reader, name//'/'//members(i)%name, group%datasets(j), error)
         if (allocated(error)) return
      end do
   end subroutine read_group

   !> Place of a group
   pure function place_of(result, name) result(place)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Name of the group
      character(len=*), intent(in) :: name
      !> Its number, 0 if there is none
      integer :: place

      do place = size(result%groups), 1, -1
         if (result%groups(place)%name == name) return
      end do
   end function place_of

   !> Whether there is a group
   pure function has_group(result, name) result(has)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Name of the group
      character(len=*), intent(in) :: name
      !> True if there is
      logical :: has

      has = place_of(result, name) > 0
   end function has_group

   !> A column of text, empty where there is none
   subroutine get_texts(result, group, name, texts)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Name of its group
      character(len=*), intent(in) :: group
      !> Name of the column
      character(len=*), intent(in) :: name
      type(column_t), intent(out) :: texts

      integer :: i, place

      place = place_of(result, group)
      if (place == 0) return
      associate (datasets => result%groups(place)%datasets)
         do i = 1, size(datasets)
            if (datasets(i)%column%name == name .and. datasets(i)%column%kind == text_column) &
               texts = datasets(i)%column
         end do
      end associate
   end subroutine get_texts

   !> Window of the impact that moduli are for
   pure subroutine get_window(result, group, contact_time, min_frequency)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Name of a group that is there
      character(len=*), intent(in) :: group
      !> Contact time [s], NaN if the file does not tell
      real(wp), intent(out) :: contact_time
      !> Lowest frequency [rad/s], NaN if the file does not tell
      real(wp), intent(out) :: min_frequency

      contact_time = result%groups(place_of(result, group))%contact_time
      min_frequency = result%groups(place_of(result, group))%min_frequency
   end subroutine get_window

   !> A column of numbers
   subroutine get_column(result, group, name, column, error)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Name of its group
      character(len=*), intent(in) :: group
      !> Name of the column
      character(len=*), intent(in) :: name
      !> The column, real numbers; integers are made real
      type(dataset_t), intent(out) :: column
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, place

      place = place_of(result, group)
      if (place == 0) then
         call raise(error, error_input, result%path//": there is no group '"//group//"'")
         return
      end if
      associate (datasets => result%groups(place)%datasets)
         do i = 1, size(datasets)
            if (datasets(i)%column%name /= name) cycle
            column = datasets(i)
            if (column%column%kind == integer_column) then
               column%column%reals = real(column%column%integers, wp)
               column%column%kind = real_column
            end if
            if (column%column%kind == real_column) return
            call raise(error, error_input, result%path//": '"//shortened(name)//"' of '"//group &
               //"' is text, expected numbers")
            return
         end do
      end associate
      call raise(error, error_input, result%path//": there is no '"//shortened(name)//"' in '" &
         //group//"'; "//suggestion(name, column_names(result, group)))
   end subroutine get_column

   !> Names of the columns of numbers of a group, separated by blanks; scales are none
   pure function column_names(result, group) result(names)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Name of its group
      character(len=*), intent(in) :: group
      character(len=:), allocatable :: names

      integer :: i, place

      names = ''
      place = place_of(result, group)
      if (place == 0) return
      associate (datasets => result%groups(place)%datasets)
         do i = 1, size(datasets)
            if (datasets(i)%is_scale .or. datasets(i)%column%kind == text_column) cycle
            if (names /= '') names = names//' '
            names = names//datasets(i)%column%name
         end do
      end associate
   end function column_names

   !> The first number of a column of the summary
   function get_number(result, name) result(number)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Name of the column
      character(len=*), intent(in) :: name
      !> The number, NaN if there is none
      real(wp) :: number

      type(dataset_t) :: column
      type(error_t), allocatable :: error

      number = ieee_value(1.0_wp, ieee_quiet_nan)
      call get_column(result, 'summary', name, column, error)
      if (allocated(error)) return
      if (column%column%length > 0) number = column%column%reals(1)
   end function get_number

   !> What is swept: the dimensions of the summary, the slowest first
   pure subroutine get_axes(result, axes)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Scales of the dimensions; none for a single impact
      type(dataset_t), allocatable, intent(out) :: axes(:)

      integer :: i, place
      logical, allocatable :: swept(:)

      allocate (axes(0))
      place = place_of(result, 'summary')
      if (place == 0) return
      associate (datasets => result%groups(place)%datasets)
         allocate (swept(size(datasets)))
         do i = 1, size(datasets)
            ! the dimension `impact` is just a number in a row
            swept(i) = datasets(i)%is_scale .and. datasets(i)%column%kind == real_column
         end do
         axes = pack(datasets, swept)
      end associate
   end subroutine get_axes

end module vcor_figure_result
