!> Exact contact with waves: the row of springs of `vcor_impact_face` marched in time together with
!> the sphere, so that contact, waves and relaxation are solved as one
!>
!> An impact is marched with n/8, n/4, n/2 and n steps, from which results are extrapolated to steps
!> of no length, and once more with fewer hats, from which they are extrapolated to any number of
!> hats. What each extrapolation adds says how far it can be trusted; the steps or the hats are
!> refined, whichever leave the larger error, until the accuracy is reached. Window and radius of
!> the row follow the contact and are rounded up, so that neighbours in a sweep share kernels; a
!> kernel is the same whether it is shared or not. For differences the mesh of one impact is kept
!> for others.
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
      !> Steps over the window and elements of the hats; 0: to be found
      integer :: steps = 0, elements = 0
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

   !> Marches of an impact
   type :: marches_t
      !> With n/8, n/4, n/2 and n steps
      type(course_t) :: course(0:3)
      !> The steps n; 0: none yet
      integer :: steps = 0
      !> The elements of their hats
      integer :: elements = 0
      !> With fewer elements, and the steps of `course(same)`
      type(course_t) :: fewer
      integer :: same = 0
      !> Its elements and steps
      integer :: fewer_elements = 0, fewer_steps = 0
   end type marches_t

   !> An extrapolated result
   type :: result_t
      real(wp) :: value = 0.0_wp
      !> Estimated errors of the value by steps and by hats
      real(wp) :: by_steps = 0.0_wp, by_hats = 0.0_wp
   contains
      procedure :: error => error_of_result
   end type result_t

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
      !> Root mean square of what the values deviate from the fit
      real(wp) :: noise = 0.0_wp
   end type peak_t

   !> Steps at first and at most
   integer, parameter :: first_steps = 160, most_steps = 16*first_steps
   !> Elements of the hats at first and at most. Of a layer, whose response varies over its
   !> thickness, three more for each thickness that the contact is wide
   integer, parameter :: first_elements = 8, most_elements = 80
   real(wp), parameter :: elements_per_thickness = 3.0_wp
   !> Operations that an impact may take, some ten seconds
   real(wp), parameter :: most_work = 4.0e10_wp
   !> Ratio of elements of the hats when they are refined, and of those of the first mesh
   real(wp), parameter :: hats_ratio = 1.5_wp, first_ratio = 1.6_wp
   !> Order by which the error is expected to fall with the steps at the best, as h^2 is
   !> extrapolated away
   integer, parameter :: best_order = 3
   !> Springs at least, and springs per step
   integer, parameter :: least_springs = 400
   real(wp), parameter :: springs_per_step = 2.5_wp
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

      ! part of the accuracy that the estimated error must reach: of 121 impacts the error was more
      ! than twice the estimate in 3
      real(wp), parameter :: share = 0.5_wp
      ! relative error of the largest force from which it is computed again, if it comes early
      real(wp), parameter :: sharp = 1.0e-3_wp, early = 0.2_wp
      ! window of that computation divided by the time of the largest force
      real(wp), parameter :: longer = 3.0_wp
      type(marches_t) :: marches
      type(course_t) :: course
      type(search_t) :: search
      type(plan_t) :: plan
      type(result_t) :: cor, force, time
      type(peak_t) :: top(0:3), fewer
      logical :: ended
      integer :: i

      search%scale = scales(impact)
      search%end_time = self%settings%end_time
      if (.not. search%end_time > 0.0_wp) search%end_time = &
         impact%patience(impact%time_scale(precise))
      self%work = 0.0_wp
      self%found = plan_t()
      plan = self%kept
      do
         if (plan%steps == 0) then
            call scout(self, impact, search, course, error)
            if (allocated(error)) return
            if (course%status /= course_ended) then
               call record_contact(course, impact, trajectory)
               return
            end if
            plan = first_plan(impact%face, search%window, search%radius)
            marches = marches_t()
         end if
         call solve_meshes(self, impact, plan, marches, ended, error)
         if (allocated(error)) return
         if (.not. ended) then
            ! what the search has found does not hold
            if (any(marches%course%status == course_outlasts)) call search%note(plan%window, &
               plan%window/real(plan%steps, wp))
            search%steps = min(2*search%steps, most_steps)
            search%attempt = search%attempt + 1
            plan = plan_t()
            cycle
         end if
         cor = extrapolated(marches, plan, marches%course%cor(impact), marches%fewer%cor(impact), &
            is_smooth=is_curved(impact))
         if (self%kept%steps > 0 .or. cor%error() <= share*self%settings%accuracy) exit
         call refine(plan, marches, cor, self%settings%accuracy, impact%time_scale(precise), &
            ended, error)
         if (ended) exit
         if (allocated(error)) return
      end do
      time = extrapolated(marches, plan, marches%course%contact_time, marches%fewer%contact_time, &
         is_smooth=.false.)
      do i = 0, 3
         top(i) = peak(marches%course(i)%force(0:marches%course(i)%steps), marches%course(i)%dt)
      end do
      fewer = peak(marches%fewer%force(0:marches%fewer%steps), marches%fewer%dt)
      force = extrapolated(marches, plan, top%value, fewer%value, is_smooth=.false.)
      call record(marches, impact, cor%value, time%value, trajectory)
      trajectory%accuracy = self%settings%accuracy
      trajectory%contact_time_error = time%error() + marches%course(3)%time_error
      trajectory%cor_sphere_error = cor%error() &
         + impact%gravity*marches%course(3)%time_error/impact%velocity
      trajectory%cor_error = trajectory%cor_sphere_error
      trajectory%max_force = force%value
      trajectory%time_of_max_force = limit(top(2)%time, top(3)%time)
      trajectory%max_force_error = force%error() + top(3)%noise
      if (begins_without_bound([(marches%course(i)%force(1), i=1, 3)])) &
         trajectory%max_force_error = max(trajectory%max_force_error, force%value)
      ! at first contact there is none that shorter steps would resolve
      if (self%kept%steps == 0) then
         plan%peak_window = 0.0_wp
         if (trajectory%max_force_error > sharp*force%value .and. &
             trajectory%time_of_max_force < early*time%value .and. &
             trajectory%time_of_max_force > marches%course(3)%dt) plan%peak_window = &
            rounded(longer*trajectory%time_of_max_force, window_ratio, search%scale%time)
      end if
      if (plan%peak_window > 0.0_wp) call resolve_peak(self, impact, plan, trajectory, error)
      if (allocated(error)) return
      self%found = plan
      if (time%value > search%end_time) trajectory%status = contact_lasting
   end subroutine solve

   !> Whether the force of the first step grows without bound as the steps are halved, as that of a
   !> blunt body on an incompressible plate: what each halving adds does not become less
   pure function begins_without_bound(force) result(yes)
      !> Forces of the first step [N], each with steps half as long as before, shape (3)
      real(wp), intent(in) :: force(:)
      logical :: yes

      yes = force(2) > force(1) .and. force(3) - force(2) >= force(2) - force(1)
   end function begins_without_bound

   !> First mesh of an impact
   pure function first_plan(face, window, radius) result(plan)
      type(face_t), intent(in) :: face
      !> Duration of all steps [s] and radius of the row of springs [m]
      real(wp), intent(in) :: window, radius
      type(plan_t) :: plan

      real(wp) :: elements

      elements = real(first_elements, wp)
      if (face%thickness > 0.0_wp) elements = elements + elements_per_thickness*radius &
         /max(face%thickness, radius/8.0_wp)
      plan = plan_t(first_steps, int(elements), window, radius)
   end function first_plan

   !> Refine what leaves the larger error
   pure subroutine refine(plan, marches, cor, accuracy, time_scale, enough, error)
      type(plan_t), intent(inout) :: plan
      type(marches_t), intent(in) :: marches
      !> Coefficient of restitution
      type(result_t), intent(in) :: cor
      !> Its error at most
      real(wp), intent(in) :: accuracy
      !> Time scale of the contact [s]
      real(wp), intent(in) :: time_scale
      !> Whether no mesh is finer and the error is within the accuracy; the mesh is as it was
      logical, intent(out) :: enough
      !> Error of code `error_numerical`: no mesh will reach the accuracy
      type(error_t), allocatable, intent(out) :: error

      type(plan_t) :: finer
      real(wp) :: best
      integer :: steps

      enough = .false.
      steps = plan%steps
      finer = plan
      if (cor%by_hats > cor%by_steps) then
         finer%elements = ceiling(hats_ratio*real(plan%elements, wp))
         enough = finer%elements > most_elements
      else
         finer%steps = 2*steps
         ! steps that do not resolve the contact say nothing
         best = cor%by_steps*(real(steps, wp)/real(most_steps, wp))**best_order
         enough = finer%steps > most_steps .or. &
            best > accuracy .and. marches%course(0)%dt*resolved <= time_scale
      end if
      if (.not. enough) plan = finer
      if (.not. enough .or. cor%error() <= accuracy) return
      call raise(error, error_numerical, 'the estimated error of cor_sphere exceeds ' &
         //'solver.accuracy, '//as_text(accuracy)//', by '//as_text(cor%error() - accuracy) &
         //' with '//steps_text(steps)//' steps, and more steps would take too long: give a ' &
         //'larger one')
   end subroutine refine

   !> Estimated error of a result
   elemental function error_of_result(self) result(error)
      class(result_t), intent(in) :: self
      real(wp) :: error

      error = self%by_steps + self%by_hats
   end function error_of_result

   !> Extrapolate to steps of no length and any number of hats. What the extrapolations add says how
   !> far they can be trusted.
   !>
   !> The error of the steps is h^2 and, where the contact is smooth enough in time, h^3; both are
   !> taken away. Two values that agree by chance do not make it small: it is no less than a seventh
   !> of what the same extrapolation has added for twice as long steps, and no less than what is
   !> left if the order is lower, as for bodies that begin with a sudden force. The contact time and
   !> the largest force depend on single steps and springs as well; of them only h^2 is taken away,
   !> and half of the difference from the value for twice as long steps is stated. The error of the
   !> hats is of second order in their length
   pure function extrapolated(marches, plan, value, fewer, is_smooth) result(found)
      type(marches_t), intent(in) :: marches
      type(plan_t), intent(in) :: plan
      !> Values of `marches%course`, shape (0:3), and of `marches%fewer`
      real(wp), intent(in) :: value(0:), fewer
      !> Whether the value depends on no single step, which that of a punch does, whose force may
      !> begin at once
      logical, intent(in) :: is_smooth
      type(result_t) :: found

      real(wp) :: two(0:2), rest

      two = limit(value(0:2), value(1:3))
      found%value = two(2)
      if (marches%course(1)%status /= course_ended) then
         found%by_steps = abs(value(3) - value(2))
      else if (marches%course(0)%status /= course_ended) then
         found%by_steps = 0.5_wp*abs(two(2) - two(1))
      else
         associate (before => two(1) - two(0), now => two(2) - two(1))
            if (is_smooth) then
               found%value = two(2) + now/7.0_wp
               found%by_steps = max(abs(now)/7.0_wp, abs(before)/49.0_wp)
            else
               found%by_steps = 0.5_wp*abs(now)
            end if
            ! of lower order: the rest of a geometric series
            if (before*now > 0.0_wp .and. abs(before) < 8.0_wp*abs(now)) found%by_steps = &
               max(found%by_steps, abs(now)/max(before/now - 1.0_wp, 0.5_wp))
         end associate
      end if
      rest = (value(marches%same) - fewer) &
         /((real(plan%elements, wp)/real(marches%fewer_elements, wp))**2 - 1.0_wp)
      found%value = found%value + rest
      found%by_hats = abs(rest)
   end function extrapolated

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

   !> March with all steps and their halves, and with fewer hats; what was marched before is not
   !> marched again
   subroutine solve_meshes(self, impact, plan, marches, ended, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(plan_t), intent(in) :: plan
      type(marches_t), intent(inout) :: marches
      !> Whether the marches with the most steps have ended
      logical, intent(out) :: ended
      type(error_t), allocatable, intent(out) :: error

      integer :: first, i, same

      ! hats are compared at the fewest steps that resolve a contact
      do same = 0, 2
         if (steps_of(plan, same) >= first_steps/2) exit
      end do
      first = 0
      if (marches%steps > 0 .and. marches%elements /= plan%elements) then
         marches%fewer = marches%course(same)
         marches%fewer_elements = marches%elements
         marches%fewer_steps = steps_of(plan, same)
      else if (2*marches%steps == plan%steps) then
         do i = 0, 2
            marches%course(i) = marches%course(i + 1)
         end do
         first = 3
      end if
      marches%steps = plan%steps
      marches%elements = plan%elements
      marches%same = same
      do i = 3, first, -1
         call run(self, impact, mesh_of(plan, i, plan%elements), marches%course(i), error)
         ended = marches%course(i)%status == course_ended
         if (allocated(error) .or. i > 1 .and. .not. ended) return
      end do
      ended = .true.
      if (marches%fewer_steps == steps_of(plan, same)) return
      if (marches%fewer_steps == 0) marches%fewer_elements = nint(real(plan%elements, wp) &
         /first_ratio)
      marches%fewer_steps = steps_of(plan, same)
      call run(self, impact, mesh_of(plan, same, marches%fewer_elements), marches%fewer, error)
      if (allocated(error)) return
      ended = marches%fewer%status == course_ended
   end subroutine solve_meshes

   !> Steps over the window of one of the marches of a plan
   elemental function steps_of(plan, march) result(steps)
      type(plan_t), intent(in) :: plan
      !> March, 0 (fewest steps) to 3
      integer, intent(in) :: march
      integer :: steps

      steps = plan%steps/2**(3 - march)
   end function steps_of

   !> Mesh of one of the marches of a plan, with steps after the window that see the contact ended
   pure function mesh_of(plan, march, elements) result(mesh)
      type(plan_t), intent(in) :: plan
      !> March, 0 (fewest steps) to 3
      integer, intent(in) :: march
      !> Elements of the hats
      integer, intent(in) :: elements
      type(mesh_t) :: mesh

      integer, parameter :: after = 4

      associate (steps => steps_of(plan, march))
         mesh = mesh_t(steps + after, max(least_springs, nint(springs_per_step*real(steps, wp))), &
            elements + 1, plan%window*(real(steps + after, wp)/real(steps, wp)), plan%radius)
      end associate
   end function mesh_of

   !> Compute the largest force again in a shorter window, as on a light plate the contact lasts
   !> long after it. What comes later does not change it
   subroutine resolve_peak(self, impact, plan, trajectory, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> The mesh of the impact
      type(plan_t), intent(in) :: plan
      !> The course of the impact, recorded
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      type(plan_t) :: short
      type(peak_t) :: top(3)
      type(course_t) :: course
      integer :: i

      short = plan
      short%steps = 2*first_steps
      short%window = plan%peak_window
      do i = 1, 3
         call run(self, impact, mesh_of(short, i, plan%elements), course, error)
         if (allocated(error) .or. course%status == course_outgrows) return
         top(i) = peak(course%force(0:course%steps), course%dt)
      end do
      trajectory%max_force = limit(top(2)%value, top(3)%value)
      trajectory%max_force_error = abs(trajectory%max_force - limit(top(1)%value, top(2)%value)) &
         + top(3)%noise
      trajectory%time_of_max_force = limit(top(2)%time, top(3)%time)
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
      real(wp) :: c(0:degree), products(0:degree, 0:degree), power(0:degree), x, weight, bend, total
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
      total = 0.0_wp
      do i = first, last
         weight = value(i)/peak%value - high
         power = (real(i - middle, wp)/real(last - first, wp))**[0, 1, 2, 3, 4]
         peak%noise = peak%noise + weight*(value(i) - sum(c(:most)*power(:most)))**2
         total = total + weight
      end do
      peak%noise = sqrt(peak%noise/total)
      peak%value = c(0) + x*(c(1) + x*(c(2) + x*(c(3) + x*c(4))))
      peak%time = dt*(real(middle, wp) + x*real(last - first, wp))
   end function peak

   !> Record the course of a contact that has ended, extrapolated to steps of no length
   subroutine record(marches, impact, cor, contact_time, trajectory)
      type(marches_t), intent(in) :: marches
      type(impact_t), intent(in) :: impact
      !> Coefficient of restitution of the sphere [-] and contact time [s]
      real(wp), intent(in) :: cor, contact_time
      type(trajectory_t), intent(inout) :: trajectory

      type(peak_t) :: one, two
      integer :: i, n

      associate (a => marches%course(2), b => marches%course(3))
         n = count([(real(i, wp)*b%dt < contact_time, i=1, min(2*(a%steps - 1), b%steps - 1))])
         call fill(trajectory, impact, b%dt, at_nodes(a%force, b%force(0:n)), &
            at_nodes(a%z, b%z(0:n)), at_nodes(a%velocity, b%velocity(0:n)), b%radius(0:n))
         trajectory%steps = a%steps + b%steps
         trajectory%radius(n + 1) = 0.0_wp
         ! the end, with the impulse of the whole contact
         n = n + 1
         trajectory%last = n
         trajectory%final = n
         associate (end => trajectory%state(:, n))
            end = unset
            end(col_time) = contact_time
            end(col_force) = 0.0_wp
            end(col_sphere_velocity) = -cor*impact%velocity
            end(col_impulse) = impact%mass*(impact%free_velocity(contact_time) &
               + cor*impact%velocity)
            end(col_sphere) = limit(a%z(a%steps), b%z(b%steps))
            end(col_indentation) = end(col_sphere)
         end associate
         one = peak(a%z(0:a%steps), a%dt)
         two = peak(b%z(0:b%steps), b%dt)
      end associate
      call share_impulse(trajectory)
      trajectory%status = contact_separated
      trajectory%max_indentation = limit(one%value, two%value)
      trajectory%time_of_max_indentation = limit(one%time, two%time)
   end subroutine record

   !> Values extrapolated to steps of no length, at the nodes of the shorter steps. What is added
   !> there between two of the longer steps is the mean of what is added at these
   pure function at_nodes(coarse, fine) result(value)
      !> Values with the longer steps, shape (0:), beyond the others, and with the shorter, (0:n)
      real(wp), intent(in) :: coarse(0:), fine(0:)
      real(wp) :: value(0:ubound(fine, 1))

      real(wp) :: more(0:ubound(fine, 1))
      integer :: last

      last = ubound(fine, 1)
      more(0::2) = limit(coarse(0:last/2), fine(0::2)) - fine(0::2)
      more(1:last - 1:2) = 0.5_wp*(more(0:last - 2:2) + more(2:last:2))
      ! the last node may have no longer step beside it
      if (modulo(last, 2) == 1) more(last) = more(last - 1)
      value = fine + more
   end function at_nodes

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

   !> Number of steps as text of fixed length, for threads
   pure function steps_text(steps) result(text)
      integer, intent(in) :: steps
      !> Text such as 1280
      character(len=4) :: text

      write (text, '(i4)') steps
   end function steps_text

end module vcor_solver_coupled
