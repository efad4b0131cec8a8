!> Sweeps, the impacts of a case, one for each point of a grid. An impact by itself is a sweep of
!> one point
!>
!> A point is the case with some numbers set, which the problem of the case follows, so nothing is
!> read, looked up or checked as a whole for it, and no rules of a solver are made. Outcomes are
!> kept by the number of their point: they are the same bits for any number of threads. A point that
!> makes no sense, or cannot be solved, has a status instead of numbers and stops no other.
!>
!> What threads call has no static storage. That includes the functions that return a text of
!> deferred length, whose length gfortran 12 keeps there: such a function is called before the
!> threads begin, or by one at a time.
module vcor_sweep_sweep
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_lasting, contact_resting, contact_separated, &
      contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_case_case, only : case_t
   use vcor_case_grid, only : grid_t, new_grid
   use vcor_material_parameter, only : contains_number, interval_t
   use vcor_case_catalogue, only : catalogue, wanted
   use vcor_case_problem, only : has_part, problem_of_case, problem_t
   use vcor_sweep_quantity, only : point_failed, point_invalid
   implicit none
   private

   public :: sweep_t, new_sweep, worker_t, solve_point, lacking

   !> All impacts of a case; immutable once built, so that threads can share it
   type :: sweep_t
      !> Its points
      type(grid_t) :: grid
      !> The case; what varies has its first values
      type(case_t), private :: case
      !> Its problem
      type(problem_t) :: problem
      !> Ranges of what varies, shape (axes)
      type(interval_t), allocatable, private :: ranges(:)
      !> What to say about a value that is out of range, shape (axes)
      type(error_t), allocatable, private :: objections(:)
   contains
      procedure :: is_grid
   end type sweep_t

   !> What one thread works with: the impact it is at
   type :: worker_t
      !> The impact and its solver
      type(problem_t) :: problem
      !> Its course
      type(trajectory_t) :: trajectory
      !> The case with the numbers of the impact
      type(case_t), private :: case
      !> Whether case and problem are those of the sweep, at one of its points
      logical, private :: is_ready = .false.
   end type worker_t

contains

   !> Whether the case has a &sweep group
   pure function is_grid(self) result(yes)
      class(sweep_t), intent(in) :: self
      logical :: yes

      yes = size(self%grid%axes) > 0
   end function is_grid

   !> Build what the impacts of a case have in common
   subroutine new_sweep(self, case, error)
      type(sweep_t), intent(out) :: self
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, j, n, row

      call new_grid(case, self%grid, error)
      if (allocated(error)) return
      self%case = case
      n = size(self%grid%axes)
      allocate (self%ranges(n), self%objections(n))
      do i = 1, n
         row = case%row(self%grid%axes(i)%address)
         associate (axis => self%grid%axes(i), key => catalogue(row))
            self%ranges(i) = key%range
            self%objections(i)%message = axis%name//' is out of range, expected '//wanted(key)
            call self%case%oust(axis%address, always=.true.)
            do j = 1, size(axis%values)
               if (.not. contains_number(key%range, axis%values(j))) cycle
               call self%case%set(axis%address, axis%values(j))
               exit
            end do
         end associate
      end do
      call problem_of_case(self%problem, self%case, error)
      if (.not. allocated(error)) return
      ! what varies may be sound at other points
      do i = 1, n
         if (.not. has_part(self%case, self%grid%axes(i)%address, error)) cycle
         deallocate (error)
         return
      end do
   end subroutine new_sweep

   !> Solve one point
   subroutine solve_point(self, point, worker, outcome, error)
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

      call build_point(self, point, worker, error)
      if (.not. allocated(error)) call worker%problem%solve(worker%trajectory, &
         outcome, error)
      if (.not. allocated(error)) return
      outcome = outcome_t(status=merge(point_invalid, point_failed, error%code == error_input), &
         steps=outcome%steps)
   end subroutine solve_point

   !> Build the impact of a point
   subroutine build_point(self, point, worker, error)
      type(sweep_t), intent(in) :: self
      integer, intent(in) :: point
      !> Its impact is built
      type(worker_t), intent(inout) :: worker
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: value
      integer :: i, place(size(self%grid%axes))

      if (.not. worker%is_ready) then
         worker%case = self%case
         worker%problem = self%problem
         worker%is_ready = .true.
      end if
      place = self%grid%places(point)
      do i = 1, size(place)
         value = self%grid%axes(i)%values(place(i))
         if (.not. contains_number(self%ranges(i), value)) then
            call raise(error, error_input, self%objections(i)%message)
            return
         end if
         call worker%case%set(self%grid%axes(i)%address, value)
      end do
      call worker%problem%update(worker%case, error)
   end subroutine build_point

   !> Why an impact has no coefficient of restitution
   pure function lacking(status) result(reason)
      integer, intent(in) :: status
      !> In words; empty where it has one
      character(len=:), allocatable :: reason

      select case (status)
      case (contact_separated, contact_resting)
         reason = ''
      case (contact_lasting)
         reason = 'the bodies do not separate within solver.end_time'
      case (contact_sticking)
         reason = 'the sphere sticks: all motion dies out in contact'
      case default
         reason = 'no result'
      end select
   end function lacking

end module vcor_sweep_sweep
