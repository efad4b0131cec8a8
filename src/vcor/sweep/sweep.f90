!> Sweeps, the impacts of a case, one for each point of a grid. An impact by itself is a sweep of
!> one point
!>
!> A point is the blueprint of the case with some numbers set, so nothing is read, looked up or
!> checked as a whole for it, and no rules of a solver are made. Outcomes are kept by the number of
!> their point: they are the same bits for any number of threads. A point that makes no sense, or
!> cannot be solved, has a status instead of numbers and stops no other.
!>
!> What threads call has no static storage. That includes the functions that return a text of
!> deferred length, whose length gfortran 12 keeps there: such a function is called before the
!> threads begin, or by one at a time.
module vcor_sweep_sweep
   use vcor_error, only : error_input, error_internal, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_lasting, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver, only : check_settings, new_solver, solve_impact, solver_settings_t, solver_t
   use vcor_case_axes, only : new_grid
   use vcor_case_blueprint, only : blueprint_t, new_blueprint, place_of, place_t, solver_place
   use vcor_case_build, only : locate
   use vcor_case_case, only : case_t
   use vcor_case_grid, only : grid_t
   use vcor_interval, only : contains_number, interval_t
   use vcor_case_catalogue, only : catalogue, row_for_model, wanted
   use vcor_sweep_quantity, only : point_failed, point_invalid
   implicit none
   private

   public :: sweep_t, new_sweep, single_impact, worker_t, solve_point, lacking

   !> All impacts of a case; immutable once built, so that threads can share it
   type :: sweep_t
      !> Its points
      type(grid_t) :: grid
      !> What the impacts have in common
      type(blueprint_t), private :: blueprint
      !> Places of what varies, shape (axes)
      type(place_t), allocatable, private :: places(:)
      !> Ranges of what varies, shape (axes)
      type(interval_t), allocatable, private :: ranges(:)
      !> What to say about a value that is out of range, shape (axes)
      type(error_t), allocatable, private :: objections(:)
      !> The solver; not allocated where a setting of it varies
      class(solver_t), allocatable, private :: solver
   contains
      !> Whether the case has a &sweep group
      procedure :: is_grid
   end type sweep_t

   !> What one thread works with: the impact it is at
   type :: worker_t
      !> The impact
      type(impact_t) :: impact
      !> Its course
      type(trajectory_t) :: trajectory
      !> What the impact is built from
      type(blueprint_t), private :: blueprint
      !> Which value of each parameter is set in it, 0: none; allocated once it is ready, shape
      !> (axes)
      integer, allocatable, private :: places(:)
      !> The solver where it varies
      class(solver_t), allocatable, private :: solver
      !> Settings that this solver was made with
      type(solver_settings_t), private :: settings
   end type worker_t

contains

   !> Whether the case has a &sweep group
   pure function is_grid(self) result(yes)
      !> The sweep
      class(sweep_t), intent(in) :: self
      !> Whether it has
      logical :: yes

      yes = size(self%grid%axes) > 0
   end function is_grid

   !> Build what the impacts of a case have in common
   subroutine new_sweep(self, case, error)
      !> The sweep
      type(sweep_t), intent(out) :: self
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(place_t) :: cause
      integer :: i, n, group, row, item

      call new_grid(case, self%grid, error)
      if (allocated(error)) return
      n = size(self%grid%axes)
      allocate (self%places(n), self%ranges(n), self%objections(n))
      do i = 1, size(self%places)
         associate (handle => self%grid%axes(i)%handle)
            self%places(i) = place_of(case, handle)
            call case%locate(handle, group, row, item)
            row = row_for_model(row, case%model(group, item))
            self%ranges(i) = catalogue(row)%range
            self%objections(i)%message = self%grid%axes(i)%name//' is out of range, expected ' &
               //wanted(catalogue(row))
         end associate
      end do
      call new_blueprint(self%blueprint, case, self%places, error, cause)
      if (.not. allocated(error) .and. .not. any(self%places%group == 'solver')) then
         cause = solver_place(self%blueprint%settings)
         call new_solver(self%solver, self%blueprint%settings, error)
      end if
      if (allocated(error)) call locate(case, cause, error)
   end subroutine new_sweep

   !> The impact of a case without a sweep, to see whether there is one
   subroutine single_impact(self, case, impact, error)
      !> Its sweep, of one point
      type(sweep_t), intent(in) :: self
      !> The case
      type(case_t), intent(in) :: case
      !> The impact
      type(impact_t), intent(out) :: impact
      !> Error of code `error_input` that says where in the case its cause stands, unallocated on
      !> success
      type(error_t), allocatable, intent(out) :: error

      type(worker_t) :: worker
      type(place_t) :: cause

      call build_point(self, 1, worker, error, cause)
      if (.not. allocated(error)) then
         impact = worker%impact
      else
         call locate(case, cause, error)
      end if
   end subroutine single_impact

   !> Solve one point
   subroutine solve_point(self, point, worker, outcome, error)
      !> The sweep
      type(sweep_t), intent(in) :: self
      !> Number of the point, from 1
      integer, intent(in) :: point
      !> Impact and trajectory of the point; begins as a new one and may be used again for others
      type(worker_t), intent(inout) :: worker
      !> Its outcome; without numbers on failure
      type(outcome_t), intent(out) :: outcome
      !> Error of code `error_input` if the parameters describe no impact that can be solved, or of
      !> another if the solution fails; unallocated on success, with or without a separation
      type(error_t), allocatable, intent(out) :: error

      type(place_t) :: cause

      call build_point(self, point, worker, error, cause)
      if (allocated(error)) then
         continue
      else if (allocated(self%solver)) then
         call solve_impact(self%solver, worker%impact, worker%trajectory, outcome, error)
      else
         call prepare_solver(worker, error)
         if (.not. allocated(error)) &
            call solve_impact(worker%solver, worker%impact, worker%trajectory, outcome, error)
      end if
      if (.not. allocated(error)) return
      outcome%status = point_failed
      if (error%code == error_input) outcome%status = point_invalid
   end subroutine solve_point

   !> Build the impact of a point
   subroutine build_point(self, point, worker, error, cause)
      !> The sweep
      type(sweep_t), intent(in) :: self
      !> Number of the point
      integer, intent(in) :: point
      !> Its impact is built
      type(worker_t), intent(inout) :: worker
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> What in the case the error is about
      type(place_t), intent(out) :: cause

      real(wp) :: value
      integer :: i, place(size(self%grid%axes))
      logical :: is_taken

      if (.not. allocated(worker%places)) then
         worker%blueprint = self%blueprint
         allocate (worker%places(size(place)), source=0)
      end if
      place = self%grid%places(point)
      do i = 1, size(place)
         if (worker%places(i) == place(i)) cycle
         value = self%grid%axes(i)%values(place(i))
         if (.not. contains_number(self%ranges(i), value)) then
            cause = self%places(i)
            call raise(error, error_input, self%objections(i)%message)
            return
         end if
         call worker%blueprint%set(self%places(i), value, is_taken)
         if (.not. is_taken) then
            call raise(error, error_internal, 'what is swept is not read')
            return
         end if
         worker%places(i) = place(i)
      end do
      call worker%blueprint%build(worker%impact, error, cause)
      if (allocated(error)) return
      call check_settings(worker%blueprint%settings, worker%impact, error)
      if (allocated(error)) cause = solver_place(worker%blueprint%settings)
   end subroutine build_point

   !> Build the solver anew if its settings have changed
   subroutine prepare_solver(worker, error)
      !> What one thread works with, its blueprint set
      type(worker_t), intent(inout) :: worker
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      associate (old => worker%settings, new => worker%blueprint%settings)
         if (allocated(worker%solver)) then
            if (all(abs([old%time_step, old%end_time, old%accuracy, old%second_coefficient] &
               - [new%time_step, new%end_time, new%accuracy, new%second_coefficient]) &
               <= 0.0_wp)) return
         end if
         old = new
         call new_solver(worker%solver, new, error)
      end associate
   end subroutine prepare_solver

   !> Why an impact has no coefficient of restitution
   pure function lacking(status) result(reason)
      !> Status of its outcome
      integer, intent(in) :: status
      !> In words
      character(len=:), allocatable :: reason

      select case (status)
      case (contact_lasting)
         reason = 'the bodies do not separate within solver.end_time'
      case (contact_sticking)
         reason = 'the sphere sticks: all motion dies out in contact'
      case default
         reason = 'no result'
      end select
   end function lacking

end module vcor_sweep_sweep
