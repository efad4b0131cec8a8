!> Figures of results by the name of their kind
module vcor_figure_build
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_figure_history, only : history_figure, loop_figure
   use vcor_figure_legend, only : legend_t, make_legends
   use vcor_figure_map, only : map_figure
   use vcor_figure_moduli, only : moduli_figure
   use vcor_figure_result, only : get_axes, has_group, read_result, result_t
   use vcor_figure_sweep, only : sweep_figure
   use vcor_io_figure, only : figure_t, style_count
   use vcor_io_hdf5_reader, only : dataset_t
   use vcor_text, only : integer_text
   implicit none
   private

   public :: build_figure, usual_kind, kinds, legend_t, result_t, read_result

   !> Known kinds
   character(len=*), parameter :: kinds = 'history loop moduli sweep map'

contains

   !> The kind of figure that a file is for
   subroutine usual_kind(result, kind, error)
      !> What the file holds
      type(result_t), intent(in) :: result
      !> One of `kinds`
      character(len=:), allocatable, intent(out) :: kind
      !> Error of code `error_input` where there is nothing to draw
      type(error_t), allocatable, intent(out) :: error

      type(dataset_t), allocatable :: axes(:)

      kind = ''
      call get_axes(result, axes)
      if (has_group(result, 'relaxation')) then
         kind = 'moduli'
      else if (has_group(result, 'history')) then
         kind = 'history'
      else if (size(axes) == 2) then
         kind = 'map'
      else if (size(axes) > 0) then
         kind = 'sweep'
      else if (has_group(result, 'summary')) then
         call raise(error, error_input, result%path//': there is a single impact without a time ' &
            //'history in this file, of which no figure is made; run it with output.history = ' &
            //'.true.')
      else
         call raise(error, error_input, result%path//': there are no results of vcor in this file')
      end if
   end subroutine usual_kind

   !> Build a figure
   subroutine build_figure(results, kind, texts, quantities, figure, error)
      !> Results, shape (n)
      type(result_t), intent(in) :: results(:)
      !> One of `kinds`; empty: what the files are for
      character(len=*), intent(in) :: kind
      !> Texts of the legend, shape (n) or none
      type(legend_t), intent(in) :: texts(:)
      !> Quantities of the summary for sweeps and maps; none: the coefficient of restitution
      type(legend_t), intent(in) :: quantities(:)
      type(figure_t), intent(out) :: figure
      !> Error of code `error_input` or `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(legend_t), allocatable :: legends(:), shown(:)
      character(len=:), allocatable :: chosen, other
      integer :: i

      chosen = kind
      if (kind == '') then
         call usual_kind(results(1), chosen, error)
         do i = 2, size(results)
            if (allocated(error)) return
            call usual_kind(results(i), other, error)
            if (allocated(error)) return
            if (other /= chosen) call raise(error, error_input, results(i)%path &
               //': this file is for a figure of kind '//other//', '//results(1)%path//' for one ' &
               //'of kind '//chosen//'; expected files of one kind, or --kind')
         end do
         if (allocated(error)) return
      end if
      if (size(results) > style_count) then
         call raise(error, error_usage, integer_text(size(results))//' results in one figure ' &
            //'cannot be told apart, expected at most '//integer_text(style_count))
         return
      end if
      if (size(quantities) > 0 .and. index(' sweep map ', ' '//chosen//' ') == 0) then
         call raise(error, error_usage, '--quantity is for figures of kind sweep and map, found ' &
            //'kind '//chosen)
      else if (size(texts) == 1 .and. index(' loop sweep ', ' '//chosen//' ') == 0) then
         call raise(error, error_usage, '--legend has no place in a figure of kind '//chosen &
            //' of one file')
      end if
      if (allocated(error)) return
      call make_legends(results, legends)
      do i = 1, size(texts)
         legends(i)%text = texts(i)%text
         legends(i)%given = .true.
      end do
      shown = quantities
      if (size(shown) == 0) then
         deallocate (shown)
         allocate (shown(1))
         shown(1)%text = 'cor'
      end if

      select case (chosen)
      case ('history')
         call history_figure(results, legends, figure, error)
      case ('loop')
         call loop_figure(results, legends, figure, error)
      case ('moduli')
         call moduli_figure(results, legends, figure, error)
      case ('map')
         call map_figure(results, shown, figure, error)
      case default
         call sweep_figure(results, legends, shown, figure, error)
      end select
   end subroutine build_figure

end module vcor_figure_build
