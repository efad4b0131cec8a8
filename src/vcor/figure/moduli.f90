!> Figures of moduli, as Figs. 1 and 5 of the paper: relaxation modulus over time, storage modulus,
!> loss modulus and loss tangent over frequency
module vcor_figure_moduli
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_quiet_nan, ieee_value
   use vcor_error, only : error_input, error_t, raise
   use vcor_figure_label, only : largest_of, rounded_text, suit_unit, with_unit
   use vcor_figure_legend, only : fitted, legend_t, page_room
   use vcor_figure_result, only : get_column, get_texts, get_window, has_group, result_t
   use vcor_io_table, only : column_t, text_value
   use vcor_io_figure, only : add_curve, add_note, figure_t, line_solid, new_figure, note_top, &
      panel_t, style_count
   use vcor_io_hdf5_reader, only : dataset_t
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, printable
   implicit none
   private

   public :: moduli_figure

   !> Significant digits of what is marked
   integer, parameter :: digits = 4
   !> A blank that no renderer leaves out after a subscript
   character(len=*), parameter :: blank = char(194)//char(160)
   !> Room that a linear axis leaves above its largest value
   real(wp), parameter :: room = 1.08_wp

   !> Moduli of one material
   type :: moduli_t
      !> What it is called in the legend
      character(len=:), allocatable :: text
      !> Times [s] and frequencies [rad/s]
      real(wp), allocatable :: time(:), frequency(:)
      !> Relaxation, storage and loss modulus [Pa]
      real(wp), allocatable :: relaxation(:), storage(:), loss(:)
      !> Loss tangent
      real(wp), allocatable :: tangent(:)
   end type moduli_t

contains

   !> Moduli of all materials that relax. One material: two panels, with the loss tangent on an axis
   !> at the right; several: a panel for each modulus
   subroutine moduli_figure(results, legends, figure, error)
      !> Results, shape (n)
      type(result_t), intent(in) :: results(:)
      !> Their texts
      type(legend_t), intent(in) :: legends(:)
      type(figure_t), intent(out) :: figure
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(moduli_t), allocatable :: all(:)
      character(len=:), allocatable :: unit
      real(wp) :: factor, largest
      integer :: i

      allocate (all(0))
      do i = 1, size(results)
         call read_moduli(results(i), legends(i)%text, size(results) > 1, all, error)
         if (allocated(error)) return
      end do
      if (size(all) > style_count) then
         call raise(error, error_input, results(1)%path//': '//integer_text(size(all)) &
            //' materials in one figure cannot be told apart, expected at most ' &
            //integer_text(style_count))
         return
      end if
      largest = 0.0_wp
      do i = 1, size(all)
         largest = max(largest, largest_of(all(i)%relaxation), largest_of(all(i)%storage))
      end do
      call suit_unit('Pa', largest, factor, unit)

      if (size(all) == 1) then
         call new_figure(figure, 'moduli over time and frequency', panels=2, columns=2)
         associate (time => figure%panels(1), frequency => figure%panels(2), one => all(1))
            call set_axes(time, .true., 'relaxation modulus')
            call add_curve(time, one%time, factor*one%relaxation, line_solid, 1, &
               'relaxation modulus E(t)')
            call set_axes(frequency, .false., 'storage and loss modulus')
            call add_curve(frequency, one%frequency, factor*one%storage, line_solid, 1, &
               'storage modulus E′')
            call add_curve(frequency, one%frequency, factor*one%loss, line_solid, 2, &
               'loss modulus E″')
            call add_curve(frequency, one%frequency, one%tangent, line_solid, 3, &
               'loss tangent tan δ', at_right=.true.)
            frequency%right%label = 'loss tangent'
            frequency%right%upper = room*largest_of(one%tangent)
         end associate
         call mark(results(1), figure%panels(1:1), figure%panels(2:2), .true.)
      else
         call new_figure(figure, 'moduli over time and frequency', panels=4, columns=2)
         call set_axes(figure%panels(1), .true., 'relaxation modulus')
         call set_axes(figure%panels(2), .false., 'storage modulus')
         call set_axes(figure%panels(3), .false., 'loss modulus')
         call set_axes(figure%panels(4), .false., 'loss tangent')
         figure%panels(4)%y%label = 'loss tangent'
         figure%panels(4)%y%is_log = .false.
         do i = 1, size(all)
            associate (one => all(i))
               call add_curve(figure%panels(1), one%time, factor*one%relaxation, line_solid, i, &
                  one%text)
               call add_curve(figure%panels(2), one%frequency, factor*one%storage, line_solid, i)
               call add_curve(figure%panels(3), one%frequency, factor*one%loss, line_solid, i)
               call add_curve(figure%panels(4), one%frequency, one%tangent, line_solid, i)
               figure%panels(4)%y%upper = max(figure%panels(4)%y%upper, &
                  room*largest_of(one%tangent))
            end associate
         end do
         do i = 1, size(results)
            call mark(results(i), figure%panels(1:1), figure%panels(2:4), size(results) == 1)
         end do
      end if

   contains

      !> Axes of a panel
      subroutine set_axes(panel, over_time, label)
         type(panel_t), intent(inout) :: panel
         !> Whether over time rather than over frequency
         logical, intent(in) :: over_time
         !> What it shows
         character(len=*), intent(in) :: label

         panel%x%label = 'angular frequency [rad/s]'
         if (over_time) panel%x%label = 'time [s]'
         panel%x%is_log = .true.
         panel%y%label = with_unit(label, unit)
         panel%y%is_log = .true.
      end subroutine set_axes
   end subroutine moduli_figure

   !> Read the moduli of all materials of a file that relax
   subroutine read_moduli(result, text, of_several, all, error)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Its text in the legend
      character(len=*), intent(in) :: text
      !> Whether there are more files
      logical, intent(in) :: of_several
      !> Moduli; those of the file are appended
      type(moduli_t), allocatable, intent(inout) :: all(:)
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(dataset_t) :: frequency, loss, relaxation, storage, tangent, time
      type(column_t) :: names
      type(moduli_t) :: one
      integer :: before, i, n, m

      if (.not. (has_group(result, 'relaxation') .and. has_group(result, 'dynamic'))) then
         call raise(error, error_input, result%path//': there are no moduli in this file, ' &
            //'expected one of vcor material')
         return
      end if
      call get_column(result, 'relaxation', 'time', time, error)
      if (.not. allocated(error)) call get_column(result, 'relaxation', 'relaxation_modulus', &
         relaxation, error)
      if (.not. allocated(error)) call get_column(result, 'dynamic', 'frequency', frequency, error)
      if (.not. allocated(error)) call get_column(result, 'dynamic', 'storage_modulus', storage, &
         error)
      if (.not. allocated(error)) call get_column(result, 'dynamic', 'loss_modulus', loss, error)
      if (.not. allocated(error)) call get_column(result, 'dynamic', 'loss_tangent', tangent, error)
      if (allocated(error)) return
      call get_texts(result, 'relaxation', 'material', names)

      n = time%column%length
      m = frequency%column%length
      before = size(all)
      if (n < 2 .or. m < 2 .or. relaxation%column%length /= n*names%length &
         .or. any([storage%column%length, loss%column%length, tangent%column%length] &
         /= m*names%length)) then
         call raise(error, error_input, result%path//': the moduli in this file are not those of ' &
            //'its materials at its times and frequencies')
         return
      end if
      do i = 1, names%length
         one%time = time%column%reals
         one%frequency = frequency%column%reals
         one%relaxation = positive(relaxation%column%reals((i - 1)*n + 1:i*n))
         one%storage = positive(storage%column%reals((i - 1)*m + 1:i*m))
         one%loss = positive(loss%column%reals((i - 1)*m + 1:i*m))
         one%tangent = tangent%column%reals((i - 1)*m + 1:i*m)
         one%text = printable(text_value(names, i))
         if (.not. any(loss%column%reals((i - 1)*m + 1:i*m) > 0.0_wp)) cycle
         all = [all, one]
      end do
      if (size(all) == before) then
         call raise(error, error_input, result%path//': no material in this file relaxes, there ' &
            //'is nothing to draw')
         return
      end if
      do i = before + 1, size(all)
         if (of_several .and. size(all) == before + 1) then
            all(i)%text = text
         else if (of_several) then
            all(i)%text = text//': '//all(i)%text
         end if
         if (of_several) then
            all(i)%text = fitted(all(i)%text, page_room - 40)//window_text(result)
         else
            all(i)%text = fitted(all(i)%text, page_room)
         end if
      end do
   end subroutine read_moduli

   !> Values for a logarithmic axis
   pure function positive(values) result(kept)
      real(wp), intent(in) :: values(:)
      !> The same, NaN where they are not positive
      real(wp) :: kept(size(values))

      integer :: i

      kept = values
      do i = 1, size(values)
         if (ieee_is_finite(values(i))) then
            if (values(i) > 0.0_wp) cycle
         end if
         kept(i) = ieee_value(1.0_wp, ieee_quiet_nan)
      end do
   end function positive

   !> Window of the impact in words
   function window_text(result) result(text)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Its contact time and lowest frequency after a colon, nothing where they are not known
      character(len=:), allocatable :: text

      real(wp) :: contact_time, min_frequency

      call get_window(result, 'relaxation', contact_time, min_frequency)
      text = ''
      if (ieee_is_finite(contact_time)) text = ': '//time_text(contact_time)//', ' &
         //frequency_text(min_frequency)
   end function window_text

   !> A contact time in words
   function time_text(contact_time) result(text)
      !> Contact time [s]
      real(wp), intent(in) :: contact_time
      !> Such as `t_0 = 1.342 ms`
      character(len=:), allocatable :: text

      character(len=:), allocatable :: unit
      real(wp) :: factor

      call suit_unit('s', contact_time, factor, unit)
      text = 't_0'//blank//'= '//rounded_text(factor*contact_time, digits)//' '//unit
   end function time_text

   !> A lowest frequency in words
   function frequency_text(min_frequency) result(text)
      !> Lowest frequency of interest [rad/s]
      real(wp), intent(in) :: min_frequency
      !> Such as `ω_{min} = 4684 rad/s`
      character(len=:), allocatable :: text

      text = 'ω_{min}'//blank//'= '//rounded_text(min_frequency, digits)//' rad/s'
   end function frequency_text

   !> Mark the window of the impact, t <= t0 and omega >= omega_min
   subroutine mark(result, over_time, over_frequency, with_text)
      !> What a file holds
      type(result_t), intent(in) :: result
      type(panel_t), intent(inout) :: over_time(:)
      type(panel_t), intent(inout) :: over_frequency(:)
      !> Whether the values are written beside the lines
      logical, intent(in) :: with_text

      character(len=:), allocatable :: text
      real(wp) :: contact_time, min_frequency
      integer :: i

      call get_window(result, 'relaxation', contact_time, min_frequency)
      if (.not. ieee_is_finite(contact_time)) return
      text = ''
      if (with_text) text = time_text(contact_time)
      do i = 1, size(over_time)
         call add_note(over_time(i), note_top, contact_time, 0.0_wp, text)
      end do
      if (with_text) text = frequency_text(min_frequency)
      do i = 1, size(over_frequency)
         call add_note(over_frequency(i), note_top, min_frequency, 0.0_wp, text)
      end do
   end subroutine mark

end module vcor_figure_moduli
