!> Numbers in order
module vcor_numeric_sorting
   use vcor_kinds, only : wp
   implicit none
   private

   public :: sort

contains

   !> Sort numbers, in a time proportional to n log n whatever their order: runs of 1, 2, 4 ...
   !> numbers are merged
   pure subroutine sort(values)
      !> Finite numbers, increasing afterwards, shape (n)
      real(wp), intent(inout) :: values(:)

      real(wp), allocatable :: merged(:)
      integer :: n, run, start, middle, end, i, j, k

      n = size(values)
      allocate (merged(n))
      run = 1
      do while (run < n)
         do start = 1, n, 2*run
            middle = min(start + run, n + 1)
            end = min(start + 2*run, n + 1)
            i = start
            j = middle
            do k = start, end - 1
               if (j >= end) then
                  merged(k) = values(i)
                  i = i + 1
               else if (i >= middle) then
                  merged(k) = values(j)
                  j = j + 1
               else if (values(i) <= values(j)) then
                  merged(k) = values(i)
                  i = i + 1
               else
                  merged(k) = values(j)
                  j = j + 1
               end if
            end do
         end do
         values = merged
         run = 2*run
      end do
   end subroutine sort

end module vcor_numeric_sorting
