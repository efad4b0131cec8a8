!> Time course of an impact, as every solver returns it
module vcor_impact_trajectory
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_bounces, only : bounces_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : unset, wp
   implicit none
   private

   public :: trajectory_t
   public :: columns, col_time, col_indentation, col_velocity, col_force, col_impulse
   public :: col_sphere, col_sphere_velocity, col_plate, col_plate_velocity
   public :: contact_unknown, contact_separated, contact_lasting, contact_sticking, &
      contact_resting, history_steps
   public :: refuse_growth, unrest, far_off

   !> Stated error over the accuracy asked for, beyond which a result is not given
   real(wp), parameter :: far_off = 100.0_wp

   !> Rows of `state`: time [s]
   integer, parameter :: col_time = 1
   !> Indentation s [m]
   integer, parameter :: col_indentation = 2
   !> Relative velocity s' [m/s]
   integer, parameter :: col_velocity = 3
   !> Contact force F [N]
   integer, parameter :: col_force = 4
   !> Impulse I [N s]
   integer, parameter :: col_impulse = 5
   !> Displacement of the sphere z [m]
   integer, parameter :: col_sphere = 6
   !> Velocity of the sphere z' [m/s]
   integer, parameter :: col_sphere_velocity = 7
   !> Displacement of the plate U [m]
   integer, parameter :: col_plate = 8
   !> Velocity of the plate U' [m/s]
   integer, parameter :: col_plate_velocity = 9
   !> Number of rows of `state`
   integer, parameter :: columns = 9

   !> Status: nothing has been solved yet
   integer, parameter :: contact_unknown = -1
   !> The force returned to zero: the bodies separated
   integer, parameter :: contact_separated = 0
   !> The end time was reached in contact
   integer, parameter :: contact_lasting = 1
   !> All motion decayed in contact
   integer, parameter :: contact_sticking = 2
   !> The weight of the sphere keeps it in contact for good
   integer, parameter :: contact_resting = 5

   !> Steps of a history if the solver does not use equal steps
   integer, parameter :: history_steps = 500

   !> Time course of an impact from first contact, node 0
   type :: trajectory_t
      !> One of the `contact_*` constants
      integer :: status = contact_lasting
      !> Whether a receding contact has grown again
      logical :: regrows = .false.
      !> Number of time steps taken
      integer :: steps = 0
      !> Node at which contact or computation ended
      integer :: last = 0
      !> Last node of all: beyond `last` if the computation continued after separation, as if the
      !> bodies stuck to each other
      integer :: final = 0
      !> State at the nodes, shape (columns, 0:), used up to `final`
      real(wp), allocatable :: state(:, :)
      !> Shares of the nodes in the impulse of the contact: int F x dt = sum(share*x) [N s], shape
      !> (0:)
      real(wp), allocatable :: share(:)
      !> Largest indentation [m]
      real(wp) :: max_indentation = 0.0_wp
      !> Time of the largest indentation [s]
      real(wp) :: time_of_max_indentation = 0.0_wp
      !> Largest force [N]
      real(wp) :: max_force = 0.0_wp
      !> Time of the largest force [s]
      real(wp) :: time_of_max_force = 0.0_wp
      !> Estimated error of the coefficient of restitution [-]
      real(wp) :: cor_error = 0.0_wp
      !> Estimated error of that of the sphere alone [-]
      real(wp) :: cor_sphere_error = 0.0_wp
      !> Estimated error of the contact time [s]; NaN if the solver estimates none
      real(wp) :: contact_time_error = unset
      !> Estimated error of the largest force [N]; NaN if the solver estimates none
      real(wp) :: max_force_error = unset
      !> Accuracy requested for both [-]; 0 if none was, as the time step is given
      real(wp) :: accuracy = 0.0_wp
      !> Contact radius at the nodes [m], shape (0:); unallocated: that of the contact law
      real(wp), allocatable :: radius(:)
      !> Largest tension around the axis of a contact [Pa], of the same solver
      real(wp) :: tension = 0.0_wp
      !> Number of contacts with a structure, the end of the first one [s], and whether another one
      !> follows the separation, or may
      integer :: contacts = 1
      real(wp) :: first_end = unset
      !> Velocity of the sphere at that end, and relative velocity [m/s]
      real(wp) :: first_velocity = unset
      real(wp) :: first_speed = unset
      !> Whether the first contact, or a second one, is just made or missed, and what velocities
      !> next to that of the impact change, which is part of the errors of both coefficients [-]
      logical :: grazes = .false.
      real(wp) :: change_beside = 0.0_wp
      !> Whether there is, or may be, a contact that the solver has not followed
      logical :: returns = .false.
      !> Velocity of the structure's rigid motion [m/s], and energy left in its modes [J], at the
      !> last separation
      real(wp) :: rigid_velocity = 0.0_wp
      real(wp) :: structure_energy = 0.0_wp
      !> State at the last separation, while the run goes on
      real(wp) :: separation(columns) = unset
      !> Work of the force on the contact and on the structure [J], if the solver has summed it up
      real(wp), allocatable :: work(:)
      !> Time of first touch [s], and the velocity of the sphere then [m/s]
      real(wp) :: touch(2) = 0.0_wp
      !> The bounces, if more than one was asked for
      type(bounces_t), allocatable :: bounces
      !> Number of exponentials that approximate the kernel; 0 if it is used unchanged
      integer :: kernel_terms = 0
      !> Estimated largest relative error of that sum
      real(wp) :: kernel_error = 0.0_wp
      !> Stages of a collocation panel; 0: the nodes are a plain time series
      integer :: stages = 0
      !> Points of a panel in theta, beginning with its start, shape (0:stages)
      real(wp), allocatable :: point(:)
      !> Barycentric weights of the points, shape (0:stages)
      real(wp), allocatable :: barycentric(:)
      !> Time in panel p: t = state(col_time, start) + map(1, p) theta + map(2, p) theta^2 [s],
      !> shape (2, panels)
      real(wp), allocatable :: map(:, :)
   contains
      procedure :: reserve
      procedure :: begin
      procedure :: add
      procedure :: add_map
      procedure :: stop_at_rest
      procedure :: is_stuck
      procedure :: rests
      procedure :: misses_by_far
      procedure :: sample
      procedure :: indentation_at
      procedure :: value_at
      procedure :: radius_at
      procedure :: impulse_at
   end type trajectory_t

contains

   !> Make room for at least `nodes` nodes after node 0; contents are kept
   pure subroutine reserve(self, nodes)
      class(trajectory_t), intent(inout) :: self
      !> Number of nodes wanted
      integer, intent(in) :: nodes

      real(wp), allocatable :: state(:, :), share(:)
      integer :: room

      if (allocated(self%share)) then
         if (ubound(self%share, 1) >= nodes) return
         room = max(nodes, 2*ubound(self%share, 1))
         allocate (state(columns, 0:room), share(0:room))
         state(:, 0:self%final) = self%state(:, 0:self%final)
         share(0:self%final) = self%share(0:self%final)
         call move_alloc(state, self%state)
         call move_alloc(share, self%share)
      else
         allocate (self%state(columns, 0:nodes), self%share(0:nodes))
      end if
   end subroutine reserve

   !> Store the state at first contact, node 0
   pure subroutine begin(self, state)
      class(trajectory_t), intent(inout) :: self
      real(wp), intent(in) :: state(columns)

      call self%reserve(1)
      self%final = 0
      self%state(:, 0) = state
      self%share(0) = 0.0_wp
   end subroutine begin

   !> Store the state at the next node
   pure subroutine add(self, state, share)
      class(trajectory_t), intent(inout) :: self
      real(wp), intent(in) :: state(columns)
      !> Its share in the impulse of the contact [N s]; absent: 0
      real(wp), intent(in), optional :: share

      call self%reserve(self%final + 1)
      self%final = self%final + 1
      self%state(:, self%final) = state
      self%share(self%final) = 0.0_wp
      if (present(share)) self%share(self%final) = share
   end subroutine add

   !> Record the map of the next panel
   pure subroutine add_map(self, map)
      class(trajectory_t), intent(inout) :: self
      !> Coefficients of theta and theta^2 [s]
      real(wp), intent(in) :: map(2)

      real(wp), allocatable :: longer(:, :)

      if (.not. allocated(self%map)) allocate (self%map(2, 8))
      if (self%steps == size(self%map, 2)) then
         allocate (longer(2, 2*self%steps))
         longer(:, :self%steps) = self%map
         call move_alloc(longer, self%map)
      end if
      self%map(:, self%steps + 1) = map
   end subroutine add_map

   !> Set the status if all motion has decayed in contact at the last node, for good
   subroutine stop_at_rest(self, impact, is_last, stopped)
      class(trajectory_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Whether the computation ends there anyway
      logical, intent(in) :: is_last
      !> Whether the motion has decayed
      logical, intent(out) :: stopped

      if (impact%target%structure%exists()) then
         stopped = .false.
      else if (impact%gravity > 0.0_wp) then
         stopped = self%rests(impact, is_last)
         if (stopped) self%status = contact_resting
      else
         stopped = self%is_stuck(impact)
         if (stopped) self%status = contact_sticking
      end if
   end subroutine stop_at_rest

   !> Refuse a receding contact in which t1 grows. On a plate at rest and without weight s' only
   !> falls, and t1' has its sign: there a rising t1 is rounding of a sphere that has come to rest
   subroutine refuse_growth(impact, error)
      type(impact_t), intent(in) :: impact
      !> Error of code `error_numerical`
      type(error_t), allocatable, intent(out) :: error

      if (impact%target%yields() .or. impact%gravity > 0.0_wp) then
         call raise(error, error_numerical, "the contact grows again before it has ended, as on " &
            //"a plate that is too light for the sphere, which method = 'ive' does not follow")
      else
         call raise(error, error_numerical, "the sphere comes to rest in contact and is pushed " &
            //"back too slowly for law = 'receding' to be followed: use law = 'boltzmann'")
      end if
   end subroutine refuse_growth

   !> Whether all motion has decayed in contact at the last node, for good: the remaining energy
   !> cannot cause a noticeable rebound. A contact with an equilibrium modulus, however soft, is
   !> momentarily at rest at its largest indentation; it sticks only if a plate has absorbed the
   !> impact and no indentation is left
   pure function is_stuck(self, impact)
      class(trajectory_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> Whether the sphere sticks
      logical :: is_stuck

      ! a rebound with all of this energy has a coefficient of restitution of 1e-7
      real(wp), parameter :: negligible = 1.0e-14_wp
      ! indentation divided by displacement of the sphere that counts as no indentation: a hundred
      ! times more or less changes the status of none of 109 random impacts
      real(wp), parameter :: no_indentation = 1.0e-3_wp

      associate (now => self%state(:, self%last), first => self%state(:, 0))
         is_stuck = 0.5_wp*impact%mass*(now(col_velocity)**2 + now(col_sphere_velocity)**2) &
            + max(0.0_wp, now(col_force)*now(col_indentation)) &
            <= negligible*0.5_wp*impact%mass*first(col_velocity)**2
         if (is_stuck .and. abs(now(col_indentation)) > no_indentation*abs(now(col_sphere))) &
            is_stuck = .not. impact%pushes_apart()
      end associate
   end function is_stuck

   !> Whether the weight W = m g keeps the sphere in contact for good at the last node. It does if
   !> the force and the spring k(oo) u balance the weight and the motion has decayed or, at the end
   !> of the computation, if the remaining energy cannot make the force zero again.
   !>
   !> Near rest the contact is linear in u. The energy of the deviations from rest,
   !> V = m v^2/2 + (F - W)^2/(2 k u'), falls in all solids, fluids and plates; v is the velocity of
   !> the sphere, for a fluid its excess over steady sinking. A zero force at a time tau after a
   !> state of energy V requires, for every tau,
   !>
   !>     W <= sqrt(2 V u') (sqrt(k(2 tau)) + K(tau) sqrt(u'/m)),   K = int_0 k
   !>
   !> The first term is what modes have not relaxed by then, the second the effect of motion since
   !> then. The square of the least bracket is the effective stiffness, at most k(0)
   pure function rests(self, impact, is_last)
      class(trajectory_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> Whether the computation ends there anyway
      logical, intent(in) :: is_last
      logical :: rests

      ! square of the tolerated deviation of the forces, over the weight: 1e-7, as for velocities
      ! above
      real(wp), parameter :: negligible = 1.0e-14_wp
      real(wp) :: weight, spring, excess

      rests = .false.
      associate (now => self%state(:, self%last))
         weight = impact%mass*impact%gravity
         spring = impact%factor*impact%modulus%rubbery()
         excess = ((now(col_force) - weight)/weight)**2
         if (.not. (is_last .or. excess <= negligible .and. &
             (spring*impact%law%u(now(col_indentation))/weight - 1.0_wp)**2 <= negligible)) return
         rests = unrest(impact, now) < merge(1.0_wp, negligible, is_last)
      end associate
   end function rests

   !> Square of what the right side above may be over the weight: below 1 the weight keeps the
   !> sphere in contact
   pure function unrest(impact, now)
      type(impact_t), intent(in) :: impact
      !> State in contact, its time since first touch
      real(wp), intent(in) :: now(columns)
      !> The square [-]; huge without contact
      real(wp) :: unrest

      ! after them tau is rounding of the time, and so is what the kernel adds
      integer, parameter :: halvings = 50
      real(wp) :: weight, slope, viscosity, root, stiffness, velocity, tau
      integer :: i

      unrest = huge(1.0_wp)
      if (.not. (now(col_force) > 0.0_wp .and. now(col_indentation) > 0.0_wp)) return
      weight = impact%mass*impact%gravity
      slope = impact%law%slope(now(col_indentation))
      viscosity = impact%kernel_viscosity()
      velocity = now(col_velocity) &
         + impact%target%alpha(now(col_time))*(now(col_force) - weight)
      if (velocity > 0.0_wp .and. .not. impact%pushes_apart()) velocity = max(0.0_wp, velocity &
         - weight/((impact%kernel_integral(now(col_time)) + viscosity)*slope))
      root = huge(1.0_wp)
      tau = now(col_time)
      do i = 1, halvings
         tau = 0.5_wp*tau
         stiffness = (impact%kernel_integral(tau) + viscosity)*sqrt(slope/impact%mass)
         root = min(root, stiffness + sqrt(impact%kernel(2.0_wp*tau)))
      end do
      unrest = ((now(col_force) - weight)/weight)**2 &
         + slope*impact%mass*(root*velocity/weight)**2
   end function unrest

   !> Whether the estimated error exceeds the accuracy requested by so much that there is no result.
   !> What the velocity of the impact does not determine is known, and no fault of the solution
   pure function misses_by_far(self)
      !> The trajectory, ended in separation
      class(trajectory_t), intent(in) :: self
      logical :: misses_by_far

      misses_by_far = self%accuracy > 0.0_wp
      if (.not. misses_by_far) return
      misses_by_far = .not. (ieee_is_finite(self%cor_error) &
         .and. ieee_is_finite(self%cor_sphere_error))
      if (.not. misses_by_far) misses_by_far = &
         max(self%cor_error, self%cor_sphere_error) - self%change_beside > far_off*self%accuracy
   end function misses_by_far

   !> State at equal steps of time from first contact to the final node: interpolated by the
   !> collocation polynomials, or the nodes themselves of a solver with equal steps. Before the
   !> impact is solved, it is one state of NaN
   pure subroutine sample(self, count, state)
      class(trajectory_t), intent(in) :: self
      !> Number of steps, > 0; has no effect for a solver with equal steps
      integer, intent(in) :: count
      !> State, shape (columns, 0:)
      real(wp), allocatable, intent(out) :: state(:, :)

      real(wp) :: time, c(0:self%stages)
      integer :: i, first

      if (self%stages == 0) then
         allocate (state(columns, 0:self%final), source=unset)
         if (allocated(self%state)) state = self%state(:, 0:self%final)
         return
      end if

      allocate (state(columns, 0:count))
      state(:, 0) = self%state(:, 0)
      first = 0
      do i = 1, count - 1
         time = self%state(col_time, self%final)*(real(i, wp)/real(count, wp))
         call find_panel(self, time, first, c)
         state(:, i) = matmul(self%state(:, first:first + self%stages), c)
         state(col_time, i) = time
      end do
      state(:, count) = self%state(:, self%final)
   end subroutine sample

   !> Indentation at a time of the contact, by the collocation polynomial or, for equal steps, by
   !> the cubic through indentations and velocities of the adjacent nodes; NaN before the impact is
   !> solved
   pure function indentation_at(self, time) result(indentation)
      class(trajectory_t), intent(in) :: self
      !> Time since first contact [s], up to that of the last node
      real(wp), intent(in) :: time
      !> Indentation [m]
      real(wp) :: indentation

      real(wp) :: step, x
      integer :: i

      indentation = unset
      if (.not. allocated(self%state)) return
      if (self%stages > 0) then
         indentation = self%value_at(self%state(col_indentation, 0:self%final), time)
         return
      end if
      i = max(1, count(self%state(col_time, 0:self%last - 1) < time))
      associate (left => self%state(:, i - 1), right => self%state(:, i))
         step = right(col_time) - left(col_time)
         x = (time - left(col_time))/step
         indentation = (1.0_wp - x)**2*((1.0_wp + 2.0_wp*x)*left(col_indentation) &
            + x*step*left(col_velocity)) + x**2*((3.0_wp - 2.0_wp*x)*right(col_indentation) &
            - (1.0_wp - x)*step*right(col_velocity))
      end associate
   end function indentation_at

   !> A value at a time of the contact by the collocation polynomials, of a solver that has them
   pure function value_at(self, values, time) result(value)
      class(trajectory_t), intent(in) :: self
      !> Values at the nodes, shape (0:final)
      real(wp), intent(in) :: values(0:)
      !> Time since first contact [s], up to that of the last node
      real(wp), intent(in) :: time
      !> Value
      real(wp) :: value

      real(wp) :: c(0:self%stages)
      integer :: i

      i = 0
      call find_panel(self, time, i, c)
      value = dot_product(values(i:i + self%stages), c)
   end function value_at

   !> Contact radius at a time of the contact, linear between the nodes, of a solver that has one
   pure function radius_at(self, time) result(radius)
      class(trajectory_t), intent(in) :: self
      !> Time since first contact [s], up to that of the last node
      real(wp), intent(in) :: time
      !> Radius [m]
      real(wp) :: radius

      real(wp) :: part
      integer :: i

      i = max(1, count(self%state(col_time, 0:self%last - 1) < time))
      associate (t => self%state(col_time, i - 1:i), a => self%radius(i - 1:i))
         part = (time - t(1))/(t(2) - t(1))
         radius = (1.0_wp - part)*a(1) + part*a(2)
      end associate
   end function radius_at

   !> Impulse at a time of the contact, of a collocation solution
   pure function impulse_at(self, time) result(impulse)
      class(trajectory_t), intent(in) :: self
      !> Time since first contact [s], up to that of the last node
      real(wp), intent(in) :: time
      !> Impulse [N s]
      real(wp) :: impulse

      real(wp) :: c(0:self%stages)
      integer :: i

      i = 0
      call find_panel(self, time, i, c)
      impulse = dot_product(self%state(col_impulse, i:i + self%stages), c)
   end function impulse_at

   !> Find the panel that contains a time, and the weights of its nodes
   pure subroutine find_panel(self, time, first, c)
      !> The trajectory, of a collocation solution
      class(trajectory_t), intent(in) :: self
      !> Time since first contact [s]
      real(wp), intent(in) :: time
      !> First node of a panel not after the time; on return that of the panel
      integer, intent(inout) :: first
      !> Weights, shape (0:stages)
      real(wp), intent(out) :: c(0:)

      real(wp) :: offset, theta

      do while (time > self%state(col_time, first + self%stages) &
                .and. first + self%stages < self%final)
         first = first + self%stages
      end do
      ! root of the quadratic map in its stable form
      associate (map => self%map(:, first/self%stages + 1))
         offset = time - self%state(col_time, first)
         theta = 2.0_wp*offset/(map(1) + sqrt(max(0.0_wp, map(1)**2 + 4.0_wp*map(2)*offset)))
      end associate
      c = lagrange(self%point, self%barycentric, theta)
   end subroutine find_panel

   !> Lagrange basis polynomials at an argument
   pure function lagrange(point, barycentric, theta) result(c)
      !> Points, shape (0:n)
      real(wp), intent(in) :: point(0:)
      !> Barycentric weights, shape (0:n)
      real(wp), intent(in) :: barycentric(0:)
      !> Argument
      real(wp), intent(in) :: theta
      !> Values, shape (0:n)
      real(wp) :: c(0:ubound(point, 1))

      integer :: j

      do j = 0, ubound(point, 1)
         if (abs(theta - point(j)) < 1.0e-14_wp) then
            c = 0.0_wp
            c(j) = 1.0_wp
            return
         end if
         c(j) = barycentric(j)/(theta - point(j))
      end do
      c = c/sum(c)
   end function lagrange

end module vcor_impact_trajectory
