!> From a figure to its file: script and data are written, gnuplot draws
!>
!> All is made in a private folder beside the file (`vcor_io_file`), and renamed when it is
!> complete, so that no half figure is ever seen. Gnuplot runs without the settings of the user,
!> which would make a figure look different from machine to machine.
module vcor_io_drawing
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_figure, only : figure_t
   use vcor_io_file, only : check_target, make_scratch, move_file, remember, remove_scratch, &
      & write_file
   use vcor_io_gnuplot, only : data_text, script_text
   use vcor_io_path, only : file_exists, for_shell, join_path, make_directory, quoted_path
   implicit none
   private

   public :: draw, has_gnuplot, split_path

contains

   !> Draw a figure
   !>
   !> Where gnuplot is missing, or fails, the script and its data are left and the error names the
   !> script.
   subroutine draw(figure, path, format, keep, error)
      type(figure_t), intent(in) :: figure
      !> Its file without the extension; replaced if it is there
      character(len=*), intent(in) :: path
      !> One of `formats` of `vcor_io_gnuplot`, which is the extension too
      character(len=*), intent(in) :: format
      !> Whether script and data, `path.gp` and `path.dat`, are left
      logical, intent(in) :: keep
      !> Error of code `error_file`
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: directory, folder, name
      logical :: done, installed

      call split_path(path, directory, name)
      call make_directory(directory, error)
      if (.not. allocated(error)) call check_target(path//"."//format, error)
      if (.not. allocated(error)) call check_target(path//".gp", error)
      if (.not. allocated(error)) call check_target(path//".dat", error)
      if (.not. allocated(error)) call make_scratch(folder, path//"."//format, error)
      if (allocated(error)) return
      call remember(join_path(folder, name//"."//format))
      call remember(join_path(folder, name//".dat"))
      call remember(join_path(folder, name//".gp"))

      call write_file(join_path(folder, name//".gp"), script_text(figure, name, format), error)
      if (.not. allocated(error)) &
         & call write_file(join_path(folder, name//".dat"), data_text(figure), error)
      if (.not. allocated(error)) then
         installed = has_gnuplot()
         done = .false.
         if (installed) call run_gnuplot(join_path(folder, name), format, done)
         if (done) call take_over(format)
         if (keep .or. .not. done) then
            call take_over("dat")
            call take_over("gp")
         end if
         if (.not. allocated(error) .and. .not. installed) then
            call raise(error, error_file, "cannot draw "//quoted_path(path//"."//format) &
               & //": there is no gnuplot (Debian's package gnuplot-nox); its script is written, " &
               & //quoted_path(path//".gp"))
         else if (.not. allocated(error) .and. .not. done) then
            call raise(error, error_file, "cannot draw "//quoted_path(path//"."//format) &
               & //": gnuplot fails; to see why: gnuplot "//for_shell(path//".gp"))
         end if
      end if

      call remove_scratch(join_path(folder, name//"."//format))
      call remove_scratch(join_path(folder, name//".dat"))
      call remove_scratch(join_path(folder, name//".gp"))
      call remove_scratch(folder)

   contains

      !> Give a file its real name
      subroutine take_over(extension)
         character(len=*), intent(in) :: extension

         if (allocated(error)) return
         call move_file(join_path(folder, name//"."//extension), path//"."//extension, error)
      end subroutine take_over
   end subroutine draw

   !> Whether gnuplot is in the PATH
   function has_gnuplot() result(has)
      !> True if it is
      logical :: has
      integer :: code, status

      code = 1
      call execute_command_line("command -v gnuplot >/dev/null 2>&1", exitstat=code, cmdstat=status)
      has = status == 0 .and. code == 0
   end function has_gnuplot

   !> Let gnuplot draw
   subroutine run_gnuplot(path, format, done)
      !> Script without its extension
      character(len=*), intent(in) :: path
      !> Format of the figure
      character(len=*), intent(in) :: format
      !> Whether there is a figure now
      logical, intent(out) :: done
      integer :: code, status

      code = 1
      call execute_command_line("gnuplot --default-settings "//for_shell(path//".gp") &
         & //" </dev/null >/dev/null 2>&1", exitstat=code, cmdstat=status)
      done = file_exists(path//"."//format)
      done = done .and. status == 0 .and. code == 0
   end subroutine run_gnuplot

   !> Folder and name of a path
   pure subroutine split_path(path, directory, name)
      character(len=*), intent(in) :: path
      !> Its folder, with the slash; empty: the current one
      character(len=:), allocatable, intent(out) :: directory
      !> What comes after it
      character(len=:), allocatable, intent(out) :: name
      integer :: slash

      slash = index(path, "/", back=.true.)
      directory = path(:slash)
      name = path(slash+1:)
   end subroutine split_path

end module vcor_io_drawing
