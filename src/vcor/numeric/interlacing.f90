!> Zeros of a sum of simple poles with positive weights, which interlace with the poles
!>
!> f(x) = c + sum_j w_j/(d_j - x) with w_j > 0 rises from minus to plus infinity between two poles,
!> so there is one zero in each gap, and one beyond the last pole if c > 0.
module vcor_numeric_interlacing
   use vcor_kinds, only : wp
   implicit none
   private

   public :: zeros_between_poles

contains

   !> Zeros of f, each as its distance from the nearest pole: differences between zeros and poles
   !> then keep all their digits
   pure subroutine zeros_between_poles(pole, weight, constant, near, offset)
      !> Poles d, strictly increasing, shape (n)
      real(wp), intent(in) :: pole(:)
      !> Weights w, > 0, shape (n)
      real(wp), intent(in) :: weight(:)
      !> Constant c >= 0
      real(wp), intent(in) :: constant
      !> Number of the pole from which each zero is measured, shape (n - 1), (n) if c > 0
      integer, intent(out) :: near(:)
      !> Signed distance of each zero from that pole, same shape
      real(wp), intent(out) :: offset(:)

      real(wp) :: gap
      integer :: i, n

      n = size(pole)
      do i = 1, n - 1
         gap = pole(i + 1) - pole(i)
         ! f rises: if it is positive at the midpoint, the zero is in the lower half
         if (value_at(i, 0.5_wp*gap) > 0.0_wp) then
            near(i) = i
            offset(i) = root(i, 1.0_wp, 0.5_wp*gap)
         else
            near(i) = i + 1
            offset(i) = -root(i + 1, -1.0_wp, 0.5_wp*gap)
         end if
      end do
      if (constant > 0.0_wp .and. n > 0) then
         near(n) = n
         ! the zero is farthest away if all poles coincide with the last one
         offset(n) = root(n, 1.0_wp, sum(weight)/constant)
      end if

   contains

      !> f at a distance from a pole
      pure function value_at(j, distance) result(value)
         !> Number of the pole
         integer, intent(in) :: j
         !> Distance, not 0
         real(wp), intent(in) :: distance
         real(wp) :: value

         value = constant + sum(weight/((pole - pole(j)) - distance))
      end function value_at

      !> Distance of the zero from a pole: Newton's method for distance*f, which is regular at the
      !> pole, safeguarded by bisection
      pure function root(j, side, farthest) result(distance)
         !> Number of the pole
         integer, intent(in) :: j
         !> Side of the pole, 1 or -1
         real(wp), intent(in) :: side
         !> Upper bound of the distance
         real(wp), intent(in) :: farthest
         !> Distance, > 0
         real(wp) :: distance

         integer, parameter :: most_iterations = 200
         real(wp) :: lower, upper, others, slope, g, next, difference(size(pole)), term(size(pole))
         integer :: iteration

         ! g = side*distance*f rises through its zero
         lower = 0.0_wp
         upper = farthest
         distance = 0.5_wp*farthest
         do iteration = 1, most_iterations
            difference = (pole - pole(j)) - side*distance
            difference(j) = 1.0_wp
            term = weight/difference
            term(j) = 0.0_wp
            others = constant + sum(term)
            slope = side*sum(term/difference)
            g = side*(distance*others) - weight(j)
            if (.not. abs(g) > 0.0_wp) return
            if (g > 0.0_wp) then
               upper = distance
            else
               lower = distance
            end if
            next = distance - g/(side*(others + distance*slope))
            if (.not. (next > lower .and. next < upper)) next = 0.5_wp*(lower + upper)
            if (abs(next - distance) <= 2.0_wp*epsilon(1.0_wp)*distance) then
               distance = next
               return
            end if
            distance = next
         end do
      end function root
   end subroutine zeros_between_poles

end module vcor_numeric_interlacing
