!> Axes of gnuplot scripts: ranges, ticks and labels; texts and numbers as gnuplot reads them
module vcor_io_gnuplot_axis
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_io_figure, only : figure_axis_t, panel_t
   use vcor_io_layout, only : letter_width
   use vcor_kinds, only : wp
   use vcor_buffer, only : buffer_t
   use vcor_text, only : printable, real_text
   implicit none
   private

   public :: put_axis, across, along, in_quotes, number

   !> End of a line
   character(len=*), parameter :: nl = new_line("a")
   !> Decades of a logarithmic axis from which on only powers of ten are labelled
   real(wp), parameter :: many_decades = 2.5_wp
   !> Decades up to which it is drawn linear, as it would have hardly a label
   real(wp), parameter :: few_decades = 0.7_wp

   !> Most steps from tick to tick on a linear horizontal axis
   real(wp), parameter :: most_steps = 10.0_wp
   !> Least room between the labels of two ticks beside each other [cm]
   real(wp), parameter :: gap = 0.2_wp

   !> Room below and above the values on a vertical logarithmic axis, as a share of its length
   real(wp), parameter :: margin = 0.04_wp

contains

   !> Range of the horizontal values of a panel
   pure function across(panel) result(range)
      type(panel_t), intent(in) :: panel
      !> Least and largest
      real(wp) :: range(2)
      integer :: i

      range = [huge(1.0_wp), -huge(1.0_wp)]
      do i = 1, panel%curve_count
         call widen(range, panel%curves(i)%x)
      end do
   end function across

   !> Range of the vertical values of a panel
   pure function along(panel, at_right) result(range)
      type(panel_t), intent(in) :: panel
      !> Of which axis
      logical, intent(in) :: at_right
      !> Least and largest
      real(wp) :: range(2)
      integer :: i

      range = [huge(1.0_wp), -huge(1.0_wp)]
      do i = 1, panel%curve_count
         if (panel%curves(i)%at_right .eqv. at_right) call widen(range, panel%curves(i)%y)
      end do
   end function along

   !> Widen a range to hold some values
   pure subroutine widen(range, values)
      !> Least and largest
      real(wp), intent(inout) :: range(2)
      !> Values; what is not finite does not count
      real(wp), intent(in) :: values(:)
      integer :: i

      do i = 1, size(values)
         if (.not. ieee_is_finite(values(i))) cycle
         range(1) = min(range(1), values(i))
         range(2) = max(range(2), values(i))
      end do
   end subroutine widen

   !> Label, scale, range and ticks of an axis
   subroutine put_axis(buffer, name, axis, range, length)
      !> The script
      type(buffer_t), intent(inout) :: buffer
      !> x, y or y2
      character(len=*), intent(in) :: name
      type(figure_axis_t), intent(in) :: axis
      !> Least and largest value of the data
      real(wp), intent(in) :: range(2)
      !> Length of a horizontal axis, beside which its labels have to find room [cm]; 0 of others
      real(wp), intent(in) :: length
      real(wp) :: ends(2)

      call buffer%add("set "//name//"label "//in_quotes(axis%label))
      if (name == "x") call buffer%add(" offset 0, 0.4")
      call buffer%add(nl)
      ends = range
      if (axis%upper > axis%lower) ends = [axis%lower, axis%upper]
      if (.not. axis%is_log) then
         if (axis%upper > axis%lower .or. (name == "x" .and. ends(2) > ends(1))) then
            ! a range that begins near zero begins there
            if (name == "x" .and. ends(1) > 0.0_wp .and. ends(1) < 0.1_wp*ends(2) &
               & .and. .not. axis%upper > axis%lower) ends(1) = 0.0_wp
            call buffer%add("set "//name//"range ["//number(ends(1))//":" &
               & //number(ends(2))//"]"//nl)
         else
            call buffer%add("set "//name//"range [*:*]"//nl)
         end if
         call put_linear_ticks(buffer, name, ends, length)
         return
      end if

      if (.not. ends(2) > ends(1)) then
         call buffer%add("set logscale "//name//nl//"set "//name//"range [*:*]"//nl)
         return
      end if
      ! lines do not run along the frame
      if (name /= "x" .and. .not. axis%upper > axis%lower) &
         & ends = ends*(ends(2)/ends(1))**[-margin, margin]
      call buffer%add("set "//name//"range ["//number(ends(1))//":"//number(ends(2))//"]"//nl)
      if (log10(ends(2)/ends(1)) <= few_decades) then
         call put_linear_ticks(buffer, name, ends, length)
         return
      end if
      call buffer%add("set logscale "//name//nl)
      if (log10(ends(2)/ends(1)) >= many_decades) then
         call buffer%add("set format "//name//" '10^{%L}'"//nl//"set "//name//"tics autofreq"//nl)
         return
      end if
      call buffer%add("set format "//name//" '%g'"//nl//"set "//name//"tics (" &
         & //decade_ticks(ends, length)//")"//nl)
   end subroutine put_axis

   !> Ticks of a linear axis; on a horizontal one in steps of 1, 2 or 5 that leave room for their
   !> labels
   subroutine put_linear_ticks(buffer, name, ends, length)
      !> The script
      type(buffer_t), intent(inout) :: buffer
      !> x, y or y2
      character(len=*), intent(in) :: name
      !> Where the axis begins and ends
      real(wp), intent(in) :: ends(2)
      !> Length of a horizontal axis [cm]; 0 of others
      real(wp), intent(in) :: length
      real(wp), parameter :: steps(3) = [1.0_wp, 2.0_wp, 5.0_wp]
      character(len=:), allocatable :: step_text
      real(wp) :: step
      integer :: i, power

      step_text = "autofreq"
      if (length > 0.0_wp .and. ends(2) > ends(1)) then
         power = floor(log10(ends(2) - ends(1))) - 1
         i = 1
         do
            step = steps(i)*10.0_wp**power
            if (ends(2) - ends(1) <= most_steps*step .and. label_room(ends, step) &
               & <= length*step/(ends(2) - ends(1))) exit
            i = mod(i, size(steps)) + 1
            if (i == 1) power = power + 1
         end do
         step_text = number(step)
      end if
      call buffer%add("set format "//name//" '%g'"//nl//"set "//name//"tics "//step_text//nl)
   end subroutine put_linear_ticks

   !> Ticks of a logarithmic axis of few decades: 1, 2, 5, 10 ..., as powers of ten alone would be
   !> too few; 1, 3, 10 ... or these where there is no room for more
   pure function decade_ticks(ends, length) result(ticks)
      !> Where the axis begins and ends
      real(wp), intent(in) :: ends(2)
      !> Length of a horizontal axis [cm]; 0 of others
      real(wp), intent(in) :: length
      !> The ticks, with commas between them
      character(len=:), allocatable :: ticks
      real(wp), parameter :: steps(3, 3) = reshape([1.0_wp, 2.0_wp, 5.0_wp, 1.0_wp, 3.0_wp, &
         & 0.0_wp, 1.0_wp, 0.0_wp, 0.0_wp], [3, 3])
      ! Decades between the two ticks that are nearest to each other
      real(wp), parameter :: apart(3) = [log10(2.0_wp), log10(3.0_wp), 1.0_wp]
      real(wp) :: tick, wide
      integer :: choice, i, power

      wide = max(label_room(ends, 10.0_wp**floor(log10(ends(1)))), label_room(ends, ends(1)))
      do choice = 1, size(apart) - 1
         if (.not. length > 0.0_wp) exit
         if (wide <= length*apart(choice)/log10(ends(2)/ends(1))) exit
      end do
      ticks = ""
      do power = floor(log10(ends(1))), ceiling(log10(ends(2)))
         do i = 1, size(steps, 1)
            tick = steps(i, choice)*10.0_wp**power
            if (tick < ends(1)*(1.0_wp - 1.0e-9_wp) .or. tick > ends(2)*(1.0_wp + 1.0e-9_wp)) cycle
            if (ticks /= "") ticks = ticks//", "
            ticks = ticks//number(tick)
         end do
      end do
   end function decade_ticks

   !> Width of the longest label on an axis, and of the gap to the next
   pure function label_room(ends, step) result(room)
      !> Where the axis begins and ends
      real(wp), intent(in) :: ends(2)
      !> From tick to tick
      real(wp), intent(in) :: step
      !> Room [cm]
      real(wp) :: room
      integer :: i, letters, longest, of_end, of_step

      longest = 1
      of_step = floor(log10(step) + 1.0e-9_wp)
      do i = 1, 2
         if (.not. abs(ends(i)) > 0.0_wp) cycle
         of_end = max(of_step, floor(log10(abs(ends(i)))))
         if (of_end < -4 .or. of_end >= 6) then
            ! as 1.25e-07
            letters = 5 + of_end - of_step + merge(1, 0, of_end > of_step)
         else
            letters = max(1, of_end + 1) + max(0, -of_step) + merge(1, 0, of_step < 0)
         end if
         if (ends(i) < 0.0_wp) letters = letters + 1
         longest = max(longest, letters)
      end do
      room = real(longest, wp)*letter_width + gap
   end function label_room

   !> A text as gnuplot reads it
   pure function in_quotes(text) result(between)
      !> Any text
      character(len=*), intent(in) :: text
      !> The text on one line, without control characters, in single quotes: nothing has a meaning
      !> there, neither a backslash nor a command between backticks. Single quotes are in double
      !> ones, since gnuplot 5.4 stumbles over two of them doubled
      character(len=:), allocatable :: between
      character(len=len_trim(text)) :: shown
      integer :: i

      shown = printable(text)
      between = "'"
      do i = 1, len(shown)
         if (shown(i:i) == "'") then
            between = between//"'.""'"".'"
         else
            between = between//shown(i:i)
         end if
      end do
      between = between//"'"
   end function in_quotes

   !> A number with ten digits
   pure function number(value) result(text)
      real(wp), intent(in) :: value
      !> Its shortest text, `NaN` where it is not finite
      character(len=:), allocatable :: text
      character(len=24) :: buffer
      real(wp) :: rounded

      rounded = value
      if (ieee_is_finite(value)) then
         write(buffer, "(es24.9e3)") value
         read(buffer, *) rounded
      end if
      text = real_text(rounded)
   end function number

end module vcor_io_gnuplot_axis
