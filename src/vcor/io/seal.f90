!> The seal of a file: a check sum over all its bytes, behind its end
!>
!> HDF5 trusts what it reads: texts of variable length that are damaged end in its crash, or in a
!> loop. So nothing of a damaged file may come to it. A file of this program ends with a seal, which
!> HDF5 does not see, as a file may be longer than HDF5 knows:
!>
!>     first byte (from 0) and number of bytes of each part of the file that is left out, ascending
!>     number of these parts
!>     CRC-32 of all bytes before it but those
!>     `vcorseal`
!>
!> Numbers are 64-bit integers, little endian. What is left out are the outcomes in the file of a
!> sweep under way or a shard: each row of them has a check sum of its own. A program that changes
!> the file through HDF5 cuts the seal off. Such a file, which ends where HDF5 says, is as good as
!> one that another program has made.
module vcor_io_seal
   use, intrinsic :: iso_fortran_env, only : int32, int64, int8
   use vcor_error, only : error_file, error_t, raise
   use vcor_numeric_crc, only : crc32
   use vcor_text, only : printable
   implicit none
   private

   public :: seal_of, check_seal, is_altered

   !> How a seal ends
   character(len=8), parameter :: mark = 'vcorseal'
   !> Bytes of a number, and of the part of a seal that is always there
   integer, parameter :: word = 8, fixed = 3*word
   !> One byte
   integer(int8), parameter :: byte(1) = 0_int8

contains

   !> Seal of a file
   function seal_of(path, left_out) result(seal)
      !> Path of the file, which has none yet
      character(len=*), intent(in) :: path
      !> First byte, from 0, and number of bytes of what is left out, ascending, shape (2, n)
      integer(int64), intent(in) :: left_out(:, :)
      !> What comes behind it; nothing if it cannot be read
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

   !> See whether a file is as this program has left it; one without a seal passes if it ends where
   !> HDF5 says
   subroutine check_seal(path, error)
      !> Path of the file, which is there
      character(len=*), intent(in) :: path
      !> Error of code `error_file` if the file is damaged, unallocated otherwise
      type(error_t), allocatable, intent(out) :: error

      if (is_altered(path, .true.)) call raise(error, error_file, printable(path)//': this file ' &
         //'is damaged: its check sum is wrong; remove it, and run what has made it once more')
   end subroutine check_seal

   !> Whether a file has a seal that is not its own
   function is_altered(path, cut_counts) result(yes)
      !> Path of the file
      character(len=*), intent(in) :: path
      !> Whether one without a seal counts, too, that does not end where HDF5 says
      logical, intent(in) :: cut_counts
      !> False of a file that cannot be opened: HDF5 says why
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

   !> Whether a seal is that of the file
   function is_sealed(unit, bytes) result(is_sound)
      integer, intent(in) :: unit
      !> Its length
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

   !> Check sum of a file and of where its parts are that are left out
   function sum_of_file(unit, length, left_out) result(number)
      integer, intent(in) :: unit
      !> Number of bytes before the seal
      integer(int64), intent(in) :: length
      !> What is left out of the file, ascending, shape (2, n)
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

   !> Check sum of what is not left out of a part of a file
   pure function sum_of(bytes, start, left_out, before) result(sum)
      integer(int8), intent(in), contiguous :: bytes(:)
      !> Number of bytes before it in the file
      integer(int64), intent(in) :: start
      !> What is left out of the file, ascending, shape (2, n)
      integer(int64), intent(in) :: left_out(:, :)
      !> Sum of what is before it
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

   !> Whether a file ends where HDF5 says, or does not say where it ends in the way of this program
   function ends_well(unit, bytes) result(is_sound)
      integer, intent(in) :: unit
      !> Its length
      integer(int64), intent(in) :: bytes
      logical :: is_sound

      ! superblock of HDF5 1.8: 8 bytes that every file begins with, version, sizes of places and
      ! lengths, flags, then places: where the file begins, of an extension, where it ends
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

end module vcor_io_seal
