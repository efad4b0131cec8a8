!> What is in the place of the files that a run is going to write
module vcor_app_previous
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_app_cli, only : request_t
   use vcor_app_job, only : job_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_checkpoint, only : attach, checkpoint_t
   use vcor_io_file, only : write_stdout
   use vcor_io_identity, only : check_same, identity_t, read_csv_identity, read_identity
   use vcor_io_path, only : check_plain, plain_file_exists, quoted_path
   implicit none
   private

   public :: previous_t, look_back, look_at, heed, replaced, refuse_unfinished, remark

   !> Results that are there
   type :: previous_t
      !> Whether there are any
      logical :: exist = .false.
      !> Whether all files are there
      logical :: is_whole = .false.
      !> Whether the HDF5 file is there
      logical :: has_hdf5 = .false.
      !> File that was looked into
      character(len=:), allocatable :: path
      !> What it is about; all texts are empty if it is not of this program
      type(identity_t) :: identity
      !> Why it is not about the same as the run; unallocated if it is
      type(error_t), allocatable :: objection
   end type previous_t

contains

   !> Look for results
   subroutine look_back(job, expected, previous)
      !> The case
      type(job_t), intent(in) :: job
      !> What the run is about
      type(identity_t), intent(in) :: expected
      !> What is there
      type(previous_t), intent(out) :: previous

      call look_at(job%path, job%endings, job%writes, expected, previous)
   end subroutine look_back

   !> Look for results in files of some names
   subroutine look_at(path, endings, writes, expected, previous)
      !> Directory and stem of the files
      character(len=*), intent(in) :: path
      !> What their names end with: summary as text, history, HDF5
      character(len=*), intent(in) :: endings(:)
      !> Which are to be written, in the order of `endings`
      logical, intent(in) :: writes(:)
      !> What they should be about
      type(identity_t), intent(in) :: expected
      !> What is there
      type(previous_t), intent(out) :: previous

      type(error_t), allocatable :: damage
      integer :: i
      logical :: is_ours, is_there(size(endings))

      is_there = [(plain_file_exists(path//trim(endings(i))), i=1, size(endings))]
      previous%is_whole = all(is_there .or. .not. writes)
      is_ours = .false.
      do i = size(endings), 1, -1
         ! a history says nothing that the others do not
         if (i == 2 .or. .not. (writes(i) .and. is_there(i))) cycle
         previous%path = path//trim(endings(i))
         previous%exist = .true.
         previous%has_hdf5 = i == 3
         if (i == 1) then
            call read_csv_identity(previous%path, previous%identity, is_ours)
            previous%identity%data = expected%data
         else
            call read_identity(previous%path, previous%identity, is_ours, damage)
         end if
         if (is_ours) then
            call check_same(previous%path, previous%identity, expected, previous%objection)
         else
            call raise(previous%objection, error_file, quoted_path(previous%path) &
               //' is not a file of results of vcor')
            if (allocated(damage)) previous%objection%message = previous%objection%message//' (' &
               //damage%message//')'
         end if
         return
      end do
   end subroutine look_at

   !> Whether there is nothing to do: with --resume, where the results are there
   subroutine heed(request, previous, is_finished, error)
      !> The request
      type(request_t), intent(in) :: request
      !> What is there
      type(previous_t), intent(in) :: previous
      !> Whether there is nothing to do
      logical, intent(out) :: is_finished
      !> With --resume: what is there is about something else
      type(error_t), allocatable, intent(out) :: error

      is_finished = .false.
      if (.not. request%resume .or. .not. previous%exist) return
      if (allocated(previous%objection)) then
         error = previous%objection
         return
      end if
      is_finished = previous%is_whole
      if (.not. is_finished) return
      if (size(request%names) > 0) then
         call remark(finished_text())
      else if (.not. request%quiet) then
         call write_stdout(finished_text()//new_line('a'), error)
      end if

   contains

      !> What there is to say
      function finished_text() result(text)
         !> One line
         character(len=:), allocatable :: text

         text = quoted_path(previous%path)//' is finished, there is nothing to resume'
      end function finished_text
   end subroutine heed

   !> Nobody's results are replaced in silence
   function replaced(previous) result(text)
      !> What was there
      type(previous_t), intent(in) :: previous
      !> What there is to say: nothing if there was nothing else
      character(len=:), allocatable :: text

      text = ''
      if (allocated(previous%objection)) text = 'replaced: '//previous%objection%message
   end function replaced

   !> A sweep that begins anew must not take the unfinished points of another one, or of a process
   !> that is at work on them
   subroutine refuse_unfinished(path, expected, file, error)
      !> Path of the unfinished file, which is there
      character(len=*), intent(in) :: path
      !> What the run is about
      type(identity_t), intent(in) :: expected
      !> The file, locked until it is replaced or removed
      type(checkpoint_t), intent(inout) :: file
      !> Error of code `error_file`, unallocated if it may be replaced
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: found
      logical :: is_ours

      call check_plain(path, error)
      if (.not. allocated(error)) call read_identity(path, found, is_ours, error)
      if (allocated(error)) return
      if (.not. is_ours) then
         call raise(error, error_file, quoted_path(path)//' is not a file of vcor')
         return
      end if
      call check_same(path, found, expected, error)
      if (allocated(error)) then
         error%message = error%message//'; remove it, or finish that sweep with --resume'
         return
      end if
      call attach(file, path, error)
   end subroutine refuse_unfinished

   !> One line on stderr that is no error
   subroutine remark(text)
      !> What to say; nothing is fine
      character(len=*), intent(in) :: text

      if (len(text) == 0) return
      write (error_unit, '(a)') 'vcor: note: '//text
   end subroutine remark

end module vcor_app_previous
