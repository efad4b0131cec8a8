!> Figures of one impact over time, as Figs. 2, 6 and 7 of the paper, and of force over indentation,
!> as Fig. 3
module vcor_figure_history
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_t
   use vcor_figure_course, only : course_t, read_course
   use vcor_figure_label, only : rounded_text, suit_unit, with_unit
   use vcor_figure_legend, only : column_room, fitted, legend_t, page_room
   use vcor_figure_result, only : result_t
   use vcor_io_figure, only : add_curve, add_note, figure_t, line_ghost, line_solid, new_figure, &
      note_right, note_top, panel_t, points_only
   use vcor_kinds, only : wp
   implicit none
   private

   public :: history_figure, loop_figure

   !> Texts of the three normalised responses
   character(len=*), parameter :: indentation_text = 'indentation s/s_{max}', &
      velocity_text = 'velocity −s′/v_0', force_text = 'force F/F_{max}'
   !> A blank that no renderer leaves out after a subscript
   character(len=*), parameter :: blank = char(194)//char(160)
   !> Significant digits of what is marked
   integer, parameter :: digits = 4
   !> Range of the normalised responses: -1 to 1 and some room
   real(wp), parameter :: range = 1.08_wp
   !> Room below the least of them
   real(wp), parameter :: low = 0.05_wp

contains

   !> Indentation, velocity and force over time, each over its largest value; the velocity with
   !> its sign turned, so that its value at the end of contact is the coefficient of restitution.
   !> One result: all in one panel; several: a panel for each response
   subroutine history_figure(results, legends, figure, error)
      !> Results, shape (n)
      type(result_t), intent(in) :: results(:)
      !> Their texts
      type(legend_t), intent(in) :: legends(:)
      type(figure_t), intent(out) :: figure
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(course_t) :: courses(size(results))
      character(len=:), allocatable :: unit
      real(wp) :: factor, longest
      integer :: i

      longest = 0.0_wp
      do i = 1, size(results)
         call read_course(results(i), courses(i), error)
         if (allocated(error)) return
         longest = max(longest, maxval(courses(i)%time))
      end do
      call suit_unit('s', longest, factor, unit)

      if (size(results) == 1) then
         call new_figure(figure, 'normalised responses over time', panels=1, columns=1)
         call set_axes(figure%panels(1), 'normalised response', -range)
         call add_response(figure%panels(1), courses(1), 1, 1, indentation_text)
         call add_response(figure%panels(1), courses(1), 2, 2, velocity_text)
         call add_response(figure%panels(1), courses(1), 3, 3, force_text)
         call add_marks(figure%panels(1), courses(1))
      else
         call new_figure(figure, 'normalised responses over time', panels=3, columns=3)
         call set_axes(figure%panels(1), indentation_text, lowest_of(1))
         call set_axes(figure%panels(2), velocity_text, -range)
         call set_axes(figure%panels(3), force_text, lowest_of(3))
         do i = 1, size(results)
            call add_response(figure%panels(1), courses(i), 1, i, &
               fitted(legends(i)%text, page_room - 27)//outcome_text(courses(i)))
            call add_response(figure%panels(2), courses(i), 2, i, '')
            call add_response(figure%panels(3), courses(i), 3, i, '')
         end do
      end if

   contains

      !> Labels and ranges of a panel
      subroutine set_axes(panel, label, lowest)
         type(panel_t), intent(inout) :: panel
         !> Label of its vertical axis
         character(len=*), intent(in) :: label
         !> Where it begins
         real(wp), intent(in) :: lowest

         panel%with_markers = .true.
         panel%x%label = with_unit('time', unit)
         panel%x%upper = longest*factor
         panel%y%label = label
         panel%y%lower = lowest
         panel%y%upper = range
      end subroutine set_axes

      !> One response: up to the end of contact, its value there, and the ghost line after it
      subroutine add_response(panel, course, response, style, title)
         type(panel_t), intent(inout) :: panel
         type(course_t), intent(in) :: course
         !> 1 indentation, 2 velocity, 3 force
         integer, intent(in) :: response
         integer, intent(in) :: style
         !> Text of the legend
         character(len=*), intent(in) :: title

         real(wp) :: at_end, values(size(course%time))
         integer :: n

         values = response_of(course, response)
         at_end = 0.0_wp
         if (response == 1) at_end = course%residual_ratio
         if (response == 2) at_end = course%cor
         n = course%contact_count
         call add_curve(panel, factor*course%time(:n), values(:n), line_solid, style, title)
         if (n < size(values)) &
            call add_curve(panel, factor*course%time(n:), values(n:), line_ghost, style)
         if (ieee_is_finite(course%contact_time)) call add_curve(panel, &
            [factor*course%contact_time], [at_end], points_only, style)
      end subroutine add_response

      !> Values of a response
      pure function response_of(course, response) result(values)
         type(course_t), intent(in) :: course
         !> 1 indentation, 2 velocity, 3 force
         integer, intent(in) :: response
         !> Values over their largest
         real(wp) :: values(size(course%time))

         select case (response)
         case (1)
            values = course%indentation/course%max_indentation
         case (2)
            values = -course%velocity/course%impact_velocity
         case default
            values = course%force/course%max_force
         end select
      end function response_of

      !> Where the axis of a response begins, with some room
      pure function lowest_of(response) result(lowest)
         !> 1 indentation, 2 velocity, 3 force
         integer, intent(in) :: response
         !> Value, not above 0
         real(wp) :: lowest

         integer :: k

         lowest = 0.0_wp
         do k = 1, size(courses)
            lowest = min(lowest, minval(response_of(courses(k), response)) - low)
         end do
      end function lowest_of

      !> What the values at the end of contact are
      subroutine add_marks(panel, course)
         type(panel_t), intent(inout) :: panel
         type(course_t), intent(in) :: course

         if (.not. ieee_is_finite(course%contact_time)) return
         associate (t0 => factor*course%contact_time)
            call add_note(panel, note_top, t0, 0.0_wp, &
               't_0'//blank//'= '//rounded_text(t0, digits)//' '//unit)
            call add_note(panel, note_right, t0, course%cor, &
               'COR '//rounded_text(course%cor, digits))
            call add_note(panel, note_right, t0, course%residual_ratio, &
               rounded_text(course%residual_ratio, digits))
         end associate
      end subroutine add_marks

      !> Values at the end of contact, for the legend
      function outcome_text(course) result(text)
         type(course_t), intent(in) :: course
         character(len=:), allocatable :: text

         text = ': no separation'
         if (ieee_is_finite(course%contact_time)) text = ': COR ' &
            //rounded_text(course%cor, digits)//', t_0'//blank//'= ' &
            //rounded_text(factor*course%contact_time, digits)//' '//unit
      end function outcome_text
   end subroutine history_figure

   !> Contact force over indentation up to the end of contact; the area in the loop is the energy
   !> that is lost
   subroutine loop_figure(results, legends, figure, error)
      !> Results, shape (n)
      type(result_t), intent(in) :: results(:)
      !> Their texts
      type(legend_t), intent(in) :: legends(:)
      type(figure_t), intent(out) :: figure
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(course_t) :: courses(size(results))
      character(len=:), allocatable :: force_unit, length_unit, text
      real(wp) :: force_factor, length_factor
      integer :: i

      do i = 1, size(results)
         call read_course(results(i), courses(i), error)
         if (allocated(error)) return
      end do
      call suit_unit('m', maxval(courses%max_indentation), length_factor, length_unit)
      call suit_unit('N', maxval(courses%max_force), force_factor, force_unit)

      call new_figure(figure, 'contact force over indentation', panels=1, columns=1)
      associate (panel => figure%panels(1))
         panel%x%label = with_unit('indentation', length_unit)
         panel%x%upper = 1.05_wp*length_factor*maxval(courses%max_indentation)
         panel%y%label = with_unit('contact force', force_unit)
         panel%y%upper = 1.05_wp*force_factor*maxval(courses%max_force)
         do i = 1, size(courses)
            associate (n => courses(i)%contact_count)
               text = loss_text(courses(i))
               if (size(courses) > 1 .or. legends(i)%given) then
                  if (text /= '') text = ', '//text
                  text = fitted(legends(i)%text, column_room - len(text))//text
               end if
               call add_curve(panel, length_factor*courses(i)%indentation(:n), &
                  force_factor*courses(i)%force(:n), line_solid, i, text)
            end associate
         end do
      end associate

   contains

      !> The energy that is lost, or a bound where it is lost in its error, as that of an elastic
      !> contact is
      function loss_text(course) result(text)
         type(course_t), intent(in) :: course
         !> The text; empty where the energy is not known
         character(len=:), allocatable :: text

         text = ''
         if (.not. ieee_is_finite(course%hysteresis_energy)) return
         text = 'energy loss '//energy(course%hysteresis_energy, digits)
         if (.not. ieee_is_finite(course%energy_error)) return
         if (abs(course%hysteresis_energy) < course%energy_error) &
            text = 'energy loss < '//energy(course%energy_error, 1)
      end function loss_text

      !> An energy with a unit that suits it
      function energy(joule, digits) result(text)
         !> Energy [J]
         real(wp), intent(in) :: joule
         !> Significant digits
         integer, intent(in) :: digits
         character(len=:), allocatable :: text

         character(len=:), allocatable :: unit
         real(wp) :: factor

         call suit_unit('J', abs(joule), factor, unit)
         text = rounded_text(factor*joule, digits)//' '//unit
      end function energy
   end subroutine loop_figure

end module vcor_figure_history
