!> Layout of figures: where panels, their legends and notes are on the page
!>
!> All is laid out in centimetres at the size of print: 8.5 cm wide, a column, or 17 cm, a page,
!> with letters of 8 points. Above a pair of axes stand its legend, its notes and its heading, one
!> line below the other; where only the first of several panels has a legend, it is that of all.
module vcor_io_layout
   use vcor_io_figure, only : figure_t, note_right, note_top, panel_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: frame_t, lay_out, title_count, body_height, line_height, letter_width

   !> Widths of a figure: a column, a page [cm]
   real(wp), parameter :: column_width = 8.5_wp, page_width = 17.0_wp
   !> Height of a pair of axes [cm]
   real(wp), parameter :: body_height = 5.2_wp
   !> Margins below, left, above and right of it where nothing is written there [cm]
   real(wp), parameter :: bottom = 1.2_wp, left = 1.8_wp, top = 0.25_wp, right = 0.4_wp
   !> Margin right of it with an axis there [cm]
   real(wp), parameter :: right_axis = 1.6_wp
   !> From one line of text to the next [cm]
   real(wp), parameter :: line_height = 0.42_wp
   !> Width of a letter, on the wide side [cm]
   real(wp), parameter :: letter_width = 0.165_wp
   !> Width of the sample of a line and what is around a text of the legend [cm]
   real(wp), parameter :: sample_width = 1.1_wp

   !> Where a panel is on the page, in screen coordinates from 0 to 1
   type :: frame_t
      !> Its edges
      real(wp) :: left, right, bottom, top
      !> Left edge of its legend and its upper edge
      real(wp) :: legend_left, legend_top
      !> Rows of its legend
      integer :: legend_rows
   end type frame_t

contains

   !> Places of all panels and of their legends
   pure subroutine lay_out(figure, frames, width, height)
      type(figure_t), intent(in) :: figure
      !> Places, shape (number of panels)
      type(frame_t), intent(out) :: frames(:)
      !> Size of the figure [cm]
      real(wp), intent(out) :: width, height
      real(wp) :: above(size(figure%panels)), cell, high, shared, wide
      integer :: columns(size(figure%panels)), first, i, last
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
            call arrange(panel, wide, columns(i), frames(i)%legend_rows)
            if (is_shared .and. i == 1) then
               shared = real(frames(i)%legend_rows, wp)*line_height
            else if (.not. is_shared) then
               above(i) = above(i) + real(frames(i)%legend_rows, wp)*line_height
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
               ! above the axes, or from the edge where a text is long
               wide = merge(width, cell, is_shared)
               frame%legend_left = max(real(i - first, wp)*cell + 0.1_wp, min(frame%left, &
                  & real(i - first, wp)*cell + wide - legend_width(figure%panels(i), &
                  & columns(i))))
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
      type(panel_t), intent(in) :: panel
      !> Width that there is [cm]
      real(wp), intent(in) :: width
      !> Texts beside each other, at least 1
      integer, intent(out) :: columns
      !> Rows of texts
      integer, intent(out) :: rows
      integer :: count

      count = title_count(panel)
      columns = max(1, min(count, int(width/legend_width(panel, 1))))
      rows = (count + columns - 1)/columns
   end subroutine arrange

   !> Width of a legend
   pure function legend_width(panel, columns) result(width)
      type(panel_t), intent(in) :: panel
      !> Texts beside each other
      integer, intent(in) :: columns
      !> Width [cm]
      real(wp) :: width
      integer :: i, longest

      longest = 1
      do i = 1, panel%curve_count
         longest = max(longest, letter_count(panel%curves(i)%title))
      end do
      width = real(columns, wp)*(real(longest, wp)*letter_width + sample_width)
   end function legend_width

   !> Number of texts in the legend
   pure function title_count(panel) result(count)
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

   !> Whether a panel has a note with a text at some place
   pure function has_note(panel, place) result(has)
      type(panel_t), intent(in) :: panel
      !> One of the `note_*` constants
      integer, intent(in) :: place
      !> True if it has
      logical :: has
      integer :: i

      has = .false.
      do i = 1, panel%note_count
         has = has .or. panel%notes(i)%place == place .and. panel%notes(i)%text /= ""
      end do
   end function has_note

   !> Margin right of a panel
   pure function right_of(panel) result(margin)
      type(panel_t), intent(in) :: panel
      !> Margin [cm]
      real(wp) :: margin
      integer :: i

      margin = right
      if (panel%right%label /= "") margin = right_axis
      do i = 1, panel%note_count
         if (panel%notes(i)%place == note_right) margin = max(margin, &
            & right + real(letter_count(panel%notes(i)%text), wp)*letter_width)
      end do
   end function right_of

end module vcor_io_layout
