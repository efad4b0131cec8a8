!> Merging the shards of a sweep: the files of a run that has solved it in one piece
module vcor_app_merge
   use vcor_app_cli, only : request_t
   use vcor_app_job, only : endings
   use vcor_app_previous, only : look_at, previous_t, remark, replaced
   use vcor_case_axes, only : new_grid
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : validate
   use vcor_case_grid, only : grid_t
   use vcor_error, only : error_file, error_numerical, error_t, raise
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_case_reader, only : read_case_text
   use vcor_io_checkpoint_points, only : read_points
   use vcor_io_file, only : write_stdout
   use vcor_io_hdf5, only : remark_t
   use vcor_io_identity, only : check_same, identity_t, read_identity, remarks_of
   use vcor_text, only : integer_text
   use vcor_io_path, only : join_path, make_directory, quoted_path, same_file
   use vcor_io_results, only : summary_table, write_summary
   use vcor_io_table, only : table_t
   use vcor_sweep_part, only : new_part
   use vcor_sweep_quantity, only : point_pending, status_name
   use vcor_sweep_summary, only : new_summary, summary_t
   use vcor_version, only : version
   implicit none
   private

   public :: merge_shards

contains

   !> Merge shards
   subroutine merge_shards(request, error)
      !> The request
      type(request_t), intent(in) :: request
      !> Error of code `error_file` if shards are missing or do not belong together, of code
      !> `error_numerical` if points have no result; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: identity
      type(case_t) :: case
      type(grid_t) :: grid
      type(summary_t) :: summary
      type(error_t), allocatable :: trouble

      call identify(request, identity, error)
      if (allocated(error)) return
      call read_case_text(case, identity%case_text, request%files(1)%text, error)
      if (.not. allocated(error)) call validate(case, error)
      if (.not. allocated(error)) call new_grid(case, grid, error)
      if (allocated(error)) return
      if (grid%count() /= identity%part%points) then
         call raise(error, error_file, quoted_path(request%files(1)%text)//' has a case of ' &
            //integer_text(grid%count())//' points, expected '//integer_text(identity%part%points))
         return
      end if
      call new_summary(summary, grid%count(), error)
      if (.not. allocated(error)) call gather(request, identity, summary, error)
      if (allocated(error)) return
      call judge(identity, summary, error)
      call write_merged(request, case, identity, grid, summary, trouble)
      if (allocated(trouble)) call move_alloc(trouble, error)
   end subroutine merge_shards

   !> See whether the files are all shards of one sweep
   subroutine identify(request, first, error)
      !> The request
      type(request_t), intent(in) :: request
      !> What the first file is about
      type(identity_t), intent(out) :: first
      !> Error of code `error_file`, unallocated if they are
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: found
      integer, allocatable :: owner(:)
      integer :: i, j
      logical :: is_ours

      allocate (owner(0))
      do i = 1, size(request%files)
         associate (path => request%files(i)%text)
            call read_identity(path, found, is_ours, error)
            if (allocated(error)) return
            if (.not. is_ours .or. found%part%points == 0) then
               call raise(error, error_file, quoted_path(path)//' is no shard of a sweep of vcor')
               return
            end if
            if (i == 1) then
               first = found
               first%version = version
               owner = [(0, j=1, found%part%parts)]
            end if
            call check_same(path, found, first, error)
            if (allocated(error)) return
            associate (number => found%part%number)
               if (number > size(owner)) then
                  call raise(error, error_file, quoted_path(path)//' is shard ' &
                     //integer_text(number)//' of '//integer_text(size(owner)))
               else if (owner(number) > 0) then
                  call raise(error, error_file, quoted_path(path)//' is shard ' &
                     //integer_text(number)//' of '//integer_text(size(owner))//', as is ' &
                     //quoted_path(request%files(owner(number))%text)//'; expected each one once')
               else
                  owner(number) = i
               end if
            end associate
            if (allocated(error)) return
         end associate
      end do
      if (any(owner == 0)) call raise(error, error_file, 'missing: '//missing(owner)//' of ' &
         //integer_text(size(owner))//' shards; expected all of them')
   end subroutine identify

   !> Shards that are missing
   function missing(owner) result(text)
      !> Number of the file of each shard; 0 where there is none
      integer, intent(in) :: owner(:)
      !> Their numbers
      character(len=:), allocatable :: text

      integer, parameter :: most_named = 10
      integer :: i, named

      text = ''
      named = 0
      do i = 1, size(owner)
         if (owner(i) > 0) cycle
         named = named + 1
         if (named > most_named) cycle
         if (named > 1) text = text//', '
         text = text//integer_text(i)
      end do
      if (named > most_named) text = text//' and '//integer_text(named - most_named)//' more'
   end function missing

   !> Outcomes of all shards in one summary
   subroutine gather(request, identity, summary, error)
      !> The request
      type(request_t), intent(in) :: request
      !> What all files are about
      type(identity_t), intent(in) :: identity
      !> Outcomes by the number of the point
      type(summary_t), intent(inout) :: summary
      !> Error of code `error_file` if a shard is not finished; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: expected, found
      type(summary_t) :: shard
      integer :: i, j, k, number

      do i = 1, size(request%files)
         associate (path => request%files(i)%text)
            ! its number is all that a shard has of its own
            number = number_in(path, error)
            if (allocated(error)) return
            expected = identity
            expected%part = new_part(identity%part%points, number, identity%part%parts)
            call new_summary(shard, expected%part%count(), error)
            if (allocated(error)) return
            call read_points(path, found, shard, error, expected)
            if (allocated(error)) return
            if (any(shard%status == point_pending)) then
               call raise(error, error_file, quoted_path(path)//' is not finished: ' &
                  //integer_text(count(shard%status == point_pending))//' of its ' &
                  //integer_text(size(shard%status))//' points are pending; --resume finishes it')
               return
            end if
            do j = 1, expected%part%count()
               k = expected%part%point(j)
               summary%steps(k) = shard%steps(j)
               summary%status(k) = shard%status(j)
            end do
            call place_values(expected, shard, summary)
         end associate
      end do
   end subroutine gather

   !> Number of the shard in a file
   function number_in(path, error) result(number)
      !> Path of the file
      character(len=*), intent(in) :: path
      !> Set if it cannot be read
      type(error_t), allocatable, intent(out) :: error
      !> The number
      integer :: number

      type(identity_t) :: found
      logical :: is_ours

      number = 0
      call read_identity(path, found, is_ours, error)
      if (.not. allocated(error)) number = found%part%number
   end function number_in

   !> Numbers of a shard in their places
   subroutine place_values(identity, shard, summary)
      !> What the shard is about
      type(identity_t), intent(in) :: identity
      !> Its outcomes
      type(summary_t), intent(in) :: shard
      !> Outcomes by the number of the point
      type(summary_t), intent(inout) :: summary

      integer :: i, j

      do i = 1, size(summary%values)
         do j = 1, size(shard%status)
            summary%values(i)%at(identity%part%point(j)) = shard%values(i)%at(j)
         end do
      end do
   end subroutine place_values

   !> Points without a result make an error of the whole, as in a run
   subroutine judge(identity, summary, error)
      !> What the sweep is about
      type(identity_t), intent(in) :: identity
      !> Outcomes
      type(summary_t), intent(in) :: summary
      !> Error of code `error_numerical`, unallocated where all points have a result
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
   subroutine write_merged(request, case, identity, grid, summary, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The case
      type(case_t), intent(in) :: case
      !> What the sweep is about
      type(identity_t), intent(in) :: identity
      !> Its grid
      type(grid_t), intent(in) :: grid
      !> Outcomes
      type(summary_t), intent(inout) :: summary
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: whole
      type(previous_t) :: previous
      type(remark_t) :: remarks(4)
      type(table_t) :: table
      character(len=:), allocatable :: directory, stem, path, text
      logical :: csv, hdf5
      integer :: i, n

      call case%get('output', 'directory', directory)
      if (allocated(request%directory)) directory = request%directory
      call case%get('output', 'stem', stem)
      path = join_path(directory, stem)
      call case%get('output', 'csv', csv)
      call case%get('output', 'hdf5', hdf5)
      do i = 1, size(request%files)
         if (.not. same_file(request%files(i)%text, path//trim(endings(3)))) cycle
         call raise(error, error_file, quoted_path(request%files(i)%text) &
            //' would be replaced by what it is merged into: give another --output')
         return
      end do
      whole = identity
      whole%part = new_part(identity%part%points, 1, 1)
      call look_at(path, endings, [csv, .false., hdf5], whole, previous)

      call summary_table(table, identity%title, identity%case_text, grid, summary)
      remarks = remarks_of(identity)
      n = merge(1, 0, len(identity%data) > 0)
      text = integer_text(size(request%files))//' shards, '//integer_text(grid%count()) &
         //' impacts'//new_line('a')//new_line('a')
      call make_directory(directory, error)
      if (allocated(error)) return
      call write_summary(name_of(1, csv), name_of(3, hdf5), table, remarks(:n), error)
      if (allocated(error)) return
      if (csv) text = text//'  written '//name_of(1, csv)//new_line('a')
      if (hdf5) text = text//'  written '//name_of(3, hdf5)//new_line('a')
      call remark(replaced(previous))
      if (.not. request%quiet) call write_stdout(text, error)

   contains

      !> Name of a file
      function name_of(i, is_written) result(name)
         !> Number of its ending
         integer, intent(in) :: i
         !> Whether it is written
         logical, intent(in) :: is_written
         !> The name; empty if it is not
         character(len=:), allocatable :: name

         name = ''
         if (is_written) name = path//trim(endings(i))
      end function name_of
   end subroutine write_merged

end module vcor_app_merge
