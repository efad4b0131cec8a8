!> The values of a case as an impact reads them
!>
!> A reading records each value that is taken from the case. A value from --set or another origin
!> than the case file that was not read, or a sweep over one, is an error: unchanged numbers would
!> be mistaken for an answer. Where a value is left out, the code that leaves it out may state why.
module vcor_case_reading
   use vcor_case_address, only : swept_addresses
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, first_row, groups, key_row, last_row
   use vcor_case_entries, only : address_t, entry_t
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, shortened
   implicit none
   private

   public :: reading_t, refuse_unread

   !> What becomes of a value: nothing
   integer, parameter :: is_unread = 0
   !> A warning depends on it, but no number
   integer, parameter :: is_for_warnings = 1
   !> A number depends on it
   integer, parameter :: is_read = 2

   !> Groups that describe the impact; the other ones are about its points and their files
   character(len=*), parameter :: described(*) = [character(len=8) :: 'impact', 'sphere', 'plate', &
      'target', 'contact', 'material', 'solver']

   !> Reason why a value is left out
   type :: reason_t
      !> Its address
      type(address_t) :: address
      !> One line; a fixed length, as gfortran 12 does not copy lists of others
      character(len=120) :: text = ''
   end type reason_t

   !> What has been read of a case
   type :: reading_t
      private
      !> One of the `is_*` constants for each value, shape (items of a group, rows of the catalogue)
      integer, allocatable :: use(:, :)
      !> Reasons why values are left out, shape (n)
      type(reason_t), allocatable :: reasons(:)
   contains
      procedure :: start, mark, note_unread, has
      generic :: get => get_logical, get_text
      procedure :: number => read_number
      procedure, private :: get_logical, get_text, is_noted_unread, reason_of, why_not
   end type reading_t

contains

   !> Begin to read a case
   pure subroutine start(self, case)
      class(reading_t), intent(inout) :: self
      type(case_t), intent(in) :: case

      if (allocated(self%use)) deallocate (self%use)
      if (allocated(self%reasons)) deallocate (self%reasons)
      allocate (self%reasons(0))
      allocate (self%use(max(1, case%count('material')), size(catalogue)), source=is_unread)
   end subroutine start

   !> Record that a value has been read
   pure subroutine mark(self, address, warns)
      class(reading_t), intent(inout) :: self
      !> Its address; nowhere is ignored
      type(address_t), intent(in) :: address
      !> Whether only a warning depends on it; absent: no
      logical, intent(in), optional :: warns

      if (address%group == 0) return
      self%use(address%item, address%row) = is_read
      if (.not. present(warns)) return
      if (warns) self%use(address%item, address%row) = is_for_warnings
   end subroutine mark

   !> State why a value is not read
   pure subroutine note_unread(self, address, reason)
      class(reading_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      character(len=*), intent(in) :: reason

      self%reasons = [self%reasons, reason_t(address, reason)]
   end subroutine note_unread

   !> Whether a value has been read
   pure function has(self, address)
      class(reading_t), intent(in) :: self
      !> Its address; of an element the whole list counts
      type(address_t), intent(in) :: address
      logical :: has

      has = .false.
      if (address%group > 0) has = self%use(address%item, address%row) == is_read
   end function has

   !> Read a number, as `case%number` does
   function read_number(self, case, address) result(number)
      class(reading_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      type(address_t), intent(in) :: address
      !> In the unit of the key; a quiet NaN if there is none
      real(wp) :: number

      number = case%number(address)
      call self%mark(address)
   end function read_number

   !> Read a text
   pure subroutine get_text(self, case, group, key, value, item)
      class(reading_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      character(len=*), intent(in) :: group, key
      character(len=:), allocatable, intent(out) :: value
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item

      call case%get(group, key, value, item)
      call self%mark(case%address(group, key, item))
   end subroutine get_text

   !> Read a logical
   pure subroutine get_logical(self, case, group, key, value, item)
      class(reading_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      character(len=*), intent(in) :: group, key
      logical, intent(out) :: value
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item

      call case%get(group, key, value, item)
      call self%mark(case%address(group, key, item))
   end subroutine get_logical

   !> Reason why a value has not been read
   pure function why_not(self, case, address) result(reason)
      class(reading_t), intent(in) :: self
      type(case_t), intent(in) :: case
      type(address_t), intent(in) :: address
      !> In words
      character(len=:), allocatable :: reason

      integer :: i

      reason = 'nothing depends on it'
      if (self%use(address%item, address%row) == is_for_warnings) then
         reason = 'it is for the warning about the band of the data, no number depends on it'
      else if (address%group == find_group('material') .and. all(address%item /= &
               [case%material_of('sphere'), case%material_of('plate'), &
               case%material_of('target')])) then
         reason = 'neither the sphere nor the plate is of this material'
      end if
      i = self%reason_of(address)
      if (i > 0) reason = trim(self%reasons(i)%text)
   end function why_not

   !> Whether a value is left out for a reason
   pure function is_noted_unread(self, address)
      class(reading_t), intent(in) :: self
      type(address_t), intent(in) :: address
      logical :: is_noted_unread

      is_noted_unread = self%reason_of(address) > 0
   end function is_noted_unread

   !> Place of the reason why a value is left out
   pure function reason_of(self, address) result(i)
      class(reading_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> Index in `reasons`; 0: none
      integer :: i

      do i = size(self%reasons), 1, -1
         if (self%reasons(i)%address%row == address%row &
             .and. self%reasons(i)%address%item == address%item) return
      end do
      i = 0
   end function reason_of

   !> Refuse a sweep over a value that was not read, and a value from --set, or another origin than
   !> the case file, that was not read or that a sweep varies
   subroutine refuse_unread(reading, case, is_complete, all_materials, error)
      !> Of the impact of the case
      type(reading_t), intent(in) :: reading
      type(case_t), intent(in) :: case
      !> Whether the impact could be built; otherwise only what is left out for a reason is refused
      logical, intent(in) :: is_complete
      !> Whether materials are read that no body uses
      logical, intent(in) :: all_materials
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(address_t), allocatable :: swept(:)
      type(address_t) :: address
      type(entry_t) :: entry
      character(len=:), allocatable :: path, reason
      integer :: group, i, item, row

      allocate (swept, source=swept_addresses(case))
      do i = 1, size(swept)
         if (reading%has(swept(i))) cycle
         if (.not. (is_complete .or. reading%is_noted_unread(swept(i)))) cycle
         call case%get('sweep', 'parameter', path, i)
         call case%refuse('sweep', 'parameter', i, "found '"//shortened(path) &
            //"', which the impact does not read: "//reading%why_not(case, swept(i)), error)
         return
      end do
      do group = 1, size(groups)
         do item = 1, case%count(groups(group)%name)
            do row = first_row(group), last_row(group)
               if (key_row(row) /= row) cycle
               address = address_t(group, item, row)
               entry = case%entry(address)
               if (.not. allocated(entry%origin)) cycle
               reason = why_varied(case, swept, address, entry%origin)
               if (reason == '' .and. any(described == groups(group)%name)) then
                  if (reading%use(item, row) == is_unread &
                      .and. (is_complete .or. reading%is_noted_unread(address)) &
                      .and. .not. (all_materials .and. groups(group)%name == 'material')) &
                     reason = 'the impact does not read it: '//reading%why_not(case, address)
               end if
               if (reason == '') cycle
               call raise(error, error_input, entry%origin//': '//reason)
               return
            end do
         end do
      end do
   end subroutine refuse_unread

   !> Reason why a value that was set has no effect: a sweep varies it
   pure function why_varied(case, swept, address, origin) result(reason)
      type(case_t), intent(in) :: case
      !> Addresses of the parameters that vary
      type(address_t), intent(in) :: swept(:)
      type(address_t), intent(in) :: address
      !> Its origin, which includes the index of an element
      character(len=*), intent(in) :: origin
      !> The reason; empty if no sweep varies it
      character(len=:), allocatable :: reason

      integer :: found, i

      found = 0
      do i = 1, size(swept)
         if (swept(i)%row /= address%row .or. swept(i)%item /= address%item) cycle
         if (swept(i)%element > 0 .and. &
             index(origin, '('//integer_text(swept(i)%element)//')') == 0) cycle
         found = i
      end do
      reason = ''
      if (found > 0) reason = 'the &sweep group at '//case%location('sweep', 'parameter', found) &
         //' varies it, expected a key that no sweep varies'
   end function why_varied

end module vcor_case_reading
