!> A sphere and a structure or a face, advanced in equal steps through contact and flight
!>
!> The force is a parabola over each step; sphere and modes follow it exactly
!> (`vcor_solver_direct_modes`), and the springs of the contact keep the dent
!> (`vcor_solver_direct_row`). In each step s = s_0 - c F and F = stiffness*value(s), which rises
!> with s, have one solution.
!>
!> A face without a structure is touched at a node and left at once where the force ends: its
!> contacts are aligned with the steps. There the impulse of a dashpot is eta (u - u_0), exactly:
!> its force rises as a root or a step, which no parabola follows. In a row of springs that holds
!> while the contact grows for the first time. The rest of the force begins as t^n, from a dent
!> linearly.
module vcor_solver_direct_run
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : vibration_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_solver_direct_evaluation, only : fall_of, parabola
   use vcor_solver_direct_modes, only : modes_t
   use vcor_solver_direct_row, only : dent_row_t
   use vcor_tuning, only : most_iterations
   implicit none
   private

   public :: run_t

   !> Multiplications in the time that a step takes besides those for modes and springs
   real(wp), parameter :: work_of_step = 300.0_wp
   !> Weights of the newest node, the one before and that before it, for integrals over a step
   real(wp), parameter :: rule(3) = [5.0_wp, 8.0_wp, -1.0_wp]/12.0_wp

   !> A run with a given time step, at its newest node
   type :: run_t
      !> Time step, time at which the run begins [s], and number of steps
      real(wp) :: dt = 0.0_wp, start = 0.0_wp
      integer :: steps = 0
      !> Modes of the structure and springs of the contact
      type(modes_t) :: modes
      type(dent_row_t) :: row
      !> Whether no mode is a rigid motion, nor a part a flow
      logical :: is_held = .false.
      !> Flexibility that follows at once [m/N]
      real(wp) :: residual = 0.0_wp
      !> Time [s], indentation [m], impulse [N s] and its integral [N s2]
      real(wp) :: t = 0.0_wp, s = 0.0_wp, impulse = 0.0_wp, second_impulse = 0.0_wp
      !> What the last two are short of their sums, by rounding
      real(wp) :: rest(2) = 0.0_wp
      !> Force at the newest node and at the two before [N]; 0 before one that is 0
      real(wp) :: force(3) = 0.0_wp
      !> s less the surface of the dent, at the newest node and the two before [m]
      real(wp) :: depth(3) = 0.0_wp
      !> Force times the velocity of the contact and of the structure, at the same nodes [W], and
      !> the integrals of both [J]
      real(wp) :: power(2, 3) = 0.0_wp, work(2) = 0.0_wp
      !> Whether the face lies on nothing that moves but an infinite plate, and the deflection of
      !> that per impulse [m/(N s)]
      logical :: is_face = .false.
      real(wp) :: alpha = 0.0_wp
      !> Place of the sphere at t = 0, and how far an infinite plate had moved then [m]
      real(wp) :: place = 0.0_wp, sunk = 0.0_wp
      !> Viscosity of the dashpot of a face [N s/m^1.5], and whether its impulse is taken from u
      real(wp) :: viscosity = 0.0_wp
      logical :: exact_drag = .false.
      !> Whether a face was touched at the newest node, and whether it has a dent there
      logical :: touches = .false., has_dent = .false.
      !> Force without the dashpot at the newest node and the one before [N], and u and its last
      !> change [m^1.5], while that is so
      real(wp) :: elastic(2) = 0.0_wp, u = 0.0_wp, du = 0.0_wp
      !> Time from the separation to the newest node [s]
      real(wp) :: behind = 0.0_wp
      !> Impulse and its integral at the node before, while a step is made
      real(wp) :: before(2) = 0.0_wp
      !> Last three indentations [m]
      real(wp) :: last_s(3) = 0.0_wp
      !> Multiplications so far
      real(wp) :: effort = 0.0_wp
   contains
      procedure :: begin
      procedure :: take_step
      procedure, private :: press_face
      procedure, private :: part_from_face
      procedure, private :: part_from_dashpot
      procedure :: node
      procedure :: sphere_velocity
      procedure :: sphere
   end type run_t

contains

   !> Begin a run at first contact
   subroutine begin(self, impact, terms, vibration, dt)
      class(run_t), intent(out) :: self
      type(impact_t), intent(in) :: impact
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: terms
      type(vibration_t), intent(in) :: vibration
      !> Time step [s]
      real(wp), intent(in) :: dt

      self%dt = dt
      self%residual = vibration%residual
      self%is_held = all(vibration%square > 0.0_wp) .and. all(vibration%rate > 0.0_wp)
      call self%modes%prepare(vibration, dt)
      call self%row%prepare(terms, impact%law, dt, 0.0_wp)
      if (.not. self%residual > 0.0_wp) self%force(1) = impact%first_force()
      self%is_face = .not. impact%target%structure%exists()
      if (.not. self%is_face) return
      self%alpha = impact%target%alpha(0.0_wp)
      self%viscosity = terms%viscosity
      self%exact_drag = self%viscosity > 0.0_wp
      self%touches = .true.
   end subroutine begin

   !> Advance to the next node
   subroutine take_step(self, impact)
      class(run_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact

      real(wp) :: known, per_force, value, slope, s, change, force, velocity, bend
      integer :: iteration

      if (self%is_face) then
         call self%press_face(impact)
         return
      end if
      self%steps = self%steps + 1
      call self%modes%advance(self%force(2))
      call self%row%find_levels()
      associate (dt => self%dt, f => self%force)
         ! a sum of equal steps would be off by the same rounding in each of them
         self%t = self%start + real(self%steps, wp)*dt
         known = self%second_impulse + dt*self%impulse + dt**2*(10.0_wp*f(1) - f(2))/24.0_wp
         per_force = 0.125_wp*dt**2/impact%mass + self%modes%yield + self%residual
         s = self%place + impact%free_path(self%t) - known/impact%mass - self%modes%deflection()
         known = s
         ! the force is convex in s: after one of Newton's steps the others fall towards the root
         do iteration = 1, most_iterations
            call self%row%press(impact%law, s, value, slope)
            change = (s - known + per_force*self%row%stiffness*value) &
               /(1.0_wp + per_force*self%row%stiffness*slope)
            s = s - change
            if (abs(change) <= 4.0_wp*epsilon(s)*max(abs(s), abs(known))) exit
         end do
         call self%row%press(impact%law, s, value, slope)
         force = self%row%stiffness*value
         self%depth = [s - self%row%surface(impact%law), self%depth(1), self%depth(2)]
         call self%row%accept(impact%law, s, s - self%s)
         call self%modes%accept(force)
         bend = force - 2.0_wp*f(1) + f(2)
         if (.not. max(force, f(1)) > 0.0_wp) bend = 0.0_wp
         call add(self%second_impulse, self%rest(2), dt*(self%impulse + self%rest(1)) &
            + dt**2*(f(1)/3.0_wp + force/6.0_wp - bend/24.0_wp))
         call add(self%impulse, self%rest(1), dt*(0.5_wp*(f(1) + force) - bend/12.0_wp))
         self%last_s = [s, self%last_s(1), self%last_s(2)]
         self%s = s
         f = [force, f(1), f(2)]
         if (.not. force > 0.0_wp) f(2:) = 0.0_wp
         velocity = 0.0_wp
         if (force > 0.0_wp) velocity = self%modes%rate()
         self%power(:, 2:3) = self%power(:, 1:2)
         self%power(:, 1) = force*[self%sphere_velocity(impact) - velocity, velocity]
         if (any(abs(self%power(2, :)) > 0.0_wp)) self%work = self%work &
            + dt*matmul(self%power, rule)
         self%effort = self%effort + work_of_step + self%modes%work &
            + real(self%row%count*(20 + 4*self%row%modes()), wp)
      end associate
   end subroutine take_step

   !> Add to a sum, and keep what rounding takes from it for the next time (W. Kahan, Commun. ACM 8
   !> (1965) 40, doi:10.1145/363707.363723)
   pure subroutine add(total, rest, part)
      !> The sum, and what it is short of
      real(wp), intent(inout) :: total, rest
      !> What is added
      real(wp), intent(in) :: part

      real(wp) :: more, last

      more = part + rest
      last = total
      total = last + more
      rest = more - (total - last)
   end subroutine add

   !> Advance to the next node on a face
   subroutine press_face(self, impact)
      class(run_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact

      real(wp), dimension(3) :: once, twice
      real(wp) :: of_u(2), f(2), impulse, second, known, per_force, per_u, s, u, value, slope, &
         change, last, speed(2), gained
      integer :: iteration
      logical :: apart

      last = self%s
      self%before = [self%impulse, self%second_impulse]
      speed(1) = self%sphere_velocity(impact) - self%alpha*self%force(1)
      self%steps = self%steps + 1
      self%t = self%start + real(self%steps, wp)*self%dt
      call self%row%find_levels(with_dashpot=.not. self%exact_drag)
      f = self%force(:2)
      if (self%exact_drag) f = self%elastic
      ! weights of the newest node and the two before in the integrals of the force, and in that of
      ! u of its last two changes
      once = rule
      twice = [3.0_wp, 10.0_wp, -1.0_wp]/24.0_wp
      of_u = [5.0_wp, 1.0_wp]/12.0_wp
      if (self%touches .and. self%has_dent) then
         once = [0.5_wp, 0.5_wp, 0.0_wp]
         twice = [1.0_wp/6.0_wp, 1.0_wp/3.0_wp, 0.0_wp]
         of_u = [0.5_wp, 0.0_wp]
      else if (self%touches) then
         associate (n => impact%law%start_exponent)
            once = [1.0_wp/(n + 1.0_wp), 0.0_wp, 0.0_wp]
            twice = [1.0_wp/((n + 1.0_wp)*(n + 2.0_wp)), 0.0_wp, 0.0_wp]
            of_u = [1.0_wp/(n + 1.0_wp), 0.0_wp]
         end associate
      end if
      associate (dt => self%dt)
         impulse = self%impulse + dt*sum(once(2:)*f)
         second = self%second_impulse + dt*(self%impulse + dt*sum(twice(2:)*f))
         per_force = dt*(dt*twice(1)/impact%mass + self%alpha*once(1))
         per_u = 0.0_wp
         if (self%exact_drag) then
            second = second + self%viscosity*dt*of_u(2)*self%du
            per_u = self%viscosity*(dt*of_u(1)/impact%mass + self%alpha)
         end if
         known = self%place + impact%free_path(self%t) - second/impact%mass - self%alpha*impulse
         s = known
         do iteration = 1, most_iterations
            call self%row%press(impact%law, s, value, slope)
            change = s - known + per_force*self%row%stiffness*value
            slope = 1.0_wp + per_force*self%row%stiffness*slope
            if (self%exact_drag) then
               change = change + per_u*(impact%law%u(s) - self%u)
               slope = slope + per_u*impact%law%slope(s)
            end if
            change = change/slope
            s = s - change
            if (abs(change) <= 4.0_wp*epsilon(s)*max(abs(s), abs(known))) exit
         end do
         call self%row%press(impact%law, s, value, slope)
         value = self%row%stiffness*value
         self%depth = [s - self%row%surface(impact%law), self%depth(1), self%depth(2)]
         apart = .not. (value > 0.0_wp .or. self%exact_drag .or. self%touches) .and. f(1) > 0.0_wp
         if (apart) then
            call self%part_from_face(impact, s)
         else
            self%impulse = impulse + dt*once(1)*value
            self%second_impulse = second + dt**2*twice(1)*value
         end if
         gained = self%impulse - self%before(1)
         call self%row%accept(impact%law, s, s - last)
         self%force = [value, self%force(1), self%force(2)]
         if (self%exact_drag) then
            u = impact%law%u(s)
            change = u - self%u
            slope = 1.5_wp*change - 0.5_wp*self%du
            if (self%touches) slope = change*merge(1.0_wp, impact%law%start_exponent, &
               self%has_dent)
            self%force(1) = value + self%viscosity*slope/dt
            if (.not. self%force(1) > 0.0_wp .and. .not. self%touches) then
               call self%part_from_dashpot(impact, s, [self%elastic(2), self%elastic(1), value])
            else
               self%impulse = self%impulse + self%viscosity*change
               self%second_impulse = self%second_impulse + self%viscosity*dt*of_u(1)*change
               self%elastic = [value, f(1)]
               self%u = u
               self%du = change
               self%exact_drag = self%row%has_one_spring() .or. s > last
            end if
            gained = self%impulse - self%before(1)
         end if
         self%last_s = [s, self%last_s(1), self%last_s(2)]
         self%s = s
         self%touches = .false.
         speed(2) = self%sphere_velocity(impact) - self%alpha*self%force(1)
         self%work = self%work + gained*[0.5_wp*sum(speed), &
            0.5_wp*self%alpha*(self%force(1) + self%force(2))]
         if (.not. self%force(1) > 0.0_wp) self%force(2:) = 0.0_wp
         self%effort = self%effort + work_of_step &
            + real(self%row%count*(20 + 4*self%row%modes()), wp)
      end associate
   end subroutine press_face

   !> End a contact with a face in the newest step, and follow the free sphere to its end. The force
   !> of a spring in u ends as u(s) less a line, that of a row as the power of the time that is left
   subroutine part_from_face(self, impact, s)
      class(run_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Indentation at the end of the step [m]; on entry by a force that is a parabola over it
      real(wp), intent(inout) :: s

      ! Gauss's rule of four points on (0, 1)
      real(wp), parameter :: place(4) = [0.06943184420297371_wp, 0.33000947820757187_wp, &
         0.66999052179242813_wp, 0.93056815579702629_wp], &
         share(4) = [0.17392742256872693_wp, 0.32607257743127307_wp, 0.32607257743127307_wp, &
         0.17392742256872693_wp]
      real(wp) :: x, time, ends, force(4), impulse, second
      integer :: i

      x = fall_of(self%depth(3:1:-1))
      time = x*self%dt
      ends = (1.0_wp - x)*self%s + x*s
      associate (law => impact%law, f => self%force(1))
         if (self%row%has_one_spring()) then
            force = [(law%u(self%s + place(i)*(ends - self%s)), i=1, 4)] &
               - (1.0_wp - place)*law%u(self%s) - place*law%u(ends)
            force = f*(1.0_wp - place) + self%row%stiffness_without_dashpot()*force
            impulse = time*sum(share*force)
            second = time**2*sum(share*(1.0_wp - place)*force)
         else
            impulse = time*f/(law%start_exponent + 1.0_wp)
            second = time**2*f/(law%start_exponent + 2.0_wp)
         end if
      end associate
      second = self%second_impulse + time*self%impulse + second
      self%impulse = self%impulse + impulse
      self%behind = self%dt - time
      self%second_impulse = second + self%behind*self%impulse
      s = self%place + impact%free_path(self%t) - self%second_impulse/impact%mass &
         - self%alpha*self%impulse
   end subroutine part_from_face

   !> End a contact with a dashpot in the newest step, which is cut there
   subroutine part_from_dashpot(self, impact, s, elastic)
      !> The run, with the impulses at the end of the step but for those of the dashpot
      class(run_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Indentation at the end of the step [m], on return at the separation
      real(wp), intent(inout) :: s
      !> Force without the dashpot at the last three nodes [N]
      real(wp), intent(in) :: elastic(3)

      ! Gauss's rule of two points on (0, 1)
      real(wp), parameter :: place(2) = [0.21132486540518712_wp, 0.78867513459481288_wp]
      real(wp) :: x, time, u(3), at(2), gained
      integer :: i

      x = fall_of([self%force(3), self%force(2), self%force(1)])
      time = x*self%dt
      u = [self%u - self%du, self%u, impact%law%u(s)]
      ! the mean over (0, x) of the force, and twice that weighted by the time that is left
      at = [(parabola(elastic, x*place(i)), i=1, 2)]
      gained = 0.5_wp*sum(at)*time
      at = at*(1.0_wp - place)*time**2*0.5_wp
      self%second_impulse = self%before(2) + time*self%before(1) + sum(at) &
         + self%viscosity*time*0.5_wp*sum([(parabola(u, x*place(i)) - self%u, i=1, 2)])
      self%impulse = self%before(1) + gained + self%viscosity*(parabola(u, x) - self%u)
      self%t = self%t - self%dt + time
      s = self%place + impact%free_path(self%t) - self%second_impulse/impact%mass &
         - self%alpha*self%impulse
      call self%row%cut(impact%law%u(s), x, self%u)
      self%force(1) = 0.0_wp
      self%behind = 0.0_wp
   end subroutine part_from_dashpot

   !> Velocity of the sphere [m/s]
   pure function sphere_velocity(self, impact) result(velocity)
      class(run_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      real(wp) :: velocity

      velocity = impact%free_velocity(self%t) - self%impulse/impact%mass
   end function sphere_velocity

   !> Displacement of the sphere [m]
   pure function sphere(self, impact) result(place)
      class(run_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      real(wp) :: place

      place = self%place + impact%free_path(self%t) - self%second_impulse/impact%mass
   end function sphere

   !> State at the node
   pure function node(self, impact) result(state)
      class(run_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> State
      real(wp) :: state(columns)

      state(col_time) = self%t
      state(col_indentation) = self%s
      state(col_force) = self%force(1)
      state(col_impulse) = self%impulse
      state(col_sphere) = self%sphere(impact)
      state(col_sphere_velocity) = self%sphere_velocity(impact)
      state(col_plate) = state(col_sphere) - self%s
      state(col_plate_velocity) = self%modes%rate() + self%residual*(1.5_wp*self%force(1) &
         - 2.0_wp*self%force(2) + 0.5_wp*self%force(3))/self%dt
      if (self%is_face) state(col_plate_velocity) = self%alpha*self%force(1)
      state(col_velocity) = state(col_sphere_velocity) - state(col_plate_velocity)
   end function node

end module vcor_solver_direct_run
