!> The command merge: makes the files of a whole sweep from its shards
module vcor_app_merge
   use vcor_app_cli, only : request_t
   use vcor_app_files, only : files_t, find_previous, name_files, previous_t, remark, &
      replacement_note, write_files
   use vcor_app_validity, only : points_report
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : validate
   use vcor_case_grid, only : grid_t, new_grid
   use vcor_error, only : error_file, error_numerical, error_t, raise
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_case_reader, only : read_case_text
   use vcor_io_checkpoint, only : read_points
   use vcor_io_file, only : write_stdout
   use vcor_io_identity, only : check_same, identity_t, read_identity
   use vcor_io_path, only : quoted_path, same_file
   use vcor_io_results, only : summary_table
   use vcor_io_table, only : table_t
   use vcor_sweep_part, only : new_part, part_t
   use vcor_sweep_quantity, only : new_summary, point_pending, status_name, summary_t
   use vcor_text, only : integer_text
   use vcor_version, only : version
   implicit none
   private

   public :: merge_shards

contains

   !> Merge the shards of a sweep
   subroutine merge_shards(request, error)
      type(request_t), intent(in) :: request
      !> Error of code `error_file` if shards are missing or do not match, of code `error_numerical`
      !> if points have no result; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: identity
      type(case_t) :: case
      type(grid_t) :: grid
      type(summary_t) :: summary
      type(error_t), allocatable :: trouble
      integer, allocatable :: numbers(:)

      call identify(request, identity, numbers, error)
      if (allocated(error)) return
      associate (path => request%files(1)%text)
         call read_case_text(case, identity%case_text, path, error)
         if (.not. allocated(error)) call validate(case, error)
         if (.not. allocated(error)) call new_grid(case, grid, error)
         if (allocated(error)) return
         associate (points => grid%count())
            if (points /= identity%part%points) then
               call raise(error, error_file, quoted_path(path)//' has a case of ' &
                  //integer_text(points)//' points, expected '//integer_text(identity%part%points))
               return
            end if
         end associate
      end associate
      call gather(request, identity, numbers, summary, error)
      if (allocated(error)) return
      identity%part = new_part(identity%part%points, 1, 1)
      call judge(identity, summary, error)
      call write_merged(request, case, grid, identity, summary, trouble)
      if (allocated(trouble)) call move_alloc(trouble, error)
   end subroutine merge_shards

   !> Check that the files are all shards of one sweep
   subroutine identify(request, first, numbers, error)
      type(request_t), intent(in) :: request
      !> Identity of the first file
      type(identity_t), intent(out) :: first
      !> Indices of the shards, shape (files)
      integer, allocatable, intent(out) :: numbers(:)
      !> Error of code `error_file`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: found
      character(len=:), allocatable :: shard
      integer :: i, j

      allocate (numbers(size(request%files)))
      do i = 1, size(request%files)
         associate (path => request%files(i)%text, part => found%part)
            call read_identity(path, found, error)
            if (allocated(error)) return
            if (found%version == '' .or. part%points == 0) then
               call raise(error, error_file, quoted_path(path)//' is no shard of a sweep of vcor')
               return
            end if
            if (i == 1) then
               first = found
               first%version = version
            end if
            call check_same(path, found, first, error)
            if (allocated(error)) return
            shard = quoted_path(path)//' is shard '//integer_text(part%number)//' of ' &
               //integer_text(part%parts)
            j = findloc(numbers(:i - 1), part%number, dim=1)
            if (part%number > part%parts) then
               call raise(error, error_file, shard)
            else if (j > 0) then
               call raise(error, error_file, shard//', as is ' &
                  //quoted_path(request%files(j)%text)//'; expected each one once')
            end if
            if (allocated(error)) return
            numbers(i) = part%number
         end associate
      end do
      if (size(numbers) < first%part%parts) call raise(error, error_file, 'missing: shard' &
         //trim(merge('s', ' ', first%part%parts - size(numbers) > 1))//' ' &
         //missing(numbers, first%part%parts)//' of '//integer_text(first%part%parts) &
         //'; expected all of them')
   end subroutine identify

   !> Missing shards
   function missing(numbers, parts) result(text)
      !> Indices of the existing shards
      integer, intent(in) :: numbers(:)
      integer, intent(in) :: parts
      !> Indices of the missing ones
      character(len=:), allocatable :: text

      integer, parameter :: most_named = 10
      integer :: i, named

      text = ''
      named = 0
      do i = 1, parts
         if (any(numbers == i)) cycle
         named = named + 1
         if (named > most_named) cycle
         if (named > 1) text = text//', '
         text = text//integer_text(i)
      end do
      if (named > most_named) text = text//' and '//integer_text(named - most_named)//' more'
   end function missing

   !> Read the outcomes of all shards into one summary
   subroutine gather(request, identity, numbers, summary, error)
      type(request_t), intent(in) :: request
      !> Identity of the shards
      type(identity_t), intent(in) :: identity
      !> Indices of the shards in the files
      integer, intent(in) :: numbers(:)
      !> Outcomes by the index of the point
      type(summary_t), intent(out) :: summary
      !> Error of code `error_file` if a shard is not finished; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: expected
      type(summary_t) :: shard
      integer :: i

      call new_summary(summary, identity%part%points, error)
      expected = identity
      do i = 1, size(numbers)
         if (allocated(error)) return
         associate (path => request%files(i)%text, part => expected%part)
            part%number = numbers(i)
            call new_summary(shard, part%count(), error)
            if (.not. allocated(error)) call read_points(path, expected, shard, error)
            if (allocated(error)) return
            associate (pending => count(shard%status == point_pending))
               if (pending > 0) call raise(error, error_file, quoted_path(path) &
                  //' is not finished: '//integer_text(pending)//' of its ' &
                  //integer_text(part%count())//' points are pending; --resume finishes it')
            end associate
            call summary%put_part(part, shard)
         end associate
      end do
   end subroutine gather

   !> Raise an error if points have no result, as run does
   subroutine judge(identity, summary, error)
      !> Identity of the sweep
      type(identity_t), intent(in) :: identity
      type(summary_t), intent(in) :: summary
      !> Error of code `error_numerical`, unallocated if all points have a result
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: kinds
      integer :: i, n

      n = count(summary%status /= contact_separated)
      if (n == 0) return
      kinds = ''
      do i = minval(summary%status), maxval(summary%status)
         if (i == contact_separated .or. .not. any(summary%status == i)) cycle
         kinds = kinds//', '//integer_text(count(summary%status == i))//' '//status_name(i)
      end do
      call raise(error, error_numerical, integer_text(n)//' of ' &
         //integer_text(identity%part%points)//' points without result: '//kinds(3:) &
         //' (the shards have said why)')
   end subroutine judge

   !> Write the files of the whole sweep
   subroutine write_merged(request, case, grid, identity, summary, error)
      type(request_t), intent(in) :: request
      type(case_t), intent(in) :: case
      type(grid_t), intent(in) :: grid
      !> Identity of the sweep
      type(identity_t), intent(in) :: identity
      type(summary_t), intent(inout) :: summary
      type(error_t), allocatable, intent(out) :: error

      type(previous_t) :: previous
      type(files_t) :: files
      type(part_t) :: all
      type(table_t) :: tables(1)
      character(len=:), allocatable :: lines, validity
      integer :: i

      call name_files(request, case, grid, size(request%files) == 1, files, all, error)
      if (allocated(error)) return
      do i = 1, size(request%files)
         if (.not. same_file(request%files(i)%text, files%name(3))) cycle
         call raise(error, error_file, quoted_path(request%files(i)%text) &
            //' would be replaced by what it is merged into: give another --output')
         return
      end do
      call find_previous(files, identity, previous)
      validity = points_report(grid, summary)
      if (len(validity) > 0) validity = validity//new_line('a')
      call summary_table(tables(1), identity%title, identity%case_text, grid, summary)
      call write_files(files, tables, lines, error, identity%data)
      if (allocated(error)) return
      call remark(replacement_note(previous))
      if (.not. request%quiet) call write_stdout(integer_text(size(request%files))//' shards, ' &
         //integer_text(grid%count())//' impacts'//new_line('a')//new_line('a') &
         //validity//lines, error)
   end subroutine write_merged

end module vcor_app_merge
