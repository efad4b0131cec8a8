!> Texts that tell several results in one figure apart
!>
!> The titles of the cases, where they differ; else what differs in the cases, if it is little; else
!> the names of the files.
module vcor_figure_legend
   use vcor_figure_label, only : number_text
   use vcor_figure_result, only : result_t
   use vcor_io_figure, only : plain
   use vcor_kinds, only : wp
   use vcor_case_catalogue, only : catalogue
   use vcor_text, only : printable
   implicit none
   private

   public :: legend_t, make_legends, fitted, column_room, page_room

   !> Text for one result
   type :: legend_t
      !> The text, as a figure takes it
      character(len=:), allocatable :: text
      !> Whether the user gave it
      logical :: given = .false.
   end type legend_t

   !> Most keys that a text names
   integer, parameter :: most_differences = 3
   !> Letters of a text that fit in a figure of one column, and of a page
   integer, parameter :: column_room = 40, page_room = 90

contains

   !> Texts for all results
   subroutine make_legends(results, legends)
      !> Results, shape (n)
      type(result_t), intent(in) :: results(:)
      !> Their texts, shape (n)
      type(legend_t), allocatable, intent(out) :: legends(:)

      integer :: i

      allocate (legends(size(results)))
      do i = 1, size(results)
         legends(i)%text = results(i)%title
      end do
      if (.not. are_distinct(legends)) call describe_differences(results, legends)
      if (.not. are_distinct(legends)) then
         do i = 1, size(results)
            legends(i)%text = printable(results(i)%stem)
         end do
      end if
      if (.not. are_distinct(legends)) then
         do i = 1, size(results)
            legends(i)%text = results(i)%path
         end do
      end if
      call drop_beginning(legends)
   end subroutine make_legends

   !> Whether all texts differ and none is empty
   pure function are_distinct(legends) result(yes)
      !> The texts
      type(legend_t), intent(in) :: legends(:)
      !> True if they do
      logical :: yes

      integer :: i, j

      yes = .true.
      do i = 1, size(legends)
         yes = yes .and. legends(i)%text /= ''
         do j = 1, i - 1
            yes = yes .and. legends(i)%text /= legends(j)%text
         end do
      end do
   end function are_distinct

   !> Leave out the words with which all texts begin, where one is too long for a column
   pure subroutine drop_beginning(legends)
      !> Texts that differ
      type(legend_t), intent(inout) :: legends(:)

      integer :: i, j, last

      if (size(legends) < 2) return
      last = len(legends(1)%text)
      do i = 1, size(legends)
         last = min(last, len(legends(i)%text))
      end do
      if (.not. any([(len(legends(i)%text) > column_room, i=1, size(legends))])) return
      do j = last, 1, -1
         if (legends(1)%text(j:j) /= ' ') cycle
         if (all([(legends(i)%text(:j) == legends(1)%text(:j), i=1, size(legends))])) exit
      end do
      do i = 1, size(legends)
         legends(i)%text = legends(i)%text(j + 1:)
      end do
   end subroutine drop_beginning

   !> A text that has its place, as a figure takes it
   pure function fitted(text, room) result(short)
      !> UTF-8
      character(len=*), intent(in) :: text
      !> Letters that there is room for
      integer, intent(in) :: room
      !> The text, or its beginning and three dots
      character(len=:), allocatable :: short

      integer :: i, letters

      short = plain(text)
      letters = 0
      do i = 1, len_trim(text)
         if (ichar(text(i:i)) >= 128 .and. ichar(text(i:i)) < 192) cycle
         letters = letters + 1
         if (letters == max(room, 4)) short = plain(text(:i - 1))//'…'
      end do
      if (letters <= max(room, 4)) short = plain(text)
   end function fitted

   !> Texts of what differs in the cases: the lines of all cases, as they are printed with all
   !> defaults, are the same but for a few values
   subroutine describe_differences(results, legends)
      !> Results, shape (n)
      type(result_t), intent(in) :: results(:)
      !> Texts, all empty where the cases differ in more than a few values
      type(legend_t), intent(inout) :: legends(:)

      character(len=:), allocatable :: line, other
      integer :: count, i, j, lines
      logical :: differs

      do i = 1, size(legends)
         legends(i)%text = ''
      end do
      lines = line_count(results(1)%case_text)
      do i = 2, size(results)
         if (line_count(results(i)%case_text) /= lines) return
      end do
      count = 0
      do j = 1, lines
         line = line_of(results(1)%case_text, j)
         differs = .false.
         do i = 2, size(results)
            other = line_of(results(i)%case_text, j)
            if (key_of(other) /= key_of(line)) count = most_differences + 1
            differs = differs .or. other /= line
         end do
         if (.not. differs .or. index(' title stem directory ', ' '//key_of(line)//' ') > 0) cycle
         count = count + 1
         if (count > most_differences) exit
         do i = 1, size(results)
            if (count > 1) legends(i)%text = legends(i)%text//', '
            legends(i)%text = legends(i)%text//described(line_of(results(i)%case_text, j))
         end do
      end do
      if (count <= most_differences) return
      do i = 1, size(legends)
         legends(i)%text = ''
      end do
   end subroutine describe_differences

   !> Number of lines of a text
   pure function line_count(text) result(count)
      !> Lines, each with its end
      character(len=*), intent(in) :: text
      !> Number
      integer :: count

      integer :: i

      count = 0
      do i = 1, len(text)
         if (text(i:i) == new_line('a')) count = count + 1
      end do
   end function line_count

   !> A line of a text
   pure function line_of(text, number) result(line)
      !> Lines, each with its end
      character(len=*), intent(in) :: text
      !> Its number, from 1
      integer, intent(in) :: number
      !> The line without blanks around it and without its end
      character(len=:), allocatable :: line

      integer :: first, i, length

      first = 1
      do i = 2, number
         first = first + index(text(first:), new_line('a'))
      end do
      length = index(text(first:)//new_line('a'), new_line('a')) - 1
      line = trim(adjustl(text(first:first + length - 1)))
   end function line_of

   !> Key of a line `key = value`
   pure function key_of(line) result(key)
      character(len=*), intent(in) :: line
      !> What stands before the sign; the line where there is none
      character(len=:), allocatable :: key

      integer :: mark

      mark = index(line, '=')
      key = line
      if (mark > 1) key = trim(line(:mark - 1))
   end function key_of

   !> A line `key = value` with the unit of the key, its number in short
   function described(line) result(text)
      character(len=*), intent(in) :: line
      character(len=:), allocatable :: text

      real(wp) :: number
      character(len=:), allocatable :: value
      integer :: i, mark, status

      mark = index(line, '=')
      text = line
      if (mark < 2) return
      value = trim(adjustl(line(mark + 1:)))
      text = key_of(line)//' = '
      if (verify(value, '0123456789.+-eE') > 0) then
         text = text//value
         return
      end if
      read (value, *, iostat=status) number
      if (status /= 0) then
         text = text//value
         return
      end if
      text = text//number_text(number, 6)
      do i = 1, size(catalogue)
         if (catalogue(i)%name /= key_of(line)) cycle
         if (catalogue(i)%unit /= '') text = text//' '//trim(catalogue(i)%unit)
         exit
      end do
   end function described

end module vcor_figure_legend
