!> Memory of a hereditary plate in product integration
!>
!> With the impulse I and its integral J as parabolas over each step, and the memory psi integrated
!> exactly, as in `vcor_solver_product`,
!>
!>     U_n = alpha I_n + sum_j W_{n-j} dJ_j,   U'_n = alpha F_n + sum_j W_{n-j} dI_j
module vcor_solver_plate_sums
   use vcor_impact_plate, only : plate_t
   use vcor_kinds, only : wp
   use vcor_numeric_dot, only : dot
   use vcor_solver_history, only : plate_weights
   implicit none
   private

   public :: plate_sums_t

   !> Sums under way
   type :: plate_sums_t
      !> W_0, the share of the newest step; 0 for a plate without memory [m/(N s2)]
      real(wp) :: newest = 0.0_wp
      !> Deflection without the newest step's share and alpha I [m]
      real(wp) :: deflection = 0.0_wp
      !> Velocity without the newest step's share and alpha F [m/s]
      real(wp) :: velocity = 0.0_wp
      !> Impulse at the last node [N s]
      real(wp), private :: impulse = 0.0_wp
      !> Second impulse at the last node [N s2]
      real(wp), private :: second_impulse = 0.0_wp
      !> weight(room - i) = W_i
      real(wp), allocatable, private :: weight(:)
      !> Differences of the impulse [N s]
      real(wp), allocatable, private :: di(:)
      !> Differences of the second impulse [N s2]
      real(wp), allocatable, private :: dj(:)
   contains
      !> Make room
      procedure :: prepare
      !> Sum up the past
      procedure :: sum_up
      !> Go on to the next step
      procedure :: accept
   end type plate_sums_t

contains

   !> Make room for `steps` steps, what is there stays
   subroutine prepare(self, plate, dt, steps)
      !> The sums
      class(plate_sums_t), intent(inout) :: self
      !> The plate, a hereditary one
      type(plate_t), intent(in) :: plate
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Number of steps
      integer, intent(in) :: steps

      real(wp), allocatable :: longer(:)

      allocate (longer(steps))
      if (allocated(self%di)) longer(:size(self%di)) = self%di
      call move_alloc(longer, self%di)
      allocate (longer(steps))
      if (allocated(self%dj)) longer(:size(self%dj)) = self%dj
      call move_alloc(longer, self%dj)
      if (allocated(self%weight)) deallocate (self%weight)
      allocate (self%weight(steps))
      self%weight(steps:1:-1) = plate_weights(plate, dt, steps)
      self%newest = self%weight(steps)
   end subroutine prepare

   !> Deflection and velocity without the share of step n that F_n has in it
   pure subroutine sum_up(self, n)
      !> The sums
      class(plate_sums_t), intent(inout) :: self
      !> Step
      integer, intent(in) :: n

      if (.not. allocated(self%weight)) return
      associate (room => size(self%weight))
         self%deflection = dot(self%weight(room - n + 1:room - 1), self%dj(:n - 1)) &
            - self%newest*self%second_impulse
         self%velocity = dot(self%weight(room - n + 1:room - 1), self%di(:n - 1)) &
            - self%newest*self%impulse
      end associate
   end subroutine sum_up

   !> Take the impulses at node n into the sums
   pure subroutine accept(self, n, impulse, second_impulse)
      !> The sums
      class(plate_sums_t), intent(inout) :: self
      !> Node
      integer, intent(in) :: n
      !> Impulse there [N s]
      real(wp), intent(in) :: impulse
      !> Second impulse there [N s2]
      real(wp), intent(in) :: second_impulse

      if (.not. allocated(self%weight)) return
      self%di(n) = impulse - self%impulse
      self%dj(n) = second_impulse - self%second_impulse
      self%impulse = impulse
      self%second_impulse = second_impulse
   end subroutine accept

end module vcor_solver_plate_sums
