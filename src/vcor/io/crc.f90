!> Check sum of texts: whether a file, a case or a command line is the one it was
module vcor_io_crc
   use, intrinsic :: iso_fortran_env, only : int32
   implicit none
   private

   public :: crc32

contains

   !> Check sum of a text: CRC-32 as in zip, PNG and Ethernet (`zlib.crc32` of Python)
   pure function crc32(text, before) result(crc)
      character(len=*), intent(in) :: text
      !> Check sum of the text before it; 0 if there is none
      integer(int32), intent(in) :: before
      integer(int32) :: crc

      !> The divisor, the lowest power in the highest bit: 0xEDB88320
      integer(int32), parameter :: divisor = -306674912_int32
      !> Remainders of four bits; a text is divided four bits at a time
      integer(int32) :: remainders(0:15)
      integer :: bit, i

      do i = 0, 15
         remainders(i) = int(i, int32)
         do bit = 1, 4
            remainders(i) = ieor(shiftr(remainders(i), 1), iand(remainders(i), 1_int32)*divisor)
         end do
      end do
      crc = not(before)
      do i = 1, len(text)
         crc = ieor(crc, int(iachar(text(i:i)), int32))
         crc = ieor(shiftr(crc, 4), remainders(iand(crc, 15_int32)))
         crc = ieor(shiftr(crc, 4), remainders(iand(crc, 15_int32)))
      end do
      crc = not(crc)
   end function crc32

end module vcor_io_crc
