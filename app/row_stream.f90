!> The rows of a summary in its file as soon as all rows before them are finished: while the first
!> rank writes, the others go on
module vcor_app_row_stream
   use vcor_case_grid, only : grid_t
   use vcor_error, only : error_t
   use vcor_io_csv, only : add_rows, begin_csv, csv_file_t, discard_csv, end_csv
   use vcor_io_identity, only : identity_t
   use vcor_io_results, only : lend_rows, summary_table, take_back
   use vcor_io_table, only : table_t
   use vcor_sweep_quantity, only : point_pending
   use vcor_sweep_summary, only : summary_t
   implicit none
   private

   public :: row_stream_t

   !> Fewest and most rows that are written at once
   integer, parameter :: fewest = 1024, most = 16384

   !> A file that grows
   type :: row_stream_t
      !> Name of the file; unallocated where there is none
      character(len=:), allocatable :: path
      !> Threads that write
      integer :: threads = 1
      !> The file
      type(csv_file_t), private :: file
      !> Its table, without the outcomes
      type(table_t), private :: table
      !> Rows that are written
      integer, private :: written = 0
   contains
      !> Write what can be written
      procedure :: advance
      !> Write all rows that are left, and end the file
      procedure :: complete
      !> Give the file up
      procedure :: abandon
   end type row_stream_t

contains

   !> Write what can be written
   subroutine advance(self, identity, grid, summary, error)
      !> The file
      class(row_stream_t), intent(inout) :: self
      !> What it is about
      type(identity_t), intent(in) :: identity
      !> Grid of the sweep
      type(grid_t), intent(in) :: grid
      !> Outcomes; they move to a table and back
      type(summary_t), intent(inout) :: summary
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      integer :: last

      if (.not. allocated(self%path)) return
      last = self%written
      do while (last < min(size(summary%status), self%written + most))
         if (summary%status(last + 1) == point_pending) exit
         last = last + 1
      end do
      if (last - self%written >= fewest) call write_to(self, last, identity, grid, summary, error)
   end subroutine advance

   !> Write all rows that are left, and end the file
   subroutine complete(self, identity, grid, summary, error)
      !> The file
      class(row_stream_t), intent(inout) :: self
      !> What it is about
      type(identity_t), intent(in) :: identity
      !> Grid of the sweep
      type(grid_t), intent(in) :: grid
      !> Outcomes, all of them there
      type(summary_t), intent(inout) :: summary
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      if (.not. allocated(self%path)) return
      call write_to(self, size(summary%status), identity, grid, summary, error)
      if (.not. allocated(error)) call end_csv(self%file, error)
   end subroutine complete

   !> Write rows
   subroutine write_to(self, last, identity, grid, summary, error)
      !> The file
      type(row_stream_t), intent(inout) :: self
      !> Last row
      integer, intent(in) :: last
      !> What it is about
      type(identity_t), intent(in) :: identity
      !> Grid of the sweep
      type(grid_t), intent(in) :: grid
      !> Outcomes
      type(summary_t), intent(inout) :: summary
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      if (self%written == 0) then
         call summary_table(self%table, identity%title, identity%case_text, grid, summary)
         call begin_csv(self%file, self%path, self%table, error)
         call take_back(self%table, summary)
         if (allocated(error)) return
      end if
      call lend_rows(self%table, summary, self%written + 1, last)
      call add_rows(self%file, self%table, self%written + 1, last, self%threads, error)
      call take_back(self%table, summary)
      self%written = last
   end subroutine write_to

   !> Give the file up; none is fine
   subroutine abandon(self)
      !> The file
      class(row_stream_t), intent(inout) :: self

      call discard_csv(self%file)
   end subroutine abandon

end module vcor_app_row_stream
