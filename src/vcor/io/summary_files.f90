!> The files of a summary, both at once where there are threads for it. HDF5 gets its name last:
!> where it is there, all is there
module vcor_io_summary_files
   use vcor_error, only : error_t
   use vcor_io_csv, only : begin_csv, csv_file_t, end_csv, share_rows
   use vcor_io_file, only : commit, discard, output_file_t
   use vcor_io_hdf5, only : remark_t, write_hdf5
   use vcor_io_table, only : row_count, table_t
   implicit none
   private

   public :: write_summary

contains

   !> Write a summary: HDF5 by one thread, as the library wants it, CSV by the others and, as soon
   !> as HDF5 is done, by that one too
   subroutine write_summary(csv, hdf5, table, remarks, threads, error)
      !> Name of the CSV file; empty: none
      character(len=*), intent(in) :: csv
      !> Name of the HDF5 file; empty: none
      character(len=*), intent(in) :: hdf5
      !> A row per impact
      type(table_t), intent(in) :: table
      !> More that describes the HDF5 file, shape (n)
      type(remark_t), intent(in) :: remarks(:)
      !> Number of threads, > 0; without OpenMP there is one
      integer, intent(in) :: threads
      !> What went wrong first; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(csv_file_t) :: file
      type(output_file_t) :: image
      type(error_t), allocatable :: trouble
      integer :: team

      ! no more than there are files and rows
      team = max(1, min(threads, 1 + row_count(table)))
      if (len(csv) > 0) call begin_csv(file, csv, table, error)
      if (allocated(error)) return
!$omp parallel default(none) num_threads(team) &
!$omp shared(file, csv, hdf5, table, remarks, error, trouble, image)
!$omp single
      if (len(hdf5) > 0) call write_hdf5(hdf5, table, error=trouble, remarks=remarks, file=image)
!$omp end single nowait
      if (len(csv) > 0) call share_rows(file, table, 1, row_count(table), error)
!$omp end parallel
      if (file%is_open) call end_csv(file, error)
      if (.not. allocated(error) .and. allocated(trouble)) call move_alloc(trouble, error)
      if (allocated(error)) then
         call discard(image)
      else if (len(hdf5) > 0) then
         call commit(image, error)
      end if
   end subroutine write_summary

end module vcor_io_summary_files
