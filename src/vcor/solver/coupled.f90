!> Exact contact with waves: the row of springs of `vcor_impact_face` marched in time together with
!> the sphere, so that contact, waves and relaxation are solved as one
!>
!> A mesh has n/2 and n steps, from which results are extrapolated to none; their error is the
!> distance from what the next coarser mesh gives, which has half of the steps, fewer springs and
!> fewer hats. What twice the hats change on the coarser mesh is added. The mesh is refined until
!> the accuracy is reached. Window and radius of the row follow the contact and are rounded up, so
!> that neighbours in a sweep share kernels; a kernel is the same whether it is shared or not. For
!> differences the mesh of one impact is kept for others.
module vcor_solver_coupled
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_face, only : face_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, &
      col_sphere, col_sphere_velocity, col_time, contact_lasting, contact_resting, &
      contact_separated, trajectory_t
   use vcor_kinds, only : unset, wp
   use vcor_numeric_lapack, only : dgesv
   use vcor_solver_coupled_kernel, only : kernel_t, mesh_t, new_kernel
   use vcor_solver_coupled_march, only : course_ended, course_outgrows, course_outlasts, course_t, &
      march
   use vcor_solver_coupled_structure, only : leave_structure
   use vcor_solver_type, only : as_text, default_accuracy, solver_settings_t, solver_t
   implicit none
   private

   public :: coupled_t, new_coupled

   !> Place of a kernel
   type :: slot_t
      type(kernel_t), allocatable :: kernel
   end type slot_t

   !> Places for kernels, and their largest size in real numbers, 64 MB
   integer, parameter :: slots = 64, most_numbers = 8000000

   !> Mesh of an impact
   type :: plan_t
      !> Level; -1: to be found
      integer :: level = -1
      !> Duration of all steps [s] and radius of the row of springs [m]
      real(wp) :: window = 0.0_wp, radius = 0.0_wp
      !> Duration of all steps for the largest force [s]; 0 if it needs none of its own
      real(wp) :: peak_window = 0.0_wp
   end type plan_t

   !> The coupled contact
   type, extends(solver_t) :: coupled_t
      private
      !> Kernels of earlier impacts, shape (slots); allocatable, for gfortran 12 does not finalise
      !> an array of fixed shape
      type(slot_t), allocatable :: slot(:)
      !> Place of the newest kernel
      integer :: newest = slots
      !> Operations that the impact has taken so far
      real(wp) :: work = 0.0_wp
      !> Mesh of the impact solved last, and that which all take
      type(plan_t) :: found, kept
   contains
      procedure :: solve
      procedure :: settle
   end type coupled_t

   !> A mesh on which an impact is solved twice
   type :: pair_t
      !> The mesh with all steps
      type(mesh_t) :: mesh
      !> With half of the steps, and with all
      type(course_t) :: coarse, fine
      !> Extrapolated coefficient of restitution of the sphere [-], contact time [s], largest force
      !> [N] and displacement [m] and their times [s]
      real(wp) :: cor = 0.0_wp, contact_time = 0.0_wp
      real(wp) :: max_force = 0.0_wp, time_of_max_force = 0.0_wp
      real(wp) :: depth = 0.0_wp, time_of_depth = 0.0_wp
      !> Largest forces of both, not extrapolated [N]
      real(wp) :: coarse_force = 0.0_wp, fine_force = 0.0_wp
   end type pair_t

   !> Scales to which window and radius are rounded
   type :: scale_t
      !> Time [s] and length [m]
      real(wp) :: time = 0.0_wp, length = 0.0_wp
   end type scale_t

   !> What is known about the duration and the size of a contact
   type :: search_t
      type(scale_t) :: scale
      !> Time by which the contact must have ended [s]
      real(wp) :: end_time = 0.0_wp
      !> Time that the contact outlasts [s], and the steps of the march that shows it [s]
      real(wp) :: outlasted = 0.0_wp, dt = 0.0_wp
      !> Steps of the next march that scouts
      integer :: steps = 40
      !> Number of earlier searches, which shorter steps have proved wrong
      integer :: attempt = 0
      !> Duration of all steps [s] and radius of the row of springs [m] for the contact
      real(wp) :: window = 0.0_wp, radius = 0.0_wp
   contains
      procedure :: note
   end type search_t

   !> A largest value
   type :: peak_t
      real(wp) :: value = 0.0_wp
      !> Its time [s]
      real(wp) :: time = 0.0_wp
   end type peak_t

   !> Steps of the coarsest mesh, the finest mesh, and its steps
   integer, parameter :: first_steps = 160, finest = 4, most_steps = first_steps*2**finest
   !> Operations that an impact may take, some ten seconds
   real(wp), parameter :: most_work = 4.0e10_wp
   !> Ratio of the errors of two levels at the best
   real(wp), parameter :: best_ratio = 8.0_wp
   !> Steps to the time scale of a contact that resolve it
   real(wp), parameter :: resolved = 8.0_wp
   !> Ratios to which window and radius are rounded up, and their margin
   real(wp), parameter :: window_ratio = 2.0_wp**0.125_wp, radius_ratio = 2.0_wp**0.25_wp
   real(wp), parameter :: margin = 1.04_wp
   !> Exponent of the law of a cone, which has no length
   real(wp), parameter :: cone = 2.0_wp
   !> Accuracy of a time scale, so that results do not depend on units
   real(wp), parameter :: precise = 1.0e-12_wp

contains

   !> Build the solver
   subroutine new_coupled(self, settings)
      type(coupled_t), intent(out) :: self
      !> Accuracy and end time
      type(solver_settings_t), intent(in) :: settings

      self%settings = settings
      allocate (self%slot(slots))
      if (.not. settings%accuracy > 0.0_wp) self%settings%accuracy = default_accuracy('coupled')
   end subroutine new_coupled

   !> Keep the mesh that suits an impact for all that are solved later, so that their results follow
   !> their numbers steadily
   subroutine settle(self, impact, error)
      class(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(error_t), allocatable, intent(out) :: error

      type(trajectory_t) :: trajectory

      self%kept = plan_t()
      call self%solve(impact, trajectory, error)
      self%kept = self%found
   end subroutine settle

   !> Compute the course of an impact
   subroutine solve(self, impact, trajectory, error)
      class(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! for contact time and largest force, which nothing refines
      real(wp), parameter :: careful = 2.0_wp
      ! relative error of the largest force from which it is computed again, if it comes early
      real(wp), parameter :: sharp = 1.0e-3_wp, early = 0.2_wp
      ! window of that computation divided by the time of the largest force
      real(wp), parameter :: longer = 3.0_wp
      type(pair_t) :: before, now
      type(course_t) :: course, wide
      type(search_t) :: search
      ! of the change by more hats on the mesh before, which is added: that of the mesh of now, with
      ! 9/7 to 13/11 of its elements, is 0.8 to 1.7 times as large, by second or first order
      real(wp), parameter :: unknown_part = 0.6_wp
      real(wp) :: cor_error, change, peak_window
      integer :: level, status

      search%scale = scales(impact)
      search%end_time = self%settings%end_time
      if (.not. search%end_time > 0.0_wp) search%end_time = &
         impact%patience(impact%time_scale(precise))
      self%work = 0.0_wp
      self%found = plan_t()
      search%window = self%kept%window
      search%radius = self%kept%radius
      level = min(self%kept%level, 0)
      do
         if (level < 0) then
            call scout(self, impact, search, course, error)
            if (allocated(error)) return
            if (course%status /= course_ended) then
               call record_contact(course, impact, trajectory)
               return
            end if
            level = 0
         end if
         call solve_pair(self, impact, mesh_of(level, impact%face, search%window, search%radius), &
            now, error)
         if (allocated(error)) return
         status = now%coarse%status
         if (status == course_ended) status = now%fine%status
         if (status /= course_ended) then
            ! what the search has found does not hold
            if (status == course_outlasts) call search%note(search%window, now%coarse%dt)
            search%steps = min(2*search%steps, most_steps)
            search%attempt = search%attempt + 1
            level = -1
            cycle
         end if
         if (level > 0) then
            cor_error = distance(before%coarse%cor(impact), before%fine%cor(impact), &
               now%coarse%cor(impact), now%fine%cor(impact))
            if (level == self%kept%level .or. cor_error <= self%settings%accuracy) then
               call run(self, impact, with_more_hats(before%mesh), wide, error)
               if (allocated(error)) return
               change = 0.0_wp
               if (wide%status == course_ended) &
                  change = wide%cor(impact) - before%coarse%cor(impact)
               now%cor = now%cor + change
               cor_error = max(cor_error, unknown_part*abs(change))
            end if
            if (level == self%kept%level .or. &
                cor_error <= self%settings%accuracy .and. self%kept%level < 0) exit
            ! steps that do not resolve the contact say nothing
            if (level == finest .or. self%kept%level < 0 &
                .and. now%coarse%dt*resolved <= impact%time_scale(precise) .and. &
                cor_error > self%settings%accuracy*best_ratio**(finest - level)) then
               call raise(error, error_numerical, 'the estimated error of cor_sphere exceeds ' &
                  //'solver.accuracy, '//as_text(self%settings%accuracy)//', by ' &
                  //as_text(cor_error - self%settings%accuracy)//' with '//steps_text(level) &
                  //' steps, and more steps would take too long; these reach ' &
                  //as_text(2.0_wp*cor_error))
               return
            end if
         end if
         before = now
         level = level + 1
      end do
      call record(now, impact, trajectory)
      trajectory%accuracy = self%settings%accuracy
      trajectory%contact_time_error = distance(before%coarse%contact_time, &
         before%fine%contact_time, now%coarse%contact_time, now%fine%contact_time)*careful &
         + now%fine%time_error
      trajectory%cor_sphere_error = cor_error &
         + impact%gravity*now%fine%time_error/impact%velocity
      trajectory%cor_error = trajectory%cor_sphere_error
      trajectory%max_force_error = distance(before%coarse_force, before%fine_force, &
         now%coarse_force, now%fine_force)*careful
      if (begins_without_bound([before%coarse%force(1), now%coarse%force(1), &
                                now%fine%force(1)])) trajectory%max_force_error = &
         max(trajectory%max_force_error, now%max_force)
      peak_window = self%kept%peak_window
      ! at first contact there is none that shorter steps would resolve
      if (self%kept%level < 0 .and. trajectory%max_force_error > sharp*now%max_force .and. &
          now%time_of_max_force < early*now%contact_time .and. &
          now%time_of_max_force > now%fine%dt) peak_window = rounded(longer*now%time_of_max_force, &
         window_ratio, search%scale%time)
      if (peak_window > 0.0_wp) call resolve_peak(self, impact, search%radius, peak_window, &
         trajectory, error)
      if (allocated(error)) return
      if (impact%target%structure%exists()) &
         call leave_structure(impact, self%settings%accuracy, trajectory, error)
      if (allocated(error)) return
      self%found = plan_t(level, search%window, search%radius, peak_window)
      if (now%contact_time > search%end_time) trajectory%status = contact_lasting
   end subroutine solve

   !> Whether the force of the first step grows without bound as the steps are halved, as that of a
   !> blunt body on an incompressible plate: what each halving adds does not become less
   pure function begins_without_bound(force) result(yes)
      !> Forces of the first step [N], each with steps half as long as before, shape (3)
      real(wp), intent(in) :: force(:)
      logical :: yes

      yes = force(2) > force(1) .and. force(3) - force(2) >= force(2) - force(1)
   end function begins_without_bound

   !> Estimated error of an extrapolated result, the largest of three so that they do not cancel by
   !> chance: what the level changes, what springs and hats change at equal steps, and what is left
   !> if the steps have less effect than of second order
   elemental function distance(long, middle, equal, short)
      !> Results of the level before with its longer and its shorter steps
      real(wp), intent(in) :: long, middle
      !> Results of this level, with steps equal to those shorter ones and with half of them
      real(wp), intent(in) :: equal, short
      real(wp) :: distance

      distance = max(abs(limit(equal, short) - limit(long, middle)), abs(equal - middle))
      associate (before => middle - long, now => short - equal)
         if (abs(before) > 2.0_wp*abs(now)) then
            ! the rest of a geometric series less the third that extrapolation takes away
            distance = max(distance, abs(now)*(now/(before - now) - 1.0_wp/3.0_wp))
         else
            distance = max(distance, 2.0_wp/3.0_wp*abs(now))
         end if
      end associate
   end function distance

   !> Mesh of a level: twice the steps of the level before, with more springs and hats. With 192
   !> springs the edge of a contact on a viscous layer, which ends with a step of the pressure, errs
   !> by 1e-5. The response of a layer varies over its thickness, which the longest hats resolve
   pure function mesh_of(level, face, window, radius) result(mesh)
      !> Level, from 0
      integer, intent(in) :: level
      type(face_t), intent(in) :: face
      !> Duration of all steps [s]
      real(wp), intent(in) :: window
      !> Radius of the row of springs [m]
      real(wp), intent(in) :: radius
      type(mesh_t) :: mesh

      integer, parameter :: most_for_layer = 24

      mesh = mesh_t(first_steps*2**level, nint(192.0_wp*1.5_wp**level), 8 + 2*level, window, radius)
      if (face%thickness > 0.0_wp) mesh%hats = mesh%hats &
         + int(min(3.0_wp*radius/face%thickness, real(most_for_layer, wp)))
   end function mesh_of

   !> Mesh with half of the steps and twice the elements of hats. By it the coefficient of
   !> restitution changes by half of the error of the hats if that is of first order, as in fast
   !> impacts, where the edge of the contact runs as fast as the waves, and by three quarters if of
   !> second order
   pure function with_more_hats(mesh) result(wide)
      type(mesh_t), intent(in) :: mesh
      type(mesh_t) :: wide

      wide = mesh
      wide%steps = mesh%steps/2
      wide%hats = 2*mesh%hats - 1
   end function with_more_hats

   !> Scales of an impact that do not depend on its velocity, so that a sweep of velocities shares
   !> kernels, and not on units: the length at which the body is as deep as it is wide, and the time
   !> in which the contact would push the body as far. A cone has no such length but that of the
   !> layer, or else of its own impact
   pure function scales(impact) result(scale)
      type(impact_t), intent(in) :: impact
      type(scale_t) :: scale

      ! the map contracts by half of the exponent of a power law at least
      integer, parameter :: iterations = 100
      real(wp), parameter :: same = 1.0e-13_wp
      real(wp) :: guess, stiffness
      integer :: i

      scale%time = impact%time_scale(precise)
      if (abs(impact%law%start_exponent - cone) > 0.0_wp) then
         scale%length = impact%factor**(1.0_wp/(cone - impact%law%start_exponent))
      else if (impact%face%thickness > 0.0_wp) then
         scale%length = impact%face%thickness
      else
         scale%length = scale%time*impact%speed_scale(scale%time)
         return
      end if
      ! from no time of its own, for neighbours share it to the last bit
      guess = 1.0_wp
      do i = 1, iterations
         stiffness = (impact%kernel_integral(guess) + impact%kernel_viscosity())/guess &
            *scale%length**(impact%law%start_exponent - 1.0_wp)
         scale%time = sqrt(impact%mass/stiffness)
         if (abs(scale%time - guess) <= same*guess) exit
         guess = scale%time
      end do
   end function scales

   !> Note that the contact outlasts a time
   pure subroutine note(self, time, dt)
      class(search_t), intent(inout) :: self
      !> The time [s]
      real(wp), intent(in) :: time
      !> Steps of the march that shows it [s]
      real(wp), intent(in) :: dt

      if (time < self%outlasted) return
      self%outlasted = time
      self%dt = dt
   end subroutine note

   !> March with few steps to find how long the contact lasts and how large it becomes. Of two
   !> marches that contradict each other that with the shorter steps is believed. A sphere that
   !> rests, or does not leave before the end time, is marched again with steps that resolve it
   subroutine scout(self, impact, search, course, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> What is known, on return with a window and a radius for a contact that ends
      type(search_t), intent(inout) :: search
      !> Course; of a contact that does not end, all that is known
      type(course_t), intent(out) :: course
      type(error_t), allocatable, intent(out) :: error

      ! growth of a window or row that is too short, and how much longer than expected they begin
      real(wp), parameter :: growth = 2.0_wp**0.5_wp, spare = 1.25_wp
      type(course_t) :: lasting
      type(mesh_t) :: mesh
      real(wp) :: time_scale

      time_scale = impact%time_scale(precise)
      mesh = mesh_t(search%steps, 32, 5)
      if (search%attempt > 0) mesh = mesh_t(search%steps, 112, 8)
      mesh%window = rounded(max(spare*impact%law%contact_time*time_scale, search%outlasted), &
         growth, search%scale%time)
      mesh%radius = impact%law%radius(impact%factor, &
         impact%law%depth*impact%speed_scale(time_scale)*time_scale)
      if (is_curved(impact)) mesh%radius = rounded(spare*mesh%radius, growth, &
         search%scale%length)
      do
         call run(self, impact, mesh, course, error)
         if (allocated(error)) return
         if (course%status == course_outgrows) then
            mesh%radius = growth*mesh%radius
         else if (course%status == course_ended) then
            if (course%contact_time > search%outlasted .or. course%dt <= search%dt) exit
            ! steps this long do not resolve the contact
            if (2*mesh%steps > most_steps) then
               if (lasting%steps > 0) course = lasting
               return
            end if
            mesh%steps = 2*mesh%steps
         else
            call search%note(mesh%window, course%dt)
            lasting = course
            if (course%rests(impact%mass*impact%gravity) .or. mesh%window >= search%end_time) then
               if (course%dt*resolved <= time_scale .or. mesh%steps == most_steps) return
               mesh%steps = min(most_steps, 4*ceiling(0.25_wp*min(real(most_steps, wp), &
                  resolved*mesh%window/time_scale)))
            else
               mesh%window = growth*mesh%window
            end if
         end if
      end do
      search%window = rounded(margin*course%contact_time, window_ratio, search%scale%time) &
         *window_ratio**search%attempt
      search%radius = mesh%radius
      if (is_curved(impact)) search%radius = rounded(margin*maxval(course%radius), radius_ratio, &
         search%scale%length) &
         *radius_ratio**search%attempt
   end subroutine scout

   !> Whether the contact has no fixed radius, which only that of a flat punch has
   pure function is_curved(impact)
      type(impact_t), intent(in) :: impact
      logical :: is_curved

      is_curved = impact%law%start_exponent > 1.0_wp
   end function is_curved

   !> Round up to a scale times a power of a ratio
   pure function rounded(value, ratio, scale)
      !> Number, > 0
      real(wp), intent(in) :: value
      !> Ratio, > 1
      real(wp), intent(in) :: ratio
      !> Scale, > 0
      real(wp), intent(in) :: scale
      real(wp) :: rounded

      rounded = scale*ratio**ceiling(log(value/scale)/log(ratio))
   end function rounded

   !> March on a mesh
   subroutine run(self, impact, mesh, course, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(mesh_t), intent(in) :: mesh
      type(course_t), intent(out) :: course
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      self%work = self%work + mesh%operations()
      if (self%work > most_work) then
         call raise(error, error_numerical, 'the impact would take more than ' &
            //as_text(most_work)//' operations, some ten seconds: the end of the contact depends ' &
            //'on the length of the steps on a plate that is too light or too soft for the ' &
            //'sphere; otherwise give a larger solver.accuracy')
         return
      end if
      do i = 1, slots
         if (.not. allocated(self%slot(i)%kernel)) cycle
         if (self%slot(i)%kernel%is_for(impact%face, mesh)) exit
      end do
      if (i > slots) then
         call make_room(self)
         i = self%newest
         allocate (self%slot(i)%kernel)
         call new_kernel(self%slot(i)%kernel, impact%face, mesh, error)
         if (allocated(error)) return
      end if
      call march(impact, self%slot(i)%kernel, course, error)
   end subroutine run

   !> Make room for a kernel: delete the oldest
   pure subroutine make_room(self)
      type(coupled_t), intent(inout) :: self

      integer :: total, i, oldest

      total = 0
      do i = 1, slots
         if (allocated(self%slot(i)%kernel)) total = total + self%slot(i)%kernel%numbers()
      end do
      self%newest = 1 + modulo(self%newest, slots)
      do i = 0, slots - 1
         oldest = 1 + modulo(self%newest + i - 1, slots)
         if (.not. allocated(self%slot(oldest)%kernel)) cycle
         if (i > 0 .and. total <= most_numbers) exit
         total = total - self%slot(oldest)%kernel%numbers()
         deallocate (self%slot(oldest)%kernel)
      end do
   end subroutine make_room

   !> March on a mesh with half of its steps and with all, and extrapolate to none: the error is of
   !> second order
   subroutine solve_pair(self, impact, mesh, pair, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(mesh_t), intent(in) :: mesh
      type(pair_t), intent(out) :: pair
      type(error_t), allocatable, intent(out) :: error

      type(mesh_t) :: half
      type(peak_t) :: one, two

      pair%mesh = mesh
      half = mesh
      half%steps = mesh%steps/2
      call run(self, impact, half, pair%coarse, error)
      if (allocated(error) .or. pair%coarse%status /= course_ended) return
      call run(self, impact, mesh, pair%fine, error)
      if (allocated(error) .or. pair%fine%status /= course_ended) return
      associate (a => pair%coarse, b => pair%fine)
         pair%contact_time = limit(a%contact_time, b%contact_time)
         pair%cor = limit(a%cor(impact), b%cor(impact))
         one = peak(a%force(0:a%steps), a%dt)
         two = peak(b%force(0:b%steps), b%dt)
         pair%coarse_force = one%value
         pair%fine_force = two%value
         pair%max_force = limit(one%value, two%value)
         pair%time_of_max_force = limit(one%time, two%time)
         one = peak(a%z(0:a%steps), a%dt)
         two = peak(b%z(0:b%steps), b%dt)
         pair%depth = limit(one%value, two%value)
         pair%time_of_depth = limit(one%time, two%time)
      end associate
   end subroutine solve_pair

   !> Compute the largest force again in a shorter window, as on a light plate the contact lasts
   !> long after it. What comes later does not change it
   subroutine resolve_peak(self, impact, radius, window, trajectory, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Radius of the row of springs [m]
      real(wp), intent(in) :: radius
      !> Duration of all steps [s]
      real(wp), intent(in) :: window
      !> The course of the impact, recorded
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      type(peak_t) :: top(2)
      type(course_t) :: course
      type(mesh_t) :: mesh
      real(wp) :: force(0:1)
      integer :: level, i

      do level = 0, 1
         mesh = mesh_of(level, impact%face, window, radius)
         do i = 2, 1, -1
            call run(self, impact, mesh, course, error)
            if (allocated(error) .or. course%status == course_outgrows) return
            top(i) = peak(course%force(0:course%steps), course%dt)
            mesh%steps = mesh%steps/2
         end do
         force(level) = limit(top(1)%value, top(2)%value)
      end do
      trajectory%max_force = force(1)
      trajectory%max_force_error = abs(force(1) - force(0))
      trajectory%time_of_max_force = limit(top(1)%time, top(2)%time)
   end subroutine resolve_peak

   !> Extrapolate to steps of no length
   elemental function limit(coarse, fine)
      !> Value with some steps
      real(wp), intent(in) :: coarse
      !> Value with twice as many
      real(wp), intent(in) :: fine
      real(wp) :: limit

      limit = (4.0_wp*fine - coarse)/3.0_wp
   end function limit

   !> Largest value of a series: the top of a polynomial that is fitted around it with weights that
   !> fall to 0 at its ends, so that the top follows the values steadily
   pure function peak(value, dt)
      !> Values at equal steps, shape (0:)
      real(wp), intent(in) :: value(0:)
      !> Step [s]
      real(wp), intent(in) :: dt
      type(peak_t) :: peak

      ! part of the largest value down to which it is fitted: the top of a sine is within 1e-7
      real(wp), parameter :: high = 0.95_wp
      integer, parameter :: degree = 4, iterations = 8
      real(wp) :: c(0:degree), products(0:degree, 0:degree), power(0:degree), x, weight, bend
      integer :: first, middle, last, most, i, info, pivots(degree + 1)

      middle = maxloc(value, 1) - 1
      peak%value = value(middle)
      peak%time = dt*real(middle, wp)
      do first = middle, 1, -1
         if (value(first - 1) <= high*peak%value) exit
      end do
      do last = middle, ubound(value, 1) - 1
         if (value(last + 1) <= high*peak%value) exit
      end do
      if (first == middle .or. last == middle) return
      most = min(degree, 2*((last - first)/2))
      c = 0.0_wp
      products = 0.0_wp
      do i = first, last
         weight = value(i)/peak%value - high
         power = (real(i - middle, wp)/real(last - first, wp))**[0, 1, 2, 3, 4]
         c(:most) = c(:most) + weight*value(i)*power(:most)
         products(:most, :most) = products(:most, :most) + weight &
            *spread(power(:most), 1, most + 1)*spread(power(:most), 2, most + 1)
      end do
      call dgesv(most + 1, 1, products, degree + 1, pivots, c, degree + 1, info)
      if (info /= 0) return
      x = 0.0_wp
      do i = 1, iterations
         bend = 2.0_wp*c(2) + x*(6.0_wp*c(3) + x*12.0_wp*c(4))
         if (.not. (bend < 0.0_wp .and. abs(x) < 1.0_wp)) return
         x = x - (c(1) + x*(2.0_wp*c(2) + x*(3.0_wp*c(3) + x*4.0_wp*c(4))))/bend
      end do
      peak%value = c(0) + x*(c(1) + x*(c(2) + x*(c(3) + x*c(4))))
      peak%time = dt*(real(middle, wp) + x*real(last - first, wp))
   end function peak

   !> Record the course of a contact that has ended, extrapolated at the nodes of the longer steps
   subroutine record(pair, impact, trajectory)
      type(pair_t), intent(in) :: pair
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(inout) :: trajectory

      integer :: i, n

      associate (a => pair%coarse, b => pair%fine)
         n = count([(real(i, wp)*a%dt < pair%contact_time, i=1, min(a%steps - 1, (b%steps - 1)/2))])
         call fill(trajectory, impact, a%dt, limit(a%force(0:n), b%force(0:2*n:2)), &
            limit(a%z(0:n), b%z(0:2*n:2)), limit(a%velocity(0:n), b%velocity(0:2*n:2)), &
            b%radius(0:2*n:2))
         trajectory%steps = a%steps + b%steps
         trajectory%tension = b%tension
         trajectory%radius(n + 1) = 0.0_wp
         ! the end, with the impulse of the whole contact
         n = n + 1
         trajectory%last = n
         trajectory%final = n
         associate (end => trajectory%state(:, n))
            end = unset
            end(col_time) = pair%contact_time
            end(col_force) = 0.0_wp
            end(col_sphere_velocity) = -pair%cor*impact%velocity
            end(col_impulse) = impact%mass*(impact%free_velocity(pair%contact_time) &
               + pair%cor*impact%velocity)
            end(col_sphere) = limit(a%z(a%steps), b%z(b%steps))
            end(col_indentation) = end(col_sphere)
         end associate
      end associate
      call share_impulse(trajectory)
      trajectory%status = contact_separated
      trajectory%max_indentation = pair%depth
      trajectory%time_of_max_indentation = pair%time_of_depth
      trajectory%max_force = pair%max_force
      trajectory%time_of_max_force = pair%time_of_max_force
   end subroutine record

   !> Record the course of a contact that has not ended
   subroutine record_contact(course, impact, trajectory)
      type(course_t), intent(in) :: course
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(inout) :: trajectory

      type(peak_t) :: top

      associate (n => course%steps)
         call fill(trajectory, impact, course%dt, course%force(0:n), course%z(0:n), &
            course%velocity(0:n), course%radius(0:n))
         trajectory%steps = n
         trajectory%last = n
         trajectory%final = n
         trajectory%status = contact_lasting
         if (course%rests(impact%mass*impact%gravity)) trajectory%status = contact_resting
         top = peak(course%force(0:n), course%dt)
         trajectory%max_force = top%value
         trajectory%time_of_max_force = top%time
         top = peak(course%z(0:n), course%dt)
         trajectory%max_indentation = top%value
         trajectory%time_of_max_indentation = top%time
      end associate
      call share_impulse(trajectory)
   end subroutine record_contact

   !> Record equal steps. The plate has no displacement apart from the indentation: both are the
   !> approach of the sphere to the undisturbed face
   subroutine fill(trajectory, impact, dt, force, z, velocity, radius)
      type(trajectory_t), intent(inout) :: trajectory
      type(impact_t), intent(in) :: impact
      !> Step [s]
      real(wp), intent(in) :: dt
      !> Force [N], displacement [m] and velocity of the sphere [m/s], shape (0:n)
      real(wp), intent(in) :: force(0:), z(0:), velocity(0:)
      !> Contact radius [m], same shape
      real(wp), intent(in) :: radius(0:)

      integer :: i, n

      n = ubound(force, 1)
      call trajectory%reserve(n + 1)
      trajectory%state = unset
      do i = 0, n
         trajectory%state(col_time, i) = real(i, wp)*dt
         trajectory%state(col_force, i) = max(0.0_wp, force(i))
         trajectory%state(col_sphere, i) = z(i)
         trajectory%state(col_sphere_velocity, i) = velocity(i)
         trajectory%state(col_impulse, i) = impact%mass &
            *(impact%free_velocity(real(i, wp)*dt) - velocity(i))
      end do
      trajectory%state(col_indentation, :) = trajectory%state(col_sphere, :)
      allocate (trajectory%radius(0:n + 1), source=unset)
      trajectory%radius(0:n) = radius
   end subroutine fill

   !> Share the impulse of each step among its ends. Forces would do worse: they may begin as the
   !> square root of time
   pure subroutine share_impulse(trajectory)
      type(trajectory_t), intent(inout) :: trajectory

      associate (n => trajectory%last, impulse => trajectory%state(col_impulse, :))
         trajectory%share(0:n - 1) = 0.5_wp*(impulse(2:n + 1) - impulse(1:n))
         trajectory%share(n) = 0.0_wp
         trajectory%share(1:n) = trajectory%share(1:n) + 0.5_wp*(impulse(2:n + 1) - impulse(1:n))
      end associate
   end subroutine share_impulse

   !> Number of steps of a level as text of fixed length, for threads
   pure function steps_text(level) result(text)
      !> Level, from 0
      integer, intent(in) :: level
      !> Text such as 1280
      character(len=4) :: text

      write (text, '(i4)') first_steps*2**level
   end function steps_text

end module vcor_solver_coupled
