!> Where a command that writes one file puts it
module vcor_app_place
   use vcor_error, only : error_t, error_usage, raise
   use vcor_io_path, only : directory_exists, folder_of, join_path, make_directory
   use vcor_words, only : contains_word, suggestion
   use vcor_text, only : printable
   implicit none
   private

   public :: find_place

contains

   !> Where the one file of a command goes. --output means a folder, as it does for the commands
   !> that write several, or the file itself where the name has an extension of such a file.
   !> Folders that are not there are made
   subroutine find_place(output, usual, extensions, path, extension, error)
      !> Value of --output, not empty
      character(len=*), intent(in) :: output
      !> Name of the file in a folder, without its extension
      character(len=*), intent(in) :: usual
      !> Extensions that the file may have, separated by blanks; the first one is the usual one
      character(len=*), intent(in) :: extensions
      !> File without its extension
      character(len=:), allocatable, intent(out) :: path
      !> The extension that it has been given; empty if it is a folder that was given
      character(len=:), allocatable, intent(out) :: extension
      !> Code `error_usage` for another extension, `error_file` if there is no folder; unallocated
      !> on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: directory, name
      logical :: is_directory
      integer :: mark

      extension = ''
      path = trim(output)
      directory = folder_of(path)
      name = path(len(directory) + 1:)
      is_directory = directory_exists(path)
      mark = index(name, '.', back=.true.)
      if (len(name) == 0 .or. is_directory .or. mark < 2) then
         directory = path
         path = join_path(directory, usual)
      else
         extension = name(mark + 1:)
         path = directory//name(:mark - 1)
         if (.not. contains_word(extensions, extension)) then
            call raise(error, error_usage, "unknown format '"//printable(extension)//"' of '" &
               //printable(trim(output))//"'; "//suggestion(extension, extensions) &
               //"; the name of a folder ends with a slash")
            return
         end if
      end if
      call make_directory(directory, error)
   end subroutine find_place

end module vcor_app_place
