!> The files of a summary, both at once where there are threads for it
module vcor_io_summary_files
!$ use omp_lib, only : omp_set_max_active_levels
   use vcor_error, only : error_t
   use vcor_io_csv, only : write_csv
   use vcor_io_hdf5, only : remark_t, write_hdf5
   use vcor_io_table, only : table_t
   implicit none
   private

   public :: write_summary

contains

   !> Write a summary: HDF5 by one thread, as the library wants it, CSV by the others
   subroutine write_summary(csv, hdf5, table, remarks, threads, error)
      !> Name of the CSV file; empty: none
      character(len=*), intent(in) :: csv
      !> Name of the HDF5 file; empty: none
      character(len=*), intent(in) :: hdf5
      !> A row per impact
      type(table_t), intent(in) :: table
      !> More that describes the HDF5 file, shape (n)
      type(remark_t), intent(in) :: remarks(:)
      !> Number of threads, > 0
      integer, intent(in) :: threads
      !> What went wrong first; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(error_t), allocatable :: trouble
      integer :: team, rest

      team = min(threads, 2)
      rest = threads
      if (len(hdf5) > 0) rest = max(1, threads - 1)
!$    call omp_set_max_active_levels(2)
!$omp parallel sections default(none) num_threads(team) &
!$omp shared(csv, hdf5, table, remarks, rest, error, trouble)
!$omp section
      if (len(csv) > 0) call write_csv(csv, table, error, rest)
!$omp section
      if (len(hdf5) > 0) call write_hdf5(hdf5, table, error=trouble, remarks=remarks)
!$omp end parallel sections
      if (.not. allocated(error) .and. allocated(trouble)) call move_alloc(trouble, error)
   end subroutine write_summary

end module vcor_io_summary_files
