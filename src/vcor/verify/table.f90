!> The verification table: laws of impact that need no reference, and independent numbers
!>
!> Which laws there are stands in `build_law`, what each one says and expects in the modules under
!> `verification/`. All rows are evaluated and judged in `verify_law`, here and nowhere else.
module vcor_verify_table
   use vcor_error, only : error_internal, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver, only : new_solver, solve_impact, solver_settings_t, solver_t
   use vcor_verify_elastic, only : hertz, zener
   use vcor_verify_golden, only : beyond, golden, printed
   use vcor_verify_kelvin_voigt, only : exact, pade, series, zener_relation
   use vcor_verify_memory, only : limits, mittag_leffler, &
      power_law, scaling, weak_maxwell
   use vcor_verify_row, only : accuracy_of, judge, law_t, row_t, verdict_t
   implicit none
   private

   public :: law_count, build_law, verify_law

   !> Number of laws
   integer, parameter :: law_count = 14

contains

   !> One of the laws
   subroutine build_law(number, law, error)
      !> Number, 1 .. `law_count`
      integer, intent(in) :: number
      !> The law
      type(law_t), intent(out) :: law
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      select case (number)
      case (1)
         call hertz(law)
      case (2)
         call zener(law)
      case (3)
         call series(law)
      case (4)
         call pade(law)
      case (5)
         call exact(law)
      case (6)
         call zener_relation(law)
      case (7)
         call weak_maxwell(law)
      case (8)
         call power_law(law)
      case (9)
         call mittag_leffler(law)
      case (10)
         call scaling(law)
      case (11)
         call limits(law)
      case (12)
         call golden(law)
      case (13)
         call beyond(law)
      case (law_count)
         call printed(law)
      case default
         call raise(error, error_internal, 'a law that does not exist')
      end select
      if (allocated(law%error)) call move_alloc(law%error, error)
   end subroutine build_law

   !> Solve the impacts of a law and judge its rows. An impact that fails or does not end leaves a
   !> NaN in its rows, which fail
   subroutine verify_law(law, verdicts)
      !> The law
      type(law_t), intent(in) :: law
      !> Verdicts in the order of the rows, shape (law%count)
      type(verdict_t), allocatable, intent(out) :: verdicts(:)

      type(outcome_t), allocatable :: outcomes(:)
      integer :: i

      allocate (verdicts(law%count), outcomes(0))
      do i = 1, law%count
         if (allocated(law%rows(i)%impacts)) call solve_row(law%rows(i), outcomes)
         verdicts(i) = judge(law%rows(i), outcomes)
      end do
   end subroutine verify_law

   !> Outcomes of the impacts of a row
   subroutine solve_row(row, outcomes)
      !> The row
      type(row_t), intent(in) :: row
      !> Outcomes in the order of the impacts; none if one of the impacts has none
      type(outcome_t), allocatable, intent(out) :: outcomes(:)

      type(outcome_t) :: outcome(size(row%impacts))
      logical :: separated
      integer :: i

      allocate (outcomes(0))
      do i = 1, size(row%impacts)
         call solve(row%impacts(i), row%method, outcome(i), separated)
         if (.not. separated) return
      end do
      outcomes = outcome
   end subroutine solve_row

   !> Solve one impact
   subroutine solve(impact, method, outcome, separated)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> ive or direct
      character(len=*), intent(in) :: method
      !> Its outcome
      type(outcome_t), intent(out) :: outcome
      !> Whether it ended without an error in separation
      logical, intent(out) :: separated

      type(solver_settings_t) :: settings
      class(solver_t), allocatable :: solver
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      settings%method = trim(method)
      settings%scheme = 'product'
      settings%accuracy = 0.5_wp*accuracy_of(method)
      call new_solver(solver, settings, impact, error)
      if (.not. allocated(error)) call solve_impact(solver, impact, trajectory, outcome, error)
      separated = .not. allocated(error)
      if (separated) separated = outcome%status == contact_separated
   end subroutine solve

end module vcor_verify_table
