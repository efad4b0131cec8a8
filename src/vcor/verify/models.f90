!> What the choice of the mechanics is worth: one case with every plate model and both contact laws
module vcor_verify_models
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_solver, only : new_solver, solve_impact, solver_settings_t, solver_t
   use vcor_case_build, only : build_impact
   use vcor_case_case, only : case_t
   use vcor_case_describe, only : describe_solver
   use vcor_case_store, only : entry_t
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
            call set(other, 'plate', 'waves', trim(plates(i)))
            call set(other, 'contact', 'law', trim(laws(j)))
            call set(other, 'solver', 'method', 'auto')
            call set(other, 'solver', 'scheme', 'product')
            call set(other, 'solver', 'continue_after_separation')
            call other%validate(error)
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

   !> Give a key a text, or false to a switch
   subroutine set(case, group, key, text)
      !> The case
      type(case_t), intent(inout) :: case
      !> Group
      character(len=*), intent(in) :: group
      !> Key
      character(len=*), intent(in) :: key
      !> The text; absent: false
      character(len=*), intent(in), optional :: text

      type(entry_t) :: entry

      if (present(text)) entry%text = text
      entry%flag = .false.
      entry%present = .true.
      call case%assign(case%handle(group, key), entry)
   end subroutine set

   !> Solve one case
   subroutine solve(case, model)
      !> The case
      type(case_t), intent(in) :: case
      !> Its row, outcome or failure to be set
      type(model_t), intent(inout) :: model

      type(solver_settings_t) :: settings
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      class(solver_t), allocatable :: solver
      type(error_t), allocatable :: error

      call describe_solver(case, settings)
      call build_impact(case, impact, error)
      if (.not. allocated(error)) call new_solver(solver, settings, impact, error)
      if (.not. allocated(error)) &
         call solve_impact(solver, impact, trajectory, model%outcome, error)
      if (allocated(error)) model%failure = error%message
   end subroutine solve

end module vcor_verify_models
