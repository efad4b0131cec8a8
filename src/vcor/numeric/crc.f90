!> Check sums of bytes: CRC-32 as in zip, PNG and Ethernet (`zlib.crc32` of Python)
!>
!> The bytes are read as a polynomial over the integers modulo 2; the sum is its remainder after
!> division by a polynomial of degree 32. It detects every error of one bit, of two bits (in up to
!> 512 MiB) and within 32 consecutive bits; of other errors one in 2**32 escapes.
module vcor_numeric_crc
   use, intrinsic :: iso_fortran_env, only : int32, int64, int8
   implicit none
   private

   public :: crc32

   !> The divisor without its leading term, the lowest power in the highest bit: 0xEDB88320
   integer(int32), parameter :: divisor = -306674912_int32
   integer :: i
   !> Remainders of the numbers 0 to 15 after division of 0, 1, ... 4 of their bits
   integer(int32), parameter :: &
      nibble0(0:15) = [(int(i, int32), i=0, 15)], &
      nibble1(0:15) = ieor(shiftr(nibble0, 1), iand(nibble0, 1_int32)*divisor), &
      nibble2(0:15) = ieor(shiftr(nibble1, 1), iand(nibble1, 1_int32)*divisor), &
      nibble3(0:15) = ieor(shiftr(nibble2, 1), iand(nibble2, 1_int32)*divisor), &
      nibble4(0:15) = ieor(shiftr(nibble3, 1), iand(nibble3, 1_int32)*divisor)
   !> Remainders of the bytes 0 to 255 after division of 0, 4 and 8 of their bits
   integer(int32), parameter :: &
      bits0(0:255) = [(int(i, int32), i=0, 255)], &
      bits4(0:255) = ieor(shiftr(bits0, 4), nibble4(iand(bits0, 15_int32))), &
      bits8(0:255) = ieor(shiftr(bits4, 4), nibble4(iand(bits4, 15_int32)))
   !> Mask of the lowest byte, and remainders of a byte followed by 1, 2 and 3 zero bytes: with them
   !> four bytes are processed at a time
   integer(int32), parameter :: last = 255_int32, &
      bits16(0:255) = ieor(shiftr(bits8, 8), bits8(iand(bits8, last))), &
      bits24(0:255) = ieor(shiftr(bits16, 8), bits8(iand(bits16, last))), &
      bits32(0:255) = ieor(shiftr(bits24, 8), bits8(iand(bits24, last)))

contains

   !> Check sum of bytes
   pure function crc32(bytes, before) result(crc)
      !> Bytes, shape (n)
      integer(int8), intent(in), contiguous :: bytes(:)
      !> Check sum of the bytes before them; 0 if there are none
      integer(int32), intent(in) :: before
      integer(int32) :: crc

      integer(int64) :: k

      crc = not(before)
      do k = 1, size(bytes, kind=int64) - 3, 4
         crc = ieor(crc, transfer(bytes(k:k + 3), crc))
         crc = ieor(ieor(bits32(iand(crc, last)), bits24(iand(shiftr(crc, 8), last))), &
            ieor(bits16(iand(shiftr(crc, 16), last)), bits8(shiftr(crc, 24))))
      end do
      do k = k, size(bytes, kind=int64)
         crc = ieor(shiftr(crc, 8), bits8(iand(ieor(crc, int(bytes(k), int32)), last)))
      end do
      crc = not(crc)
   end function crc32

end module vcor_numeric_crc
