!> Check sums of bytes: CRC-32 as in zip, PNG and Ethernet (`zlib.crc32` of Python)
!>
!> The bits of the bytes are the coefficients of a polynomial over the integers modulo 2; the sum is
!> its remainder, divided by a polynomial of degree 32. No flip of one or two bits passes unseen, no
!> damage within 32 bits in a row, and of other damage one in 2**32.
module vcor_numeric_crc
   use, intrinsic :: iso_fortran_env, only : int32, int8
   implicit none
   private

   public :: crc_t, new_crc

   !> The divisor, 0xEDB88320: its coefficients from the lowest power on, the highest bit first
   integer(int32), parameter :: divisor = -306674912_int32
   !> Bytes that are divided at a time
   integer, parameter :: at_once = 8

   !> Remainders of single bytes, which make those of all others
   type :: crc_t
      private
      !> Remainder of each byte with 0 to 7 bytes of zeros behind it
      integer(int32) :: table(0:255, 0:at_once - 1)
   contains
      !> Check sum of bytes
      procedure :: of
   end type crc_t

contains

   !> Prepare; it takes as long as the sum of a few thousand bytes
   pure function new_crc() result(self)
      !> The remainders
      type(crc_t) :: self

      integer(int32) :: remainder
      integer :: i, j

      do i = 0, 255
         remainder = int(i, int32)
         do j = 1, 8
            remainder = ieor(shiftr(remainder, 1), merge(divisor, 0_int32, btest(remainder, 0)))
         end do
         self%table(i, 0) = remainder
      end do
      do j = 1, at_once - 1
         do i = 0, 255
            remainder = self%table(i, j - 1)
            self%table(i, j) = ieor(shiftr(remainder, 8), &
               self%table(iand(remainder, 255_int32), 0))
         end do
      end do
   end function new_crc

   !> Check sum of bytes
   pure function of(self, bytes, before) result(crc)
      !> The remainders
      class(crc_t), intent(in) :: self
      !> Bytes, shape (n)
      integer(int8), intent(in), contiguous :: bytes(:)
      !> Sum of the bytes before them; 0 where there are none
      integer(int32), intent(in) :: before
      !> The sum
      integer(int32) :: crc

      integer(int32) :: word, next
      integer :: i, last

      crc = not(before)
      last = size(bytes) - modulo(size(bytes), at_once)
      do i = 1, last, at_once
         word = ieor(crc, transfer(bytes(i:i + 3), word))
         next = transfer(bytes(i + 4:i + 7), next)
         crc = ieor(of_word(word, 4), of_word(next, 0))
      end do
      do i = last + 1, size(bytes)
         word = ieor(crc, int(bytes(i), int32))
         crc = ieor(shiftr(crc, 8), self%table(iand(word, 255_int32), 0))
      end do
      crc = not(crc)

   contains

      !> Remainder of four bytes
      pure function of_word(word, zeros) result(remainder)
         !> The bytes, the first one in the lowest bits
         integer(int32), intent(in) :: word
         !> Bytes of zeros behind them
         integer, intent(in) :: zeros
         !> The remainder
         integer(int32) :: remainder

         remainder = ieor(ieor(self%table(iand(word, 255_int32), zeros + 3), &
            self%table(iand(shiftr(word, 8), 255_int32), zeros + 2)), &
            ieor(self%table(iand(shiftr(word, 16), 255_int32), zeros + 1), &
            self%table(shiftr(word, 24), zeros)))
      end function of_word
   end function of

end module vcor_numeric_crc
