!> A whole text file as one text
module vcor_io_text_file
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_error, only : error_file, error_input, error_t, raise
   use vcor_buffer, only : buffer_t
   use vcor_text, only : printable, shortened
   implicit none
   private

   public :: read_text_file, largest_file

   !> Largest file that is read [bytes]; a case has a few hundred, a long Prony series a few
   !> thousand, a table of 10,000 points half a million
   integer, parameter :: largest_file = 4*1024**2
   character(len=*), parameter :: too_large = 'the file is larger than 4 MB, expected '
   !> What a file is unless the caller says otherwise
   character(len=*), parameter :: usual_kind = 'a case file'

contains

   !> Read a file as it is
   subroutine read_text_file(filename, text, error, kind)
      character(len=*), intent(in) :: filename
      character(len=:), allocatable, intent(out) :: text
      !> Error of code `error_file` when it cannot be read, `error_input` when it is too large
      type(error_t), allocatable, intent(out) :: error
      !> What the file is to be, for messages; absent: a case file
      character(len=*), intent(in), optional :: kind
      character(len=256) :: message
      character(len=:), allocatable :: expected
      integer(int64) :: bytes
      integer :: unit, status
      logical :: found

      expected = usual_kind
      if (present(kind)) expected = kind
      if (len_trim(filename) == 0) then
         call raise(error, error_file, 'the name of the file is empty, expected that of '//expected)
         return
      end if
      ! gfortran opens a directory as if it were a file
      inquire (file=trim(filename)//'/.', exist=found)
      if (found) then
         call raise(error, error_file, printable(filename) &
            //': found a directory, expected '//expected)
         return
      end if
      inquire (file=trim(filename), exist=found)
      if (.not. found) then
         call raise(error, error_file, printable(filename)//': there is no such file')
         return
      end if
      open (newunit=unit, file=trim(filename), status='old', action='read', access='stream', &
         form='unformatted', iostat=status, iomsg=message)
      if (status /= 0) then
         call raise(error, error_file, printable(filename)//': cannot open the file: ' &
            //reason(message))
         return
      end if
      inquire (unit=unit, size=bytes)
      if (bytes > largest_file) then
         call raise(error, error_input, printable(filename)//': '//too_large//expected)
      else if (bytes > 0) then
         allocate (character(len=int(bytes)) :: text)
         read (unit, iostat=status, iomsg=message) text
         if (status /= 0) call raise(error, error_file, &
            printable(filename)//': cannot read the file: '//reason(message))
      else
         call read_pipe(unit, filename, expected, text, error)
      end if
      close (unit)
   end subroutine read_text_file

   !> Read what has no size beforehand, such as a pipe, byte by byte
   subroutine read_pipe(unit, filename, expected, text, error)
      !> Unit, open for stream access
      integer, intent(in) :: unit
      character(len=*), intent(in) :: filename
      !> What the file is to be, for messages
      character(len=*), intent(in) :: expected
      character(len=:), allocatable, intent(out) :: text
      type(error_t), allocatable, intent(inout) :: error
      type(buffer_t) :: buffer
      character(len=256) :: message
      character :: byte
      integer :: status

      do
         read (unit, iostat=status, iomsg=message) byte
         if (status /= 0) exit
         call buffer%add(byte)
         if (buffer%length > largest_file) then
            call raise(error, error_input, printable(filename)//': '//too_large//expected)
            return
         end if
      end do
      text = buffer%text()
      if (.not. is_iostat_end(status)) call raise(error, error_file, &
         printable(filename)//': cannot read the file: '//reason(message))
   end subroutine read_pipe

   !> The system's reason out of a message of the compiler's library, which repeats the file name
   !> before it
   function reason(message) result(text)
      !> Message of an input statement
      character(len=*), intent(in) :: message
      !> What stands after the last colon
      character(len=:), allocatable :: text

      text = shortened(trim(adjustl(message(index(message, ': ', back=.true.)+1:))))
   end function reason

end module vcor_io_text_file
