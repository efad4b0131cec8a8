!> Figures as gnuplot scripts: the text of the script and of its data
!>
!> The layout is made here in centimetres, at the size of print: 8.5 cm wide, a column, or 17 cm, a
!> page, with letters of 8 points; nothing is left to gnuplot's own margins. The script finds its
!> data beside itself wherever it is called from. Nothing in a script or in an SVG file depends on
!> the time or the machine.
!>
!> Gnuplot 5.4 and later. Curves differ in colour, in lightness and in dashes or markers, so that
!> they can be told apart in print without colour.
module vcor_io_gnuplot
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_io_figure, only : curve_t, figure_axis_t, figure_t, line_ghost, line_grid, note_right, &
      & note_top, panel_t, points_only, shape_filled, style_count
   use vcor_kinds, only : wp
   use vcor_study_buffer, only : buffer_t
   use vcor_study_text, only : integer_text
   use vcor_version, only : version
   implicit none
   private

   public :: script_text, data_text, formats

   !> Known formats of figures
   character(len=*), parameter :: formats = "svg pdf png"

   !> End of a line
   character(len=*), parameter :: nl = new_line("a")
   !> Widths of a figure: a column, a page [cm]
   real(wp), parameter :: column_width = 8.5_wp, page_width = 17.0_wp
   !> Height of a pair of axes [cm]
   real(wp), parameter :: body_height = 5.2_wp
   !> Margins below, left, above and right of it where nothing is written there [cm]
   real(wp), parameter :: bottom = 1.1_wp, left = 1.6_wp, top = 0.25_wp, right = 0.4_wp
   !> Margins right of it with an axis or notes there [cm]
   real(wp), parameter :: right_axis = 1.6_wp, right_notes = 2.1_wp
   !> From one line of text to the next [cm]
   real(wp), parameter :: line_height = 0.42_wp
   !> Width of a letter, on the wide side [cm]
   real(wp), parameter :: letter_width = 0.165_wp
   !> Width of the sample of a line and what is around a text of the legend [cm]
   real(wp), parameter :: sample_width = 1.1_wp
   !> Decades of a logarithmic axis from which on only powers of ten are labelled
   real(wp), parameter :: many_decades = 2.5_wp

   !> Colours of the styles, each of a lightness of its own
   character(len=7), parameter :: colours(style_count) = [character(len=7) :: "#000000", &
      & "#c4470e", "#2f78b5", "#e0a020", "#6a3d7c", "#4fa36b", "#8fbfe8", "#8c8c8c"]
   !> Dashes of the styles
   character(len=14), parameter :: dashes(style_count) = [character(len=14) :: "1", "'-'", &
      & "(14,3,2,3)", "'.'", "(16,4)", "(8,3,2,3,2,3)", "1", "(4,4)"]
   !> Markers of the styles
   integer, parameter :: markers(style_count) = [7, 5, 9, 13, 6, 4, 8, 12]
   !> Lightest and darkest colour of filled shapes, red, green, blue
   real(wp), parameter :: lightest(3) = [250.0_wp, 251.0_wp, 253.0_wp]
   real(wp), parameter :: darkest(3) = [76.0_wp, 132.0_wp, 184.0_wp]

   !> Where a panel is on the page, in screen coordinates from 0 to 1
   type :: frame_t
      !> Its edges
      real(wp) :: left, right, bottom, top
      !> Left edge of its legend and its upper edge
      real(wp) :: legend_left, legend_top
      !> Texts of the legend beside each other
      integer :: legend_columns
   end type frame_t

contains

   !> Text of the script
   function script_text(figure, name, format) result(text)
      !> The figure
      type(figure_t), intent(in) :: figure
      !> Name of its files, without folder and extension
      character(len=*), intent(in) :: name
      !> One of `formats`
      character(len=*), intent(in) :: format
      !> The script
      character(len=:), allocatable :: text
      type(buffer_t) :: buffer
      type(frame_t) :: frames(size(figure%panels))
      real(wp) :: height, width
      integer :: first, i

      call lay_out(figure, frames, width, height)
      call buffer%add("# vcor "//version//": "//figure%subject//nl &
         & //"# Data: "//name//".dat. To draw it again: gnuplot "//name//".gp"//nl//nl)
      call buffer%add("slash(s, i) = i == 0 ? 0 : s[i:i] eq '/' ? i : slash(s, i - 1)"//nl &
         & //"here = exists('ARG0') ? ARG0[1:slash(ARG0, strlen(ARG0))] : ''"//nl &
         & //"data = here."//in_quotes(name//".dat")//nl//nl &
         & //"set encoding utf8"//nl)
      first = 1
      do i = 1, (len(formats) + 1)/4
         if (formats(first:first+2) /= format) call buffer%add("# ")
         call buffer%add(terminal(formats(first:first+2), width, height)//nl)
         first = first + 4
      end do
      call buffer%add("set output here."//in_quotes(name//"."//format)//nl//nl)
      do i = 1, style_count
         call buffer%add("set style line "//integer_text(i)//" lc rgb '"//colours(i) &
            & //"' lw 1.5 pt "//integer_text(markers(i))//" ps 0.55 dt "//trim(dashes(i))//nl)
      end do
      call buffer%add("set border lw 0.7"//nl//"set tics scale 0.6 front"//nl &
         & //"set style textbox opaque noborder margins 0.4, 0.2"//nl)
      if (size(figure%panels) > 1) call buffer%add("set multiplot"//nl)
      first = 0
      do i = 1, size(figure%panels)
         call put_panel(buffer, figure%panels(i), frames(i), first)
         first = first + figure%panels(i)%curve_count
      end do
      if (size(figure%panels) > 1) call buffer%add(nl//"unset multiplot"//nl)
      call buffer%add("unset output"//nl)
      text = buffer%text()
   end function script_text

   !> Text of the data: a block per curve, blocks apart by two empty lines
   function data_text(figure) result(text)
      !> The figure
      type(figure_t), intent(in) :: figure
      !> The data
      character(len=:), allocatable :: text
      type(buffer_t) :: buffer
      character(len=40) :: line
      integer :: count, i, j, k

      call buffer%add("# vcor "//version//": "//figure%subject//nl)
      count = 0
      do i = 1, size(figure%panels)
         associate (panel => figure%panels(i))
            do j = 1, panel%curve_count
               associate (curve => panel%curves(j))
                  call buffer%add("# "//integer_text(count)//": "//panel%x%label//", ")
                  if (curve%at_right) then
                     call buffer%add(panel%right%label)
                  else
                     call buffer%add(panel%y%label)
                  end if
                  if (curve%title /= "") call buffer%add(", "//curve%title)
                  call buffer%add(nl)
                  do k = 1, size(curve%x)
                     line = number(curve%x(k))
                     line(21:) = number(curve%y(k))
                     call buffer%add(trim(line)//nl)
                  end do
                  call buffer%add(nl//nl)
               end associate
               count = count + 1
            end do
         end associate
      end do
      text = buffer%text()
   end function data_text

   !> Places of all panels and of their legends
   pure subroutine lay_out(figure, frames, width, height)
      !> The figure
      type(figure_t), intent(in) :: figure
      !> Places, shape (number of panels)
      type(frame_t), intent(out) :: frames(:)
      !> Size of the figure [cm]
      real(wp), intent(out) :: width, height
      real(wp) :: above(size(figure%panels)), cell, high, shared, wide
      integer :: first, i, last, rows
      logical :: is_shared

      width = merge(page_width, column_width, figure%columns > 1)
      cell = width/real(figure%columns, wp)
      is_shared = size(figure%panels) > 1
      do i = 2, size(figure%panels)
         is_shared = is_shared .and. title_count(figure%panels(i)) == 0
      end do

      ! What stands above the axes: heading, notes, legend
      shared = 0.0_wp
      do i = 1, size(figure%panels)
         associate (panel => figure%panels(i))
            above(i) = top
            if (has_note(panel, note_top)) above(i) = above(i) + line_height
            if (panel%heading /= "") above(i) = above(i) + line_height
            wide = merge(width, cell, is_shared) - left - right
            call arrange(panel, wide, frames(i)%legend_columns, rows)
            if (is_shared .and. i == 1) then
               shared = real(rows, wp)*line_height
            else if (.not. is_shared) then
               above(i) = above(i) + real(rows, wp)*line_height
            end if
         end associate
      end do

      high = shared + merge(top, 0.0_wp, is_shared)
      do first = 1, size(figure%panels), figure%columns
         last = min(first + figure%columns - 1, size(figure%panels))
         do i = first, last
            associate (frame => frames(i))
               frame%left = real(i - first, wp)*cell + left
               frame%right = real(i - first + 1, wp)*cell - right_of(figure%panels(i))
               frame%legend_left = frame%left - 0.1_wp
               frame%legend_top = high + 0.15_wp
               if (is_shared) frame%legend_top = 0.15_wp
               frame%top = high + maxval(above(first:last))
               frame%bottom = frame%top + body_height
            end associate
         end do
         high = high + maxval(above(first:last)) + body_height + bottom
      end do
      height = high

      do i = 1, size(frames)
         frames(i)%left = frames(i)%left/width
         frames(i)%right = frames(i)%right/width
         frames(i)%legend_left = frames(i)%legend_left/width
         frames(i)%bottom = 1.0_wp - frames(i)%bottom/height
         frames(i)%top = 1.0_wp - frames(i)%top/height
         frames(i)%legend_top = 1.0_wp - frames(i)%legend_top/height
      end do
   end subroutine lay_out

   !> Columns and rows of a legend
   pure subroutine arrange(panel, width, columns, rows)
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Width that there is [cm]
      real(wp), intent(in) :: width
      !> Texts beside each other, at least 1
      integer, intent(out) :: columns
      !> Rows of texts
      integer, intent(out) :: rows
      integer :: count, i, longest

      count = title_count(panel)
      longest = 1
      do i = 1, panel%curve_count
         longest = max(longest, letter_count(panel%curves(i)%title))
      end do
      columns = max(1, min(count, int(width/(real(longest, wp)*letter_width + sample_width))))
      rows = (count + columns - 1)/columns
   end subroutine arrange

   !> Number of texts in the legend
   pure function title_count(panel) result(count)
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Number
      integer :: count
      integer :: i

      count = 0
      do i = 1, panel%curve_count
         if (panel%curves(i)%title /= "") count = count + 1
      end do
   end function title_count

   !> Letters of a text as it is drawn
   pure function letter_count(text) result(count)
      !> UTF-8 with marks for subscripts
      character(len=*), intent(in) :: text
      !> Number of letters
      integer :: count
      integer :: i

      count = 0
      do i = 1, len(text)
         if (ichar(text(i:i)) >= 128 .and. ichar(text(i:i)) < 192) cycle
         if (scan(text(i:i), "_^{}\") == 0) count = count + 1
      end do
   end function letter_count

   !> Whether a panel has a note at some place
   pure function has_note(panel, place) result(has)
      !> The panel
      type(panel_t), intent(in) :: panel
      !> One of the `note_*` constants
      integer, intent(in) :: place
      !> True if it has
      logical :: has

      has = any(panel%notes(:panel%note_count)%place == place)
   end function has_note

   !> Margin right of a panel
   pure function right_of(panel) result(margin)
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Margin [cm]
      real(wp) :: margin

      margin = right
      if (panel%right%label /= "") margin = right_axis
      if (has_note(panel, note_right)) margin = right_notes
   end function right_of

   !> Command that sets the format and the size
   function terminal(format, width, height) result(text)
      !> One of `formats`
      character(len=*), intent(in) :: format
      !> Size [cm]
      real(wp), intent(in) :: width, height
      !> The command
      character(len=:), allocatable :: text
      ! Pixels of an SVG file are 1/96 inch; PNG has 300 to an inch, gnuplot takes 72 for granted
      real(wp), parameter :: svg_pixels = 96.0_wp/2.54_wp, png_pixels = 300.0_wp/2.54_wp

      select case (format)
      case ("svg")
         text = "set terminal svg enhanced size "//integer_text(nint(width*svg_pixels))//"," &
            & //integer_text(nint(height*svg_pixels))//" font 'Arial,10.5' linewidth 1.0 " &
            & //"background 'white'"
      case ("pdf")
         text = "set terminal pdfcairo enhanced size "//short(width)//"cm,"//short(height) &
            & //"cm font 'Arial,8' fontscale 1.0 linewidth 1.5"
      case default
         text = "set terminal pngcairo enhanced size "//integer_text(nint(width*png_pixels))//"," &
            & //integer_text(nint(height*png_pixels))//" font 'Arial,8' fontscale 4.17 " &
            & //"linewidth 3.1 pointscale 3.1 background 'white'"
      end select
   end function terminal

   !> One panel
   subroutine put_panel(buffer, panel, frame, first)
      !> The script
      type(buffer_t), intent(inout) :: buffer
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Its place
      type(frame_t), intent(in) :: frame
      !> Number of curves in the panels before
      integer, intent(in) :: first
      integer :: i

      call buffer%add(nl//"unset label"//nl//"unset arrow"//nl//"unset logscale"//nl &
         & //"set lmargin at screen "//short(frame%left)//nl &
         & //"set rmargin at screen "//short(frame%right)//nl &
         & //"set bmargin at screen "//short(frame%bottom)//nl &
         & //"set tmargin at screen "//short(frame%top)//nl)
      if (title_count(panel) > 0) then
         call buffer%add("set key at screen "//short(frame%legend_left)//", screen " &
            & //short(frame%legend_top)//" left top horizontal Left reverse samplen 2.2 maxcols " &
            & //integer_text(frame%legend_columns)//nl)
      else
         call buffer%add("unset key"//nl)
      end if
      call put_axis(buffer, "x", panel%x, across(panel))
      call put_axis(buffer, "y", panel%y, along(panel, .false.))
      if (panel%right%label /= "") then
         call buffer%add("set ytics nomirror"//nl//"set y2tics"//nl)
         call put_axis(buffer, "y2", panel%right, along(panel, .true.))
      else
         call buffer%add("set ytics mirror"//nl//"unset y2tics"//nl//"unset y2label"//nl)
      end if
      call put_notes(buffer, panel)
      if (panel%heading /= "") call buffer%add("set label "//in_quotes(panel%heading) &
         & //" at graph 0.5, graph 1 center offset 0, 0.7"//nl)

      call buffer%add("plot")
      do i = 1, panel%curve_count
         if (i > 1) call buffer%add(",")
         call buffer%add(" \"//nl//"   data index "//integer_text(first + i - 1)//" using 1:2" &
            & //drawn(panel, panel%curves(i), i))
      end do
      call buffer%add(nl)
   end subroutine put_panel

   !> How a curve is drawn
   function drawn(panel, curve, place) result(text)
      !> Its panel
      type(panel_t), intent(in) :: panel
      !> The curve
      type(curve_t), intent(in) :: curve
      !> Its number in the panel
      integer, intent(in) :: place
      !> The end of its plot command
      character(len=:), allocatable :: text
      integer, parameter :: marker_count = 9
      integer :: every

      select case (curve%form)
      case (line_ghost)
         text = " with lines ls "//integer_text(curve%style)//" dt (7,5) lw 1.2"
      case (line_grid)
         text = " with lines lt 1 lw 0.7 lc rgb '#303030'"
      case (shape_filled)
         text = " with filledcurves closed fs solid 1 noborder fc rgb '"//shade(curve%style)//"'"
      case (points_only)
         text = " with points ls "//integer_text(curve%style)//" pt 7 ps 0.7"
      case default
         text = " with lines ls "//integer_text(curve%style)
         if (panel%with_markers) then
            every = max(1, size(curve%x)/marker_count)
            text = " with linespoints ls "//integer_text(curve%style)//" dt 1 pointinterval " &
               & //integer_text(every + mod(place, 3))
         end if
      end select
      if (curve%at_right) text = " axes x1y2"//text
      text = text//" title "//in_quotes(curve%title)
      if (curve%title == "") text = text(:len(text)-len(" title ''"))//" notitle"
   end function drawn

   !> Colour of a filled shape
   pure function shade(percent) result(colour)
      !> From the lightest, 0, to the darkest, 100
      integer, intent(in) :: percent
      !> As gnuplot writes it
      character(len=7) :: colour
      integer :: parts(3)

      parts = nint(lightest + (darkest - lightest)*0.01_wp*real(percent, wp))
      write(colour, "('#', 3z2.2)") parts
   end function shade

   !> Notes of a panel
   subroutine put_notes(buffer, panel)
      !> The script
      type(buffer_t), intent(inout) :: buffer
      !> The panel
      type(panel_t), intent(in) :: panel
      character(len=*), parameter :: thin = " nohead lw 0.6 lc rgb '#707070' dt '.' back"
      real(wp) :: heights(panel%note_count), apart
      integer :: i

      heights = panel%notes(:panel%note_count)%y
      ! Texts at the right stay a line apart
      if (panel%y%upper > panel%y%lower) then
         apart = 1.05_wp*line_height/body_height*(panel%y%upper - panel%y%lower)
         call spread_out(heights, panel%notes(:panel%note_count)%place == note_right, apart)
      end if
      do i = 1, panel%note_count
         associate (note => panel%notes(i))
            select case (note%place)
            case (note_right)
               call buffer%add("set arrow from first "//trim(number(note%x))//", first " &
                  & //trim(number(note%y))//" to graph 1, first "//trim(number(note%y))//thin//nl &
                  & //"set label "//in_quotes(note%text)//" at graph 1.02, first " &
                  & //trim(number(heights(i)))//" left"//nl)
            case (note_top)
               call buffer%add("set arrow from first "//trim(number(note%x))//", graph 0 to first " &
                  & //trim(number(note%x))//", graph 1"//thin//nl &
                  & //"set label "//in_quotes(note%text)//" at first "//trim(number(note%x)) &
                  & //", graph 1 center offset 0, 0.6"//nl)
            case default
               call buffer%add("set label "//in_quotes(note%text)//" at first " &
                  & //trim(number(note%x))//", first "//trim(number(note%y)) &
                  & //" center boxed front"//nl)
            end select
         end associate
      end do
   end subroutine put_notes

   !> Move heights that are too near to each other apart, each pair about its middle
   pure subroutine spread_out(heights, takes_part, apart)
      !> Heights, shape (n)
      real(wp), intent(inout) :: heights(:)
      !> Which ones count, shape (n)
      logical, intent(in) :: takes_part(:)
      !> Least distance
      real(wp), intent(in) :: apart
      real(wp) :: middle
      integer :: i, j

      do i = 1, size(heights)
         do j = i + 1, size(heights)
            if (.not. (takes_part(i) .and. takes_part(j))) cycle
            if (abs(heights(i) - heights(j)) >= apart) cycle
            middle = 0.5_wp*(heights(i) + heights(j))
            if (heights(i) >= heights(j)) then
               heights(i) = middle + 0.5_wp*apart
               heights(j) = middle - 0.5_wp*apart
            else
               heights(i) = middle - 0.5_wp*apart
               heights(j) = middle + 0.5_wp*apart
            end if
         end do
      end do
   end subroutine spread_out

   !> Range of the horizontal values of a panel
   pure function across(panel) result(range)
      !> The panel
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
      !> The panel
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
   subroutine put_axis(buffer, name, axis, range)
      !> The script
      type(buffer_t), intent(inout) :: buffer
      !> x, y or y2
      character(len=*), intent(in) :: name
      !> The axis
      type(figure_axis_t), intent(in) :: axis
      !> Least and largest value of the data
      real(wp), intent(in) :: range(2)
      real(wp), parameter :: steps(3) = [1.0_wp, 2.0_wp, 5.0_wp]
      character(len=:), allocatable :: ticks
      real(wp) :: ends(2), tick
      integer :: i, power

      call buffer%add("set "//name//"label "//in_quotes(axis%label)//nl)
      ends = range
      if (axis%upper > axis%lower) ends = [axis%lower, axis%upper]
      if (.not. axis%is_log) then
         if (axis%upper > axis%lower .or. (name == "x" .and. ends(2) > ends(1))) then
            call buffer%add("set "//name//"range ["//trim(number(ends(1)))//":" &
               & //trim(number(ends(2)))//"]"//nl)
         else
            call buffer%add("set "//name//"range [*:*]"//nl)
         end if
         call buffer%add("set format "//name//" '%g'"//nl//"set "//name//"tics autofreq"//nl)
         return
      end if

      call buffer%add("set logscale "//name//nl)
      if (.not. ends(2) > ends(1)) then
         call buffer%add("set "//name//"range [*:*]"//nl)
         return
      end if
      call buffer%add("set "//name//"range ["//trim(number(ends(1)))//":"//trim(number(ends(2))) &
         & //"]"//nl)
      if (log10(ends(2)/ends(1)) >= many_decades) then
         call buffer%add("set format "//name//" '10^{%L}'"//nl//"set "//name//"tics autofreq"//nl)
         return
      end if
      ! 1, 2, 5, 10 ...: powers of ten alone would be too few
      ticks = ""
      do power = floor(log10(ends(1))), ceiling(log10(ends(2)))
         do i = 1, size(steps)
            tick = steps(i)*10.0_wp**power
            if (tick < ends(1)*(1.0_wp - 1.0e-9_wp) .or. tick > ends(2)*(1.0_wp + 1.0e-9_wp)) cycle
            if (ticks /= "") ticks = ticks//", "
            ticks = ticks//trim(number(tick))
         end do
      end do
      call buffer%add("set format "//name//" '%g'"//nl//"set "//name//"tics ("//ticks//")"//nl)
   end subroutine put_axis

   !> A text as gnuplot reads it
   pure function in_quotes(text) result(between)
      !> Any text of one line
      character(len=*), intent(in) :: text
      !> The text in single quotes
      character(len=:), allocatable :: between
      integer :: i

      between = "'"
      do i = 1, len_trim(text)
         between = between//text(i:i)
         if (text(i:i) == "'") between = between//"'"
      end do
      between = between//"'"
   end function in_quotes

   !> A number with ten digits
   pure function number(value) result(text)
      !> The number
      real(wp), intent(in) :: value
      !> Its text, `NaN` where it is not finite
      character(len=18) :: text

      text = "NaN"
      if (ieee_is_finite(value)) then
         write(text, "(es18.9e3)") value
         text = adjustl(text)
      end if
   end function number

   !> A number with four decimals
   pure function short(value) result(text)
      !> The number, 0 to 1000
      real(wp), intent(in) :: value
      !> Its text
      character(len=:), allocatable :: text
      character(len=10) :: buffer

      write(buffer, "(f10.4)") value
      text = trim(adjustl(buffer))
   end function short

end module vcor_io_gnuplot
