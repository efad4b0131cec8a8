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
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_lasting, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_richardson, only : best_ratio
   use vcor_solver_coupled_course, only : course_ended, course_outgrows, course_outlasts, course_t
   use vcor_solver_coupled_kernel, only : mesh_t
   use vcor_solver_coupled_march, only : march
   use vcor_solver_coupled_pair, only : begins_without_bound, distance, limit, pair_t
   use vcor_solver_coupled_peak, only : peak, peak_t
   use vcor_solver_coupled_plan, only : first_steps, is_curved, mesh_of, precise, rounded, &
      scale_t, scales, with_more_hats
   use vcor_solver_coupled_record, only : record, record_contact
   use vcor_solver_coupled_store, only : new_store, store_t
   use vcor_solver_coupled_structure, only : leave_structure
   use vcor_solver_type, only : as_text, default_accuracy, solver_settings_t, solver_t
   implicit none
   private

   public :: coupled_t, new_coupled

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
      !> Kernels of earlier impacts
      type(store_t) :: store
      !> Operations that the impact has taken so far
      real(wp) :: work = 0.0_wp
      !> Mesh of the impact solved last, and that which all take
      type(plan_t) :: found, kept
   contains
      procedure :: solve
      procedure :: settle
   end type coupled_t

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

   !> The finest mesh, and its steps. All levels up to it take 1.1e10 to 1.4e10 operations (see
   !> `mesh_t`) on a half space, at 0.12 ns an operation (eight meshes from 5e9 to 7e10: 0.10 to
   !> 0.12) 1.3 to 1.7 s; of the slowest of 80 random impacts at an accuracy of 1e-7 1.4 to 2.6 s
   !> were measured
   integer, parameter :: finest = 4, most_steps = first_steps*2**finest
   !> Operations that an impact may take: what all levels up to the finest take with 40 hats, the
   !> most of a layer, 3.6e10 and more. A plate whose contact lasts for hundreds of time scales
   !> takes them for the search alone. 5 s at 0.12 ns
   real(wp), parameter :: most_work = 4.0e10_wp
   !> Steps to the time scale of a contact that resolve it: longer ones have shown a sphere that
   !> leaves a nearly fluid plate in the middle of the contact
   real(wp), parameter :: resolved = 8.0_wp
   !> Relative error of the largest force from which it is computed again, if it comes before this
   !> part of the contact or of the window: a window of three times its time then has at least
   !> (1/3)/0.2 = 1.7 times as many steps before it, which divide an error of second order by 3
   real(wp), parameter :: sharp = 1.0e-3_wp, early = 0.2_wp
   !> Ratios to which window and radius are rounded up, so that impacts that differ by less share
   !> kernels, and their margin over what the search has found by 40 steps and five hats: of 119
   !> random impacts the contact lasted 0.989 to 1.012 of that, and its radius was 0.964 to 1.028.
   !> Where that is not enough the search begins anew (one of them)
   real(wp), parameter :: window_ratio = 2.0_wp**0.125_wp, radius_ratio = 2.0_wp**0.25_wp
   real(wp), parameter :: margin = 1.04_wp

contains

   !> Build the solver
   subroutine new_coupled(self, settings)
      type(coupled_t), intent(out) :: self
      !> Accuracy and end time
      type(solver_settings_t), intent(in) :: settings

      self%settings = settings
      call new_store(self%store)
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

      ! for contact time and largest force, which nothing refines: of 240 random impacts all but one
      ! contact time and two forces are then within three stated errors
      real(wp), parameter :: careful = 2.0_wp
      type(pair_t) :: before, now
      type(course_t) :: course
      type(search_t) :: search
      real(wp) :: cor_error, hats_error(2), peak_window
      integer :: level, status

      search%scale = scales(impact)
      search%end_time = self%settings%end_time
      if (.not. search%end_time > 0.0_wp) search%end_time = &
         impact%lasting_time(impact%time_scale(precise))
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
               call find_hats_error(self, impact, before, hats_error, error)
               if (allocated(error)) return
               now%cor = now%cor + hats_error(1)
               cor_error = max(cor_error, hats_error(2))
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
      trajectory%max_force_error = careful*max(now%scatter, distance(before%coarse_force, &
         before%fine_force, now%coarse_force, now%fine_force))
      if (begins_without_bound([before%coarse%force(1), now%coarse%force(1), &
                                now%fine%force(1)])) trajectory%max_force_error = &
         max(trajectory%max_force_error, now%max_force)
      peak_window = self%kept%peak_window
      ! a force that begins without bound has none that shorter steps would resolve
      if (self%kept%level < 0 .and. trajectory%max_force_error > sharp*now%max_force .and. &
          trajectory%max_force_error < now%max_force .and. &
          now%time_of_max_force < early*now%contact_time) &
         peak_window = around(now%time_of_max_force, now%fine%dt, search%scale)
      if (peak_window > 0.0_wp) call resolve_peak(self, impact, search, peak_window, trajectory, &
         error)
      if (allocated(error)) return
      if (impact%target%structure%exists()) &
         call leave_structure(impact, self%settings%accuracy, trajectory, error)
      if (allocated(error)) return
      self%found = plan_t(level, search%window, search%radius, peak_window)
      if (now%contact_time > search%end_time) trajectory%status = contact_lasting
   end subroutine solve

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

      ! growth of a window or row that is too short, and how much longer than expected they begin:
      ! of 121 random impacts 90 in 100 lasted no longer, and radii were 0.37 to 1.06 of what is
      ! expected. A march of 40 steps more or less. With 1 and 1.6 two of 40 random impacts change,
      ! by up to 0.4 stated errors
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
            //as_text(most_work)//' operations, some five seconds: the end of the contact ' &
            //'depends on the length of the steps on a plate that is too light or too soft for ' &
            //'the sphere; otherwise give a larger solver.accuracy')
         return
      end if
      call self%store%find(impact%face, mesh, i, error)
      if (allocated(error)) return
      call march(impact, self%store%slot(i)%kernel, course, error)
   end subroutine run

   !> March on a mesh with half of its steps and with all, and extrapolate to none: the error is of
   !> second order
   subroutine solve_pair(self, impact, mesh, pair, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(mesh_t), intent(in) :: mesh
      type(pair_t), intent(out) :: pair
      type(error_t), allocatable, intent(out) :: error

      type(mesh_t) :: half

      pair%mesh = mesh
      half = mesh
      half%steps = mesh%steps/2
      call run(self, impact, half, pair%coarse, error)
      if (allocated(error) .or. pair%coarse%status /= course_ended) return
      call run(self, impact, mesh, pair%fine, error)
      if (allocated(error) .or. pair%fine%status /= course_ended) return
      call pair%extrapolate(impact)
   end subroutine solve_pair

   !> Find the error of the hats in the coefficient of restitution by what twice their elements
   !> change on the mesh before: at half of its steps, and if that leaves too much unknown at all of
   !> them too, extrapolated.
   !>
   !> In fast impacts, where the edge of the contact runs as fast as the waves, the hats are of
   !> first order, otherwise of second or more. The finer mesh has r times the elements of the one
   !> before, 9/7 to 13/11, and errs by r^-n/(1 - 2^-n) times the change: by all of it at order 1.6,
   !> and by nothing where they converge fast. So half of it is added, and as much is unknown; of a
   !> change that is extrapolated itself, all of it
   subroutine find_hats_error(self, impact, before, hats_error, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> The mesh before
      type(pair_t), intent(in) :: before
      !> What is to be added [-], and its bound
      real(wp), intent(out) :: hats_error(2)
      type(error_t), allocatable, intent(out) :: error

      type(course_t) :: course
      type(mesh_t) :: mesh
      real(wp) :: change(2)

      hats_error = 0.0_wp
      mesh = with_more_hats(before%mesh)
      mesh%steps = mesh%steps/2
      call run(self, impact, mesh, course, error)
      if (allocated(error) .or. course%status /= course_ended) return
      change(1) = course%cor(impact) - before%coarse%cor(impact)
      hats_error = 0.5_wp*[change(1), abs(change(1))]
      if (hats_error(2) <= self%settings%accuracy .or. self%kept%level >= 0) return
      call run(self, impact, with_more_hats(before%mesh), course, error)
      if (allocated(error) .or. course%status /= course_ended) return
      change(2) = limit(change(1), course%cor(impact) - before%fine%cor(impact))
      hats_error = [0.5_wp*change(2), abs(change(2))]
   end subroutine find_hats_error

   !> Window in which an early largest force is resolved
   pure function around(time, dt, scale) result(window)
      !> Time of the force, and the steps that have shown it [s]
      real(wp), intent(in) :: time, dt
      type(scale_t), intent(in) :: scale
      !> Window [s]
      real(wp) :: window

      ! the force is then in the middle of it, or in the first step resolved by fifty
      real(wp), parameter :: longer = 3.0_wp

      window = rounded(longer*max(time, dt), window_ratio, scale%time)
   end function around

   !> Compute the largest force again in a shorter window, as on a light plate the contact lasts
   !> long after it, and in a shorter one if it comes early in that too. What comes later does not
   !> change it
   subroutine resolve_peak(self, impact, search, window, trajectory, error)
      type(coupled_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> What has been found about the contact
      type(search_t), intent(in) :: search
      !> Duration of all steps [s], on return of the last computation
      real(wp), intent(inout) :: window
      !> The course of the impact, recorded
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! windows, each a hundredth of the one before at the least
      integer, parameter :: most = 4
      type(peak_t) :: top(2)
      type(course_t) :: course
      type(mesh_t) :: mesh
      real(wp) :: force(0:1), first(0:2)
      integer :: level, i, round

      do round = 1, most
         do level = 0, 1
            mesh = mesh_of(level, impact%face, window, search%radius)
            do i = 2, 1, -1
               call run(self, impact, mesh, course, error)
               if (allocated(error) .or. course%status == course_outgrows) return
               top(i) = peak(course%force(0:course%steps), course%dt)
               first(level + i - 1) = course%force(1)
               mesh%steps = mesh%steps/2
            end do
            force(level) = limit(top(1)%value, top(2)%value)
         end do
         trajectory%max_force = force(1)
         trajectory%max_force_error = max(abs(force(1) - force(0)), top(2)%scatter)
         trajectory%time_of_max_force = limit(top(1)%time, top(2)%time)
         if (begins_without_bound(first)) trajectory%max_force_error = &
            max(trajectory%max_force_error, trajectory%max_force)
         if (self%kept%level >= 0 .or. trajectory%max_force_error <= sharp*force(1) .or. &
             trajectory%max_force_error >= force(1) .or. &
             trajectory%time_of_max_force >= early*window) exit
         window = around(trajectory%time_of_max_force, window/real(2*mesh%steps, wp), search%scale)
      end do
   end subroutine resolve_peak

   !> Number of steps of a level as text of fixed length, for threads
   pure function steps_text(level) result(text)
      !> Level, from 0
      integer, intent(in) :: level
      !> Text such as 1280
      character(len=4) :: text

      write (text, '(i4)') first_steps*2**level
   end function steps_text

end module vcor_solver_coupled
