!> Figures as gnuplot scripts: the text of the script and of its data
!>
!> The layout comes from `vcor_io_layout`; nothing is left to gnuplot's own margins. The script
!> finds its data beside itself wherever it is called from. Nothing in a script or in an SVG file
!> depends on the time or the machine.
!>
!> A script is a program. What comes from a file of results or from a name stands in it between
!> single quotes (`in_quotes`) or in a remark of one line (`remark`), and file names begin with a
!> slash or a point: gnuplot takes `|name` and `<name` for commands.
!>
!> Gnuplot 5.4 and later. Curves differ in colour, in lightness and in dashes or markers, so that
!> they can be told apart in print without colour.
module vcor_io_gnuplot
   use vcor_io_figure, only : curve_t, figure_t, line_ghost, line_grid, note_right, &
      & note_top, panel_t, points_only, shape_filled, style_count
   use vcor_io_gnuplot_axis, only : across, along, in_quotes, number, put_axis
   use vcor_io_layout, only : body_height, frame_t, lay_out, line_height, title_count
   use vcor_kinds, only : wp
   use vcor_io_path, only : for_shell
   use vcor_buffer, only : buffer_t
   use vcor_text, only : integer_text, printable
   use vcor_version, only : version
   implicit none
   private

   public :: script_text, data_text, formats

   !> Known formats of figures
   character(len=*), parameter :: formats = "svg pdf png"

   !> End of a line
   character(len=*), parameter :: nl = new_line("a")
   !> Colours of the styles, each of a lightness of its own, none so light that a thin line fades
   character(len=7), parameter :: colours(style_count) = [character(len=7) :: "#000000", &
      & "#922c06", "#2e75b2", "#c48a00", "#4a2a60", "#26704a", "#78b4e4", "#a0a0a0"]
   !> Dashes of the styles
   character(len=14), parameter :: dashes(style_count) = [character(len=14) :: "1", "'-'", &
      & "(14,3,2,3)", "(2,3)", "(16,4)", "(8,3,2,3,2,3)", "1", "(4,4)"]
   !> Markers of the styles, filled ones first
   integer, parameter :: markers(style_count) = [7, 5, 9, 13, 6, 4, 8, 12]
   !> Lightest and darkest colour of filled shapes, red, green, blue
   real(wp), parameter :: lightest(3) = [234.0_wp, 241.0_wp, 248.0_wp]
   real(wp), parameter :: darkest(3) = [76.0_wp, 132.0_wp, 184.0_wp]

contains

   !> Text of the script
   function script_text(figure, name, format) result(text)
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
      call buffer%add(remark("vcor "//version//": "//figure%subject) &
         & //remark("Data: "//name//".dat. To draw it again: gnuplot "//for_shell(name//".gp"))//nl)
      call buffer%add("slash(s, i) = i == 0 ? 0 : s[i:i] eq '/' ? i : slash(s, i - 1)"//nl &
         & //"here = exists('ARG0') ? ARG0[1:slash(ARG0, strlen(ARG0))] : ''"//nl &
         & //"here = here[1:1] eq '/' ? here : './'.here"//nl &
         & //"data = here."//in_quotes(name//".dat")//nl//nl &
         & //"set encoding utf8"//nl)
      first = 1
      do i = 1, (len(formats) + 1)/4
         if (formats(first:first+2) /= format) call buffer%add("# ")
         call buffer%add(terminal(formats(first:first+2), width, height)//nl)
         first = first + 4
      end do
      ! Rows of a legend are nearer to each other in the other formats
      call buffer%add("row = GPVAL_TERM eq 'svg' ? 1 : 1.25"//nl)
      call buffer%add("set output here."//in_quotes(name//"."//format)//nl//nl)
      do i = 1, style_count
         call buffer%add("set style line "//integer_text(i)//" lc rgb '"//colours(i) &
            & //"' lw 1.5 pt "//integer_text(markers(i))//" ps 0.65 dt "//trim(dashes(i))//nl)
      end do
      ! an interval below zero clears the ground of a marker, without which open ones look filled
      call buffer%add("set pointintervalbox 0.5"//nl)
      call buffer%add("set border lw 0.7"//nl//"set tics scale 0.6 front"//nl &
         & //"set style textbox opaque noborder margins 0.4, 0.2"//nl)
      if (size(figure%panels) > 1) call buffer%add("set multiplot"//nl)
      first = 0
      do i = 1, size(figure%panels)
         call put_panel(buffer, figure%panels(i), frames(i), width, first)
         first = first + figure%panels(i)%curve_count
      end do
      if (size(figure%panels) > 1) call buffer%add(nl//"unset multiplot"//nl)
      call buffer%add("unset output"//nl)
      text = buffer%text()
   end function script_text

   !> Text of the data: a block per curve, blocks apart by two empty lines
   function data_text(figure) result(text)
      type(figure_t), intent(in) :: figure
      !> The data
      character(len=:), allocatable :: text
      type(buffer_t) :: buffer
      integer :: count, i, j, k

      character(len=:), allocatable :: head

      call buffer%add(remark("vcor "//version//": "//figure%subject))
      count = 0
      do i = 1, size(figure%panels)
         associate (panel => figure%panels(i))
            do j = 1, panel%curve_count
               associate (curve => panel%curves(j))
                  head = integer_text(count)//": "//panel%x%label//", "
                  if (curve%at_right) then
                     head = head//panel%right%label
                  else
                     head = head//panel%y%label
                  end if
                  if (curve%title /= "") head = head//", "//curve%title
                  call buffer%add(remark(head))
                  do k = 1, size(curve%x)
                     call buffer%add(number(curve%x(k))//" "//number(curve%y(k))//nl)
                  end do
                  call buffer%add(nl//nl)
               end associate
               count = count + 1
            end do
         end associate
      end do
      text = buffer%text()
   end function data_text

   !> A remark
   pure function remark(text) result(line)
      !> Any text
      character(len=*), intent(in) :: text
      !> One line, with its end
      character(len=:), allocatable :: line

      ! a backslash at the end would make the next line a part of the remark
      line = "# "//printable(trim(text))//trim(merge(" .", "  ", index(text, "\", back=.true.) &
         & == max(1, len_trim(text))))//nl
   end function remark

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
            & //"cm font 'Arial,8' fontscale 0.75 linewidth 1.5"
      case default
         text = "set terminal pngcairo enhanced size "//integer_text(nint(width*png_pixels))//"," &
            & //integer_text(nint(height*png_pixels))//" font 'Arial,8' fontscale 3.1 " &
            & //"linewidth 3.1 pointscale 3.1 background 'white'"
      end select
   end function terminal

   !> One panel
   subroutine put_panel(buffer, panel, frame, width, first)
      !> The script
      type(buffer_t), intent(inout) :: buffer
      type(panel_t), intent(in) :: panel
      !> Its place
      type(frame_t), intent(in) :: frame
      !> Width of the figure [cm]
      real(wp), intent(in) :: width
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
            & //short(frame%legend_top)//" left top vertical Left reverse samplen 2.2 spacing " &
            & //"row maxrows "//integer_text(frame%legend_rows)//nl)
      else
         call buffer%add("unset key"//nl)
      end if
      call put_axis(buffer, "x", panel%x, across(panel), (frame%right - frame%left)*width)
      call put_axis(buffer, "y", panel%y, along(panel, .false.), 0.0_wp)
      if (panel%right%label /= "") then
         call buffer%add("set ytics nomirror"//nl//"set y2tics scale 0.6"//nl)
         call put_axis(buffer, "y2", panel%right, along(panel, .true.), 0.0_wp)
      else
         call buffer%add("set ytics mirror"//nl//"unset y2tics"//nl//"unset y2label"//nl)
      end if
      if (any(panel%curves(:panel%curve_count)%form == shape_filled)) &
         & call buffer%add("set tics out nomirror"//nl)
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
      type(panel_t), intent(in) :: panel
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
            text = " with linespoints ls "//integer_text(curve%style)//" dt 1 pointinterval -" &
               & //integer_text(every + mod(place, 3))
         end if
      end select
      if (curve%at_right) text = " axes x1y2"//text
      text = text//" title "//in_quotes(curve%title)
      if (curve%title == "") text = text(:len(text)-len(" title ''"))//" notitle"
   end function drawn

   !> Colour of a filled shape
   pure function shade(percent) result(colour)
      !> From the lightest, 0, to the darkest, 100; -1 is white
      integer, intent(in) :: percent
      !> As gnuplot writes it
      character(len=7) :: colour
      integer :: parts(3)

      parts = 255
      if (percent >= 0) parts = nint(lightest + (darkest - lightest) &
         & *0.01_wp*real(percent, wp))
      write(colour, "('#', 3z2.2)") parts
   end function shade

   !> Notes of a panel
   subroutine put_notes(buffer, panel)
      !> The script
      type(buffer_t), intent(inout) :: buffer
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
               call buffer%add("set arrow from first "//number(note%x)//", first " &
                  & //number(note%y)//" to graph 1, first "//number(note%y)//thin//nl &
                  & //"set label "//in_quotes(note%text)//" at graph 1.02, first " &
                  & //number(heights(i))//" left"//nl)
            case (note_top)
               call buffer%add("set arrow from first "//number(note%x)//", graph 0 to first " &
                  & //number(note%x)//", graph 1"//thin//nl)
               if (note%text /= "") call buffer%add("set label "//in_quotes(note%text) &
                  & //" at first "//number(note%x) &
                  & //", graph 1 center offset 0, 0.6"//nl)
            case default
               call buffer%add("set label "//in_quotes(note%text)//" at first " &
                  & //number(note%x)//", first "//number(note%y) &
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

   !> A number with four decimals
   pure function short(value) result(text)
      !> The number, 0 to 1000
      real(wp), intent(in) :: value
      character(len=:), allocatable :: text
      character(len=10) :: buffer

      write(buffer, "(f10.4)") value
      text = trim(adjustl(buffer))
   end function short

end module vcor_io_gnuplot
