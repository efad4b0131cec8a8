!> What the choice of the mechanics is worth: one case with every plate model and both contact laws
module vcor_verify_models
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_solver, only : solve_impact
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : validate
   use vcor_case_problem, only : problem_of_case, problem_t
   implicit none
   private

   public :: model_t, solve_models

   !> Plate models, in the order of the table
   character(len=*), parameter :: plates(5) = [character(len=10) :: 'none', 'constant', &
      'relaxing', 'frozen', 'hereditary']
   !> Contact laws
   character(len=*), parameter :: laws(2) = [character(len=9) :: 'boltzmann', 'receding']

   !> The case with one plate model and one contact law
   type :: model_t
      !> Plate model
      character(len=10) :: waves = ''
      !> Contact law
      character(len=9) :: law = ''
      !> Whether it is that of the case
      logical :: given = .false.
      !> Why there is no outcome, one line; unallocated if there is one
      character(len=:), allocatable :: failure
      !> Outcome
      type(outcome_t) :: outcome
   end type model_t

contains

   !> Solve a case with every plate model and both contact laws, by the internal variables. A plate
   !> without half thickness or density has the model `none` only
   subroutine solve_models(case, models)
      !> A validated case
      type(case_t), intent(in) :: case
      !> The table
      type(model_t), allocatable, intent(out) :: models(:)

      type(model_t) :: all(size(plates)*size(laws))
      type(case_t) :: other
      type(error_t), allocatable :: error
      character(len=:), allocatable :: waves, law
      integer :: i, j, n

      call case%get('plate', 'waves', waves)
      call case%get('contact', 'law', law)
      n = 0
      do i = 1, size(plates)
         do j = 1, size(laws)
            other = case
            call other%set(other%address('plate', 'waves'), trim(plates(i)), given=.false.)
            call other%set(other%address('contact', 'law'), trim(laws(j)), given=.false.)
            call other%set(other%address('solver', 'method'), 'auto', given=.false.)
            call other%set(other%address('solver', 'scheme'), 'product', given=.false.)
            call other%unset(other%address('solver', 'continue_after_separation'))
            call validate(other, error)
            if (allocated(error) .and. plates(i) /= waves .and. j == 1 &
                .and. .not. case%given('plate', 'half_thickness')) exit
            n = n + 1
            all(n)%waves = plates(i)
            all(n)%law = laws(j)
            all(n)%given = plates(i) == waves .and. laws(j) == law
            if (allocated(error)) then
               all(n)%failure = error%message
            else
               call solve(other, all(n))
            end if
         end do
      end do
      allocate (models, source=all(:n))
   end subroutine solve_models

   !> Solve one case
   subroutine solve(case, model)
      !> The case
      type(case_t), intent(in) :: case
      !> Its row, outcome or failure to be set
      type(model_t), intent(inout) :: model

      type(problem_t) :: problem
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      call problem_of_case(problem, case, error)
      if (.not. allocated(error)) call solve_impact(problem%solver, problem%impact, trajectory, &
         model%outcome, error)
      if (allocated(error)) model%failure = error%message
   end subroutine solve

end module vcor_verify_models
