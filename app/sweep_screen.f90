!> What the screen shows of a sweep
module vcor_app_sweep_screen
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_app_job, only : job_t, shard_text
   use vcor_app_screen, only : heading, padded, right, shown, significant
   use vcor_case_grid, only : axis_t
   use vcor_text, only : integer_text
   use vcor_io_table, only : place_in_table, table_t
   use vcor_kinds, only : wp
   use vcor_sweep_failures, only : failures_t
   use vcor_sweep_quantity, only : quantities, quantity_place, quantity_t
   implicit none
   private

   public :: sweep_report, shard_report, inexact

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

   !> Report of a sweep: what is swept, between what the outcomes lie, what has none and why
   function sweep_report(job, title, summary, failures, validity, files) result(text)
      type(job_t), intent(in) :: job
      character(len=*), intent(in) :: title
      type(table_t), intent(in) :: summary
      type(failures_t), intent(in) :: failures
      !> What is said of the validity, one to a line
      character(len=*), intent(in) :: validity
      !> Files written, one to a line
      character(len=*), intent(in) :: files
      character(len=:), allocatable :: text

      logical :: history

      text = swept(job, title)//'  '//integer_text(job%sweep%grid%count())//' impacts, ' &
         //method_shown(job)//nl &
         //nl//ranges(summary)
      if (failures%count > 0) text = text//nl//reasons(job, failures)
      if (len(validity) > 0) text = text//nl//validity
      if (failures%inexact%count > 0) text = text//nl//'  note: '//inexact(job, failures)//nl
      call job%case%get('output', 'history', history)
      if (history .and. any(job%writes)) text = text//nl &
         //'  note: time histories are written of single impacts only'//nl
      if (len(files) > 0) text = text//nl//files
      text = text//nl
   end function sweep_report

   !> Report of a shard: what is swept, what has no result and why
   function shard_report(job, title, failures, path) result(text)
      type(job_t), intent(in) :: job
      character(len=*), intent(in) :: title
      type(failures_t), intent(in) :: failures
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: text

      text = swept(job, title)//'  '//integer_text(job%part%count())//' of ' &
         //integer_text(job%part%points)//' impacts'//shard_text(job%part)//', ' &
         //method_shown(job)//nl
      if (failures%count > 0) text = text//nl//reasons(job, failures)
      if (failures%inexact%count > 0) text = text//nl//'  note: '//inexact(job, failures)//nl
      text = text//nl//'  written '//path//nl//nl
   end function shard_report

   !> The method of the points: with auto each has its own
   function method_shown(job) result(method)
      type(job_t), intent(in) :: job
      !> auto, ive or direct
      character(len=:), allocatable :: method

      character(len=:), allocatable :: wanted

      call job%case%get('solver', 'method', wanted)
      method = job%method
      if (wanted == 'auto' .and. method == 'ive') method = wanted
   end function method_shown

   !> Program, case, title and what is swept
   function swept(job, title) result(text)
      type(job_t), intent(in) :: job
      character(len=*), intent(in) :: title
      character(len=:), allocatable :: text

      integer :: i

      text = heading(job%case%source, title)
      associate (axes => job%sweep%grid%axes)
         do i = 1, size(axes)
            text = text//axis_line(axes(i))
         end do
      end associate
      text = text//nl
   end function swept

   !> What is swept
   function axis_line(axis) result(text)
      type(axis_t), intent(in) :: axis
      character(len=:), allocatable :: text

      associate (n => size(axis%values))
         text = padded('  '//axis%name, 50)//significant(axis%values(1))//' ..' &
            //significant(axis%values(n))//' '//padded(axis%unit, 8)//' '//integer_text(n) &
            //merge(' value ', ' values', n == 1)
      end associate
      text = text(:len_trim(text))//nl
   end function axis_line

   !> Smallest and largest outcomes
   function ranges(summary) result(text)
      type(table_t), intent(in) :: summary
      character(len=:), allocatable :: text

      character(len=:), allocatable :: line
      real(wp) :: least, most
      type(quantity_t), allocatable :: columns(:)
      logical :: any_there
      integer :: i, k

      allocate (columns, source=quantities())
      text = padded('', 58)//'        smallest         largest'//nl
      do i = 1, size(shown)
         associate (quantity => columns(quantity_place(shown(i))), &
                    column => summary%columns(place_in_table(summary, trim(shown(i))) &
                    - size(summary%dimensions)))
            any_there = .false.
            do k = 1, column%length
               if (ieee_is_nan(column%reals(k))) cycle
               if (.not. any_there) then
                  least = column%reals(k)
                  most = least
               end if
               any_there = .true.
               least = min(least, column%reals(k))
               most = max(most, column%reals(k))
            end do
            if (.not. any_there) cycle
            line = padded('  '//trim(quantity%meaning), 50)//padded(quantity%symbol, 8) &
               //significant(least)//significant(most)
            if (quantity%unit /= '1') line = line//' '//trim(quantity%unit)
            text = text//line//nl
         end associate
      end do
   end function ranges

   !> What has no result, and why
   function reasons(job, failures) result(text)
      type(job_t), intent(in) :: job
      type(failures_t), intent(in) :: failures
      character(len=:), allocatable :: text

      integer :: i

      text = '  '//integer_text(failures%count)//' of '//integer_text(job%part%count()) &
         //' points'//shard_text(job%part)//' without result:'//nl
      do i = 1, failures%reasons
         associate (reason => failures%reason(i))
            text = text//'  '//right(integer_text(reason%count), 8)//'  '//reason%message//nl &
               //'            first at point '//integer_text(reason%first)//': ' &
               //job%coordinates(reason%first)//nl
         end associate
      end do
   end function reasons

   !> How many points are less accurate than asked for
   function inexact(job, failures) result(text)
      type(job_t), intent(in) :: job
      !> What there is to say of the points
      type(failures_t), intent(in) :: failures
      !> One line
      character(len=:), allocatable :: text

      text = integer_text(failures%inexact%count)//' of '//integer_text(job%part%count()) &
         //' points'//shard_text(job%part)//' have an estimated error above the accuracy ' &
         //'asked for, the first one is point '//integer_text(failures%inexact%first)//': ' &
         //job%coordinates(failures%inexact%first)
   end function inexact

end module vcor_app_sweep_screen
