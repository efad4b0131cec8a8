!> The command plot: figures of results
module vcor_app_plot
   use vcor_app_cli, only : request_t
   use vcor_app_place, only : find_place
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_figure_build, only : build_figure, figure_kinds => kinds, legend_t, read_result, &
      result_t, usual_kind
   use vcor_io_drawing, only : draw
   use vcor_io_figure, only : figure_t
   use vcor_io_file, only : write_stdout
   use vcor_io_gnuplot, only : figure_formats => formats
   use vcor_text, only : integer_text, printable
   use vcor_io_path, only : same_file
   use vcor_words, only : contains_word, suggestion
   implicit none
   private

   public :: plot

contains

   !> Draw the figure of a request
   subroutine plot(request, error)
      type(request_t), intent(in) :: request
      type(error_t), allocatable, intent(out) :: error

      type(result_t), allocatable :: results(:)
      type(figure_t) :: figure
      character(len=:), allocatable :: kind, path, format
      integer :: i

      call check_request(request, error)
      if (allocated(error)) return
      allocate (results(size(request%files)))
      do i = 1, size(results)
         call read_result(results(i), request%files(i)%text, error)
         if (allocated(error)) return
      end do
      kind = ''
      if (allocated(request%kind)) kind = request%kind
      call build_figure(results, kind, texts_of(request, .true.), texts_of(request, .false.), &
         figure, error)
      if (allocated(error)) return

      if (kind == '') call usual_kind(results(1), kind, error)
      if (allocated(error)) return
      call find_path(request, results(1)%stem//'_'//kind, path, format, error)
      if (.not. allocated(error)) call keep_inputs(request, path, format, error)
      if (.not. allocated(error)) call draw(figure, path, format, request%script, error)
      if (allocated(error) .or. request%quiet) return
      call write_stdout('written '//path//'.'//format//new_line('a'), error)
      if (request%script .and. .not. allocated(error)) call write_stdout('written '//path//'.gp' &
         //new_line('a')//'written '//path//'.dat'//new_line('a'), error)
   end subroutine plot

   !> Refuse values of options that are not known
   subroutine check_request(request, error)
      type(request_t), intent(in) :: request
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (allocated(request%kind)) then
         if (.not. contains_word(figure_kinds, request%kind)) call raise(error, error_usage, &
            "unknown kind '"//printable(request%kind)//"' in --kind; " &
            //suggestion(request%kind, figure_kinds))
      end if
      if (allocated(request%format) .and. .not. allocated(error)) then
         if (.not. contains_word(figure_formats, request%format)) call raise(error, error_usage, &
            "unknown format '"//printable(request%format)//"' in --format; " &
            //suggestion(request%format, figure_formats))
      end if
      if (allocated(error)) return
      if (size(request%legends) > 0 .and. size(request%legends) /= size(request%files)) &
         call raise(error, error_usage, 'found '//integer_text(size(request%legends)) &
         //' --legend for '//integer_text(size(request%files)) &
         //' file(s) of results, expected one for each')
   end subroutine check_request

   !> Texts of --legend, or names of --quantity
   function texts_of(request, of_legend) result(texts)
      type(request_t), intent(in) :: request
      !> Which ones
      logical, intent(in) :: of_legend
      !> The texts, shape (n)
      type(legend_t), allocatable :: texts(:)

      integer :: i

      if (of_legend) then
         allocate (texts(size(request%legends)))
         do i = 1, size(texts)
            texts(i)%text = printable(request%legends(i)%text)
         end do
      else
         allocate (texts(size(request%names)))
         do i = 1, size(texts)
            texts(i)%text = request%names(i)%text
         end do
      end if
   end function texts_of

   !> Where the figure goes
   subroutine find_path(request, usual, path, format, error)
      type(request_t), intent(in) :: request
      !> Name where none is given
      character(len=*), intent(in) :: usual
      !> File without its extension
      character(len=:), allocatable, intent(out) :: path
      !> Its extension, a known format
      character(len=:), allocatable, intent(out) :: format
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: ending

      format = 'svg'
      if (allocated(request%format)) format = request%format
      path = usual
      if (.not. allocated(request%directory)) return
      call find_place(request%directory, usual, figure_formats, path, ending, error)
      if (allocated(error) .or. ending == '') return
      if (allocated(request%format) .and. ending /= format) call raise(error, error_usage, &
         "the name '"//printable(request%directory)//"' ends with ."//ending &
         //', but --format is '//format)
      format = ending
   end subroutine find_path

   !> No file that is written may be one of the results
   subroutine keep_inputs(request, path, format, error)
      type(request_t), intent(in) :: request
      !> File without its extension
      character(len=*), intent(in) :: path
      !> Its extension
      character(len=*), intent(in) :: format
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=3), parameter :: others(2) = ['gp ', 'dat']
      integer :: i, j

      do i = 1, size(request%files)
         if (same_file(path//'.'//format, request%files(i)%text)) call refuse(format)
         do j = 1, size(others)
            if (same_file(path//'.'//trim(others(j)), request%files(i)%text)) &
               call refuse(trim(others(j)))
         end do
         if (allocated(error)) return
      end do

   contains

      !> Refuse a file
      subroutine refuse(extension)
         character(len=*), intent(in) :: extension

         call raise(error, error_input, printable(request%files(i)%text)//': the figure would ' &
            //'replace this file of results by '//printable(path)//'.'//extension &
            //'; give it another name by --output')
      end subroutine refuse
   end subroutine keep_inputs

end module vcor_app_plot
