!> The seal of a file: a check sum over all its bytes, appended to it
!>
!> HDF5 trusts what it reads: a damaged text of variable length makes it crash or loop forever. So
!> HDF5 must not read a damaged file. Files of this program end with a seal, which HDF5 ignores, as
!> a file may be longer than HDF5 records:
!>
!>     first byte (from 0) and number of bytes of each part of the file that is left out, ascending
!>     number of these parts
!>     CRC-32 of all bytes before it but those
!>     `vcorseal`
!>
!> Numbers are 64-bit integers, little endian. Left out are the outcomes in the file of an
!> unfinished sweep or a shard, whose rows have check sums of their own. A program that changes the
!> file through HDF5 cuts the seal off. Such a file ends where HDF5 records its end, and is accepted
!> like one that another program has made.
module vcor_io_seal
   use, intrinsic :: iso_fortran_env, only : int32, int64, int8
   use vcor_error, only : error_file, error_t, raise
   use vcor_text, only : printable
   implicit none
   private

   public :: seal_of, check_seal, is_altered, crc32

   !> End of a seal
   character(len=8), parameter :: mark = 'vcorseal'
   !> Bytes of a number, and of the fixed part of a seal
   integer, parameter :: word = 8, fixed = 3*word
   !> One byte
   integer(int8), parameter :: byte(1) = 0_int8

   !> The divisor without its leading term, the lowest power in the highest bit: 0xEDB88320
   integer(int32), parameter :: divisor = -306674912_int32
   integer :: i_byte
   !> Remainders of the numbers 0 to 15 after division of 0, 1, ... 4 of their bits
   integer(int32), parameter :: &
      nibble0(0:15) = [(int(i_byte, int32), i_byte=0, 15)], &
      nibble1(0:15) = ieor(shiftr(nibble0, 1), iand(nibble0, 1_int32)*divisor), &
      nibble2(0:15) = ieor(shiftr(nibble1, 1), iand(nibble1, 1_int32)*divisor), &
      nibble3(0:15) = ieor(shiftr(nibble2, 1), iand(nibble2, 1_int32)*divisor), &
      nibble4(0:15) = ieor(shiftr(nibble3, 1), iand(nibble3, 1_int32)*divisor)
   !> Remainders of the bytes 0 to 255 after division of 0, 4 and 8 of their bits
   integer(int32), parameter :: &
      bits0(0:255) = [(int(i_byte, int32), i_byte=0, 255)], &
      bits4(0:255) = ieor(shiftr(bits0, 4), nibble4(iand(bits0, 15_int32))), &
      bits8(0:255) = ieor(shiftr(bits4, 4), nibble4(iand(bits4, 15_int32)))
   !> Mask of the lowest byte, and remainders of a byte followed by 1, 2 and 3 zero bytes: with them
   !> four bytes are processed at a time
   integer(int32), parameter :: lowest = 255_int32, &
      bits16(0:255) = ieor(shiftr(bits8, 8), bits8(iand(bits8, lowest))), &
      bits24(0:255) = ieor(shiftr(bits16, 8), bits8(iand(bits16, lowest))), &
      bits32(0:255) = ieor(shiftr(bits24, 8), bits8(iand(bits24, lowest)))

contains

   !> Seal of a file
   function seal_of(path, left_out) result(seal)
      !> Path of the file, without a seal yet
      character(len=*), intent(in) :: path
      !> First byte, from 0, and number of bytes of each part to leave out, ascending, shape (2, n)
      integer(int64), intent(in) :: left_out(:, :)
      !> Seal to append; empty if the file cannot be read
      character(len=:), allocatable :: seal

      integer(int64) :: bytes, numbers(size(left_out) + 2)
      integer :: n, status, unit

      n = size(left_out)
      numbers(:n) = reshape(left_out, [n])
      numbers(n + 1) = size(left_out, 2, kind=int64)
      seal = ''
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', &
         action='read', iostat=status)
      if (status /= 0) return
      inquire (unit=unit, size=bytes)
      numbers(n + 2) = sum_of_file(unit, bytes, left_out)
      close (unit)
      if (numbers(n + 2) < 0) return
      deallocate (seal)
      allocate (character(len=word*size(numbers) + len(mark)) :: seal)
      seal = transfer([transfer(numbers, byte), transfer(mark, byte)], seal)
   end function seal_of

   !> Check that a file is as this program wrote it; one without a seal passes if it ends where HDF5
   !> records its end
   subroutine check_seal(path, error)
      !> Path of an existing file
      character(len=*), intent(in) :: path
      !> Error of code `error_file` if the file is damaged, unallocated otherwise
      type(error_t), allocatable, intent(out) :: error

      if (is_altered(path, .true.)) call raise(error, error_file, printable(path)//': this file ' &
         //'is damaged: its check sum is wrong; remove it, and run what has made it once more')
   end subroutine check_seal

   !> Whether a file has changed since it was sealed
   function is_altered(path, cut_counts) result(yes)
      !> Path of the file
      character(len=*), intent(in) :: path
      !> Whether a file without a seal counts as altered if it does not end where HDF5 records
      logical, intent(in) :: cut_counts
      !> False if the file cannot be opened: HDF5 reports the reason
      logical :: yes

      character(len=len(mark)) :: found
      integer(int64) :: bytes
      integer :: status, unit

      yes = .false.
      open (newunit=unit, file=trim(path), access='stream', form='unformatted', status='old', &
         action='read', iostat=status)
      if (status /= 0) return
      inquire (unit=unit, size=bytes)
      found = ''
      if (bytes >= fixed) read (unit, pos=bytes - len(mark) + 1, iostat=status) found
      if (status == 0 .and. found == mark) then
         yes = .not. is_sealed(unit, bytes)
      else if (cut_counts) then
         yes = .not. ends_well(unit, bytes)
      end if
      close (unit)
   end function is_altered

   !> Whether the seal matches the file
   function is_sealed(unit, bytes) result(is_sound)
      integer, intent(in) :: unit
      !> Length of the file [bytes]
      integer(int64), intent(in) :: bytes
      logical :: is_sound

      integer(int64), allocatable :: left_out(:, :)
      integer(int64) :: count, expected, length
      integer :: status

      is_sound = .false.
      read (unit, pos=bytes - fixed + 1, iostat=status) count, expected
      if (status /= 0 .or. count < 0 .or. count > (bytes - fixed)/(2*word)) return
      ! bytes before the seal
      length = bytes - fixed - 2*word*count
      allocate (left_out(2, count), stat=status)
      if (status /= 0) return
      if (count > 0) read (unit, pos=length + 1, iostat=status) left_out
      if (status /= 0 .or. any(left_out < 0) .or. any(left_out > length)) return
      is_sound = expected == sum_of_file(unit, length, left_out)
   end function is_sealed

   !> Check sum of a file and of the positions of the parts left out
   function sum_of_file(unit, length, left_out) result(number)
      integer, intent(in) :: unit
      !> Number of bytes before the seal
      integer(int64), intent(in) :: length
      !> Parts to leave out, ascending, shape (2, n)
      integer(int64), intent(in) :: left_out(:, :)
      !> The sum; negative if the file cannot be read
      integer(int64) :: number

      integer(int64), parameter :: block_length = 65536
      integer(int64) :: start
      integer(int8) :: block(block_length)
      integer(int32) :: sum
      integer :: status

      number = -1
      sum = 0
      do start = 0, length - 1, block_length
         associate (part => block(:min(block_length, length - start)))
            read (unit, pos=start + 1, iostat=status) part
            if (status /= 0) return
            sum = sum_of(part, start, left_out, sum)
         end associate
      end do
      sum = crc32(transfer([reshape(left_out, [size(left_out)]), size(left_out, 2, kind=int64)], &
         byte), sum)
      number = ibits(int(sum, int64), 0, 32)
   end function sum_of_file

   !> Check sum of a block of a file without the parts left out
   pure function sum_of(bytes, start, left_out, before) result(sum)
      integer(int8), intent(in), contiguous :: bytes(:)
      !> Number of bytes before it in the file
      integer(int64), intent(in) :: start
      !> Parts to leave out, ascending, shape (2, n)
      integer(int64), intent(in) :: left_out(:, :)
      !> Check sum of what precedes it
      integer(int32), intent(in) :: before
      integer(int32) :: sum

      integer(int64) :: first, last
      integer :: i

      sum = before
      first = 1
      do i = 1, size(left_out, 2)
         last = min(left_out(1, i) - start, size(bytes, kind=int64))
         if (last >= first) sum = crc32(bytes(first:last), sum)
         first = max(first, left_out(1, i) + left_out(2, i) - start + 1)
      end do
      if (first <= size(bytes, kind=int64)) sum = crc32(bytes(first:), sum)
   end function sum_of

   !> Whether a file ends where HDF5 records its end, or has no record in this program's format
   function ends_well(unit, bytes) result(is_sound)
      integer, intent(in) :: unit
      !> Length of the file [bytes]
      integer(int64), intent(in) :: bytes
      logical :: is_sound

      ! superblock of HDF5 1.8: 8 bytes of signature, version, sizes of offsets and lengths, flags,
      ! then offsets: base address, extension, end of file
      integer, parameter :: versions(2) = [2, 3], at_version = 9, at_end = 29
      integer(int8) :: version
      integer(int64) :: end_of_file
      integer :: status

      is_sound = .true.
      if (bytes < at_end + word) return
      read (unit, pos=at_version, iostat=status) version
      if (status /= 0 .or. all(versions /= version)) return
      read (unit, pos=at_end, iostat=status) end_of_file
      if (status == 0) is_sound = end_of_file == bytes
   end function ends_well

   !> Check sum of bytes: CRC-32 as in zip, PNG and Ethernet (`zlib.crc32` of Python)
   !>
   !> The bytes are read as a polynomial over the integers modulo 2; the sum is its remainder after
   !> division by a polynomial of degree 32. It detects every error of one bit, of two bits (in up
   !> to 512 MiB) and within 32 consecutive bits; of other errors one in 2**32 escapes.
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
         crc = ieor(ieor(bits32(iand(crc, lowest)), bits24(iand(shiftr(crc, 8), lowest))), &
            ieor(bits16(iand(shiftr(crc, 16), lowest)), bits8(shiftr(crc, 24))))
      end do
      do k = k, size(bytes, kind=int64)
         crc = ieor(shiftr(crc, 8), bits8(iand(ieor(crc, int(bytes(k), int32)), lowest)))
      end do
      crc = not(crc)
   end function crc32

end module vcor_io_seal
