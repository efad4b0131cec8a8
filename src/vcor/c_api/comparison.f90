!> The C interface: a case by all methods, and with exact mechanics; include/vcor.h documents the
!> functions
module vcor_c_api_comparison
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only : c_double, c_f_pointer, c_int, c_ptr
   use vcor_c_api_handle, only : build, handle_t, open_case
   use vcor_c_api_values, only : demand, get_array, report_error
   use vcor_case_case, only : case_t
   use vcor_case_entries, only : address_t
   use vcor_case_problem, only : problem_t
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_kinds, only : wp
   use vcor_verify_agreement, only : attempt_first, compared_names, comparison_t
   use vcor_verify_methods, only : compare
   use vcor_verify_models, only : model_t, solve_exact
   implicit none
   private

   public :: vcor_verify, vcor_exact

contains

   !> Solve the case by all methods
   function vcor_verify(self, results, error) bind(c) result(code)
      type(c_ptr), value :: self, results, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(case_t) :: case
      type(problem_t) :: problem
      type(comparison_t) :: comparison
      real(c_double), pointer :: table(:, :)
      integer :: i

      nullify (table)
      call open_case(self, handle, trouble)
      call demand(results, 'results', trouble)
      if (.not. allocated(trouble)) then
         call c_f_pointer(results, table, [4, size(compared_names)])
         table = ieee_value(1.0_wp, ieee_quiet_nan)
      end if
      if (.not. allocated(trouble)) call take_case(handle, case, problem, trouble)
      if (.not. allocated(trouble)) then
         call compare(case, problem, comparison, trouble)
         if (allocated(trouble)) trouble%message = case%source//': '//trouble%message
      end if
      if (.not. allocated(trouble)) then
         do i = 1, size(compared_names)
            if (.not. comparison%separated) exit
            associate (compared => comparison%compared(i))
               table(:, i) = [compared%best, compared%value(attempt_first), &
                  compared%direct%limit, real(compared%digits, wp)]
               if (.not. comparison%two_methods) table(2, i) = ieee_value(1.0_wp, ieee_quiet_nan)
            end associate
         end do
         if (allocated(comparison%objection)) call raise(trouble, error_numerical, &
            case%source//': '//comparison%objection)
      end if
      code = report_error(trouble, error)
   end function vcor_verify

   !> Solve the case with exact mechanics
   function vcor_exact(self, cor_sphere, error) bind(c) result(code)
      type(c_ptr), value :: self, cor_sphere, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(case_t) :: case
      type(problem_t) :: problem
      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      type(model_t) :: exact
      real(c_double), pointer :: place(:)
      logical :: differs

      call open_case(self, handle, trouble)
      call get_array(1_c_int, cor_sphere, 'cor_sphere', place, trouble)
      if (.not. allocated(trouble)) call take_case(handle, case, problem, trouble)
      if (.not. allocated(trouble)) then
         place = ieee_value(1.0_wp, ieee_quiet_nan)
         ! that the case has no result of its own does not matter
         call problem%solve(trajectory, outcome, trouble)
         if (allocated(trouble)) deallocate (trouble)
         call solve_exact(case, outcome, exact, differs)
         ! the mechanics of the case are exact
         if (exact%waves == '') exact%outcome = outcome
         place = exact%outcome%cor_sphere
      end if
      code = report_error(trouble, error)
   end function vcor_exact

   !> Copy a case and the problem of its impact, to solve them while others use the handle
   subroutine take_case(handle, case, problem, error)
      type(handle_t), intent(inout) :: handle
      type(case_t), intent(out) :: case
      type(problem_t), intent(out) :: problem
      type(error_t), allocatable, intent(out) :: error

      type(address_t) :: none(0)
      real(wp) :: nothing(0, 1)

!$omp critical (vcor_c_api)
      call build(handle, none, nothing, error)
      if (.not. allocated(error)) then
         case = handle%case
         problem = handle%sweep%problem
      end if
!$omp end critical (vcor_c_api)
   end subroutine take_case

end module vcor_c_api_comparison
