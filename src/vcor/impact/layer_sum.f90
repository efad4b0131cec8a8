!> Response of a layer on the window of an impact as internal variables
!>
!> U = instant F + sum_k c_k int_0^t exp(-l_k (t - x)) F(x) dx, some of the rates l_k in pairs of
!> complex conjugates: waves between the faces ring. C(s) = instant + sum_k c_k/(s + l_k) is fitted
!> by least squares. In units of the window the rates are the same for all layers, as a Fourier
!> series on a somewhat longer one can be anything on the window, and so is the matrix; only the
!> right side is the layer's.
!>
!> `instant` is the exact C(oo), not fitted. An impact on the sum stays stable as one on the layer
!> is: C - C(oo) is the compliance of all that moves, which takes energy at any frequency, and what
!> the fit leaves of that beyond its last point is too slow to grow within the window. Beyond the
!> equidistant rates the points leave the line Re s = 2/window, as far as the rates do: there the
!> response is damped, and what echoes do has no part in the motion.
module vcor_impact_layer_sum
   use vcor_constants, only : pi
   use vcor_impact_layer, only : layer_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_lapack, only : dgeqp3, dorgqr, dtrtrs
   implicit none
   private

   public :: line_fit_t, new_line_fit

   !> What all fits have in common, in units of the window
   type :: line_fit_t
      private
      !> Laplace variables, shape (n)
      complex(wp), allocatable :: s(:)
      !> Their weights, shape (n)
      real(wp), allocatable :: weight(:)
      !> Points on the line beyond the equidistant rates, which show what is left of echoes there
      complex(wp), allocatable :: beyond(:)
      !> Real rates, and one of each pair, shapes (n) and (m)
      real(wp), allocatable :: rate(:)
      complex(wp), allocatable :: pair_rate(:)
      !> Weighted matrix: real parts of all rows, then imaginary ones; real terms, then two columns
      !> for each pair
      real(wp), allocatable :: matrix(:, :)
      !> Q^T and R of the columns that are independent, which these are, and the columns' lengths
      real(wp), allocatable :: q(:, :), r(:, :), length(:)
      integer, allocatable :: pivot(:)
   contains
      procedure :: fit
   end type line_fit_t

   !> F has parts of the frequency w as 1/(1 + (w window/bend)^power): its start and end are powers
   !> 1.5 of time; for the velocity U' they count for more
   real(wp), parameter :: bend = 3.0_wp, power = 2.5_wp, power_of_rate = 1.5_wp

contains

   !> Make what all fits have in common
   pure subroutine new_line_fit(self)
      !> It; without factors if LAPACK fails
      type(line_fit_t), intent(out) :: self

      ! pairs of rates: equidistant ones for a period that is longer than the window, then a series
      ! with the damping of its steps
      integer, parameter :: equidistant = 40
      real(wp), parameter :: step = pi/1.2_wp, damping = 3.0_wp, ratio = 1.25_wp, top = 1000.0_wp
      ! real rates
      integer, parameter :: slow = 16
      real(wp), parameter :: slowest = 0.3_wp, fastest = 3000.0_wp
      ! points: on the line with this distance, then a series that leaves it with this slope
      real(wp), parameter :: line = 2.0_wp, dense = 0.6_wp, last = 3000.0_wp, slope = 0.1_wp
      integer, parameter :: sparse = 60, beyond = 10
      real(wp), parameter :: beyond_ratio = 1.25_wp
      ! between the powers that motion and velocity want
      real(wp), parameter :: power_of_fit = 2.0_wp
      real(wp), parameter :: dependent = 1.0e-12_wp
      real(wp), allocatable :: a(:, :), tau(:), work(:), omega(:)
      complex(wp), allocatable :: column(:)
      real(wp) :: first
      integer :: i, j, n, m, rows, info

      first = step*real(equidistant, wp)
      allocate (omega, source=[(dense*real(i, wp), i=0, floor(first/dense)), &
         (first*(last/first)**(real(i, wp)/real(sparse, wp)), i=1, sparse)])
      self%s = cmplx(line + slope*max(omega - first, 0.0_wp), omega, wp)
      self%weight = 1.0_wp/(1.0_wp + (abs(self%s)/bend)**power_of_fit)
      self%beyond = cmplx(line, first*beyond_ratio**([(real(i, wp), i=1, beyond)] - 0.5_wp), wp)
      self%rate = slowest*(fastest/slowest)**([(real(i, wp), i=0, slow - 1)]/real(slow - 1, wp))
      m = ceiling(log(top/first)/log(ratio))
      self%pair_rate = [(cmplx(damping, -step*real(i, wp), wp), i=1, equidistant), &
         (first*ratio**i*cmplx(1.0_wp - 1.0_wp/ratio, -1.0_wp, wp), i=1, m)]

      n = size(self%s)
      rows = 2*n
      m = slow + 2*size(self%pair_rate)
      allocate (self%matrix(rows, m), column(n))
      do j = 1, m
         if (j <= slow) then
            column = 1.0_wp/(self%s + self%rate(j))
         else
            associate (l => self%pair_rate((j - slow + 1)/2))
               if (mod(j - slow, 2) == 1) then
                  column = 0.5_wp/(self%s + l) + 0.5_wp/(self%s + conjg(l))
               else
                  column = (0.0_wp, 0.5_wp)*(1.0_wp/(self%s + l) - 1.0_wp/(self%s + conjg(l)))
               end if
            end associate
         end if
         self%matrix(:, j) = [self%weight*real(column, wp), self%weight*aimag(column)]
      end do

      self%length = norm2(self%matrix, 1)
      allocate (a(rows, m), tau(m), work(70*m), self%pivot(m))
      do j = 1, m
         a(:, j) = self%matrix(:, j)/self%length(j)
      end do
      self%pivot = 0
      call dgeqp3(rows, m, a, rows, self%pivot, tau, work, size(work), info)
      if (info /= 0) return
      n = count([(abs(a(j, j)) > dependent*abs(a(1, 1)), j=1, m)])
      self%r = a(:n, :n)
      call dorgqr(rows, n, n, a, rows, tau, work, size(work), info)
      if (info == 0) self%q = transpose(a(:, :n))
   end subroutine new_line_fit

   !> Fit a layer
   pure subroutine fit(self, layer, footprint, window, terms, instant, error_of_rate)
      class(line_fit_t), intent(in) :: self
      type(layer_t), intent(in) :: layer
      !> Radius of the disc that is loaded [m], > 0
      real(wp), intent(in) :: footprint
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> U' but for instant F': with c_k the viscosity is sum_k c_k and the moduli are -l_k c_k; the
      !> error is the misfit of C as the motion feels it [m/N]
      type(exponential_sum_t), intent(out) :: terms
      !> Deflection that follows the force at once [m/N]
      real(wp), intent(out) :: instant
      !> Misfit of C as the velocity at the end feels it [m/N]
      real(wp), intent(out) :: error_of_rate

      complex(wp) :: c(size(self%s))
      real(wp) :: right(2*size(self%s)), x(size(self%length)), y(size(self%q, 1))
      real(wp), allocatable :: misfit(:)
      integer :: i, n, info

      instant = layer%instant(footprint)
      do i = 1, size(c)
         c(i) = layer%compliance(self%s(i)/window, footprint) - instant
      end do
      right = [self%weight*real(c, wp), self%weight*aimag(c)]
      y = matmul(self%q, right)
      n = size(y)
      call dtrtrs('U', 'N', 'N', n, 1, self%r, n, y, n, info)
      x = 0.0_wp
      x(self%pivot(:n)) = y
      x = x/self%length
      misfit = abs(matmul(self%matrix, x) - right)
      n = size(c)
      misfit = max(misfit(:n), misfit(n + 1:))/self%weight
      terms%error = maxval(misfit/(1.0_wp + (abs(self%s)/bend)**power))
      error_of_rate = maxval(misfit/(1.0_wp + (abs(self%s)/bend)**power_of_rate))
      n = size(self%rate)
      terms%rates = self%rate/window
      terms%pair_rates = self%pair_rate/window
      terms%moduli = x(:n)/window
      terms%pair_moduli = cmplx(x(n + 1::2), x(n + 2::2), wp)/window
      terms%viscosity = sum(terms%moduli) + sum(real(terms%pair_moduli, wp))
      do i = 1, size(self%beyond)
         error_of_rate = max(error_of_rate, abs(layer%compliance(self%beyond(i)/window, footprint) &
            - instant - value(self%beyond(i)/window)) &
            /(1.0_wp + (abs(self%beyond(i))/bend)**power_of_rate))
      end do
      terms%moduli = -terms%rates*terms%moduli
      terms%pair_moduli = -terms%pair_rates*terms%pair_moduli

   contains

      !> The sum at a point, what is at once left out
      pure function value(s)
         !> Laplace variable [1/s]
         complex(wp), intent(in) :: s
         !> Compliance [m/N]
         complex(wp) :: value

         value = sum(terms%moduli/(s + terms%rates)) + 0.5_wp*sum(terms%pair_moduli &
            /(s + terms%pair_rates) + conjg(terms%pair_moduli)/(s + conjg(terms%pair_rates)))
      end function value
   end subroutine fit

end module vcor_impact_layer_sum
