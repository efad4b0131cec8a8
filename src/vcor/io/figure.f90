!> Figures as panels of curves with what is written beside them; `vcor_io_gnuplot` draws them
!>
!>     call new_figure(figure, panels=1)
!>     figure%panels(1)%x = figure_axis_t(label="time [ms]")
!>     call add_curve(figure%panels(1), x, y, title="force", style=1)
!>     call add_note(figure%panels(1), note_right, x=t0, y=cor, text="COR 0.432")
!>
!> All texts may hold gnuplot's marks for subscripts (`t_0`, `s_{max}`); `plain` takes that meaning
!> away from what somebody else wrote.
module vcor_io_figure
   use vcor_kinds, only : wp
   implicit none
   private

   public :: figure_t, panel_t, figure_axis_t, curve_t, note_t
   public :: new_figure, add_curve, add_note, plain
   public :: line_solid, line_ghost, line_grid, shape_filled, points_only
   public :: note_right, note_top, note_inside, style_count

   !> Form of a curve: a line, with its style's markers and dashes where the panel asks for them
   integer, parameter :: line_solid = 1
   !> A dashed line without marker, what is beyond the end of contact
   integer, parameter :: line_ghost = 2
   !> A thin dark line, such as a contour
   integer, parameter :: line_grid = 3
   !> A closed line that is filled
   integer, parameter :: shape_filled = 4
   !> Dots
   integer, parameter :: points_only = 5

   !> Where a note stands: right of the panel at a height, with a thin line to its point
   integer, parameter :: note_right = 1
   !> Above the panel, with a thin line down
   integer, parameter :: note_top = 2
   !> At its point
   integer, parameter :: note_inside = 3

   !> Number of styles of curves that can be told apart
   integer, parameter :: style_count = 8

   !> One axis
   type :: figure_axis_t
      !> What it shows, with its unit in brackets
      character(len=:), allocatable :: label
      !> Whether it is logarithmic
      logical :: is_log = .false.
      !> Where it begins and ends; the data decide unless upper > lower
      real(wp) :: lower = 0.0_wp, upper = 0.0_wp
   end type figure_axis_t

   !> One curve
   type :: curve_t
      !> Text of the legend; empty: none
      character(len=:), allocatable :: title
      !> Coordinates, shape (n); NaN interrupts the line
      real(wp), allocatable :: x(:), y(:)
      !> One of the `line_*`, `shape_*` and `points_*` constants
      integer :: form = line_solid
      !> Colour, dashes and marker, 1 to `style_count`; of a filled shape its share of the darkest
      !> colour in percent, -1 for white
      integer :: style = 1
      !> Whether its values are those of the axis at the right
      logical :: at_right = .false.
   end type curve_t

   !> A remark at a point
   type :: note_t
      !> One of the `note_*` constants
      integer :: place = note_inside
      !> Its point
      real(wp) :: x = 0.0_wp, y = 0.0_wp
      !> What it says
      character(len=:), allocatable :: text
   end type note_t

   !> One pair of axes and what is in it
   type :: panel_t
      !> Heading; empty: none
      character(len=:), allocatable :: heading
      !> Horizontal axis, vertical axis at the left and at the right
      type(figure_axis_t) :: x, y, right
      !> Whether lines carry the markers of their styles rather than dashes
      logical :: with_markers = .false.
      !> Curves; those in use are 1 to `curve_count`
      type(curve_t), allocatable :: curves(:)
      !> Number of curves
      integer :: curve_count = 0
      !> Notes; those in use are 1 to `note_count`
      type(note_t), allocatable :: notes(:)
      !> Number of notes
      integer :: note_count = 0
   end type panel_t

   !> A figure
   type :: figure_t
      !> What it shows, one line for the head of its script
      character(len=:), allocatable :: subject
      !> Its panels, row by row
      type(panel_t), allocatable :: panels(:)
      !> Panels beside each other
      integer :: columns = 1
   end type figure_t

contains

   !> Begin a figure
   pure subroutine new_figure(figure, subject, panels, columns)
      !> Figure with empty panels
      type(figure_t), intent(out) :: figure
      !> What it shows, one line
      character(len=*), intent(in) :: subject
      !> Number of panels
      integer, intent(in) :: panels
      !> Panels beside each other
      integer, intent(in) :: columns
      integer :: i

      figure%subject = subject
      figure%columns = columns
      allocate(figure%panels(panels))
      do i = 1, panels
         associate (panel => figure%panels(i))
            panel%heading = ""
            panel%x%label = ""
            panel%y%label = ""
            panel%right%label = ""
            allocate(panel%curves(8), panel%notes(4))
         end associate
      end do
   end subroutine new_figure

   !> Add a curve
   pure subroutine add_curve(panel, x, y, form, style, title, at_right)
      !> Panel to add to
      type(panel_t), intent(inout) :: panel
      !> Coordinates, shape (n)
      real(wp), intent(in) :: x(:), y(:)
      !> One of the `line_*`, `shape_*` and `points_*` constants
      integer, intent(in) :: form
      !> Style, see `curve_t`
      integer, intent(in) :: style
      !> Text of the legend; absent or empty: none
      character(len=*), intent(in), optional :: title
      !> Whether its values are those of the axis at the right; absent: not
      logical, intent(in), optional :: at_right
      type(curve_t), allocatable :: more(:)
      integer :: i

      if (panel%curve_count == size(panel%curves)) then
         allocate(more(2*size(panel%curves)))
         do i = 1, panel%curve_count
            call move_curve(panel%curves(i), more(i))
         end do
         call move_alloc(more, panel%curves)
      end if
      panel%curve_count = panel%curve_count + 1
      associate (curve => panel%curves(panel%curve_count))
         curve%x = x
         curve%y = y
         curve%form = form
         curve%style = style
         curve%title = ""
         if (present(title)) curve%title = title
         if (present(at_right)) curve%at_right = at_right
      end associate
   end subroutine add_curve

   !> Move a curve without a copy of its coordinates
   pure subroutine move_curve(from, to)
      !> Curve to move
      type(curve_t), intent(inout) :: from
      !> Where it goes
      type(curve_t), intent(inout) :: to

      call move_alloc(from%title, to%title)
      call move_alloc(from%x, to%x)
      call move_alloc(from%y, to%y)
      to%form = from%form
      to%style = from%style
      to%at_right = from%at_right
   end subroutine move_curve

   !> Add a note
   pure subroutine add_note(panel, place, x, y, text)
      !> Panel to add to
      type(panel_t), intent(inout) :: panel
      !> One of the `note_*` constants
      integer, intent(in) :: place
      !> Its point
      real(wp), intent(in) :: x, y
      !> What it says
      character(len=*), intent(in) :: text
      type(note_t), allocatable :: more(:)
      integer :: i

      if (panel%note_count == size(panel%notes)) then
         allocate(more(2*size(panel%notes)))
         do i = 1, panel%note_count
            more(i)%place = panel%notes(i)%place
            more(i)%x = panel%notes(i)%x
            more(i)%y = panel%notes(i)%y
            call move_alloc(panel%notes(i)%text, more(i)%text)
         end do
         call move_alloc(more, panel%notes)
      end if
      panel%note_count = panel%note_count + 1
      associate (note => panel%notes(panel%note_count))
         note%place = place
         note%x = x
         note%y = y
         note%text = text
      end associate
   end subroutine add_note

   !> A text whose characters all stand for themselves
   pure function plain(text) result(escaped)
      !> Any text of one line
      character(len=*), intent(in) :: text
      !> The same, with a backslash before what is a mark to gnuplot
      character(len=:), allocatable :: escaped
      integer :: i

      escaped = ""
      do i = 1, len_trim(text)
         if (scan(text(i:i), "_^{}@&~\") > 0) escaped = escaped//"\"
         escaped = escaped//text(i:i)
      end do
   end function plain

end module vcor_io_figure
