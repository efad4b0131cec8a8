!> Solvers by the name of their method
module vcor_solver
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver_auto, only : auto_t
   use vcor_solver_direct_product, only : new_product, product_t
   use vcor_solver_ive, only : ive_t, new_ive
   use vcor_solver_paper_adams_bashforth, only : adams_bashforth_t, new_adams_bashforth
   use vcor_solver_type, only : default_accuracy, method_for, solve_by => solve_impact, &
      solver_settings_t, solver_t
   implicit none
   private

   public :: solver_t, solver_settings_t, new_solver, solve_impact, check_settings, method_for
   public :: default_accuracy
   public :: receding_without_second_term, receding_without_papers_scheme, &
      receding_without_ghost, hereditary_without_papers_scheme

   !> Why the second term of the Volterra series does not go with receding contact
   character(len=*), parameter :: receding_without_second_term = &
      "law = 'receding' is exact for a force that is linear in u = s^1.5: the second term of the " &
      //"Volterra series (volterra_order = 2) has no meaning in it"
   !> Why the paper's scheme does not go with receding contact
   character(len=*), parameter :: receding_without_papers_scheme = &
      "scheme = 'adams_bashforth' sums the force over all the past, law = 'receding' does not: " &
      //"use method = 'ive', or 'direct' with scheme = 'product'"
   !> Why receding contact does not go on after the separation
   character(len=*), parameter :: receding_without_ghost = &
      "with law = 'receding' nothing is left of the contact at separation: " &
      //"continue_after_separation has no meaning"
   !> Why the paper's scheme does not go with the hereditary plate
   character(len=*), parameter :: hereditary_without_papers_scheme = &
      "scheme = 'adams_bashforth' differentiates U = alpha(t) I, which waves = 'hereditary' has " &
      //"not: use method = 'ive', or 'direct' with scheme = 'product'"

   !> Solve an impact: by a solver, or by the one that a case without &solver has
   interface solve_impact
      procedure :: solve_by
      module procedure solve_in_short
   end interface solve_impact

   !> Build a solver
   interface new_solver
      module procedure new_solver_for_impact
      module procedure new_solver_for_all
   end interface new_solver

contains

   !> Check that an impact can be solved as it is to be; the solver itself is the same for all of
   !> them
   subroutine check_settings(settings, impact, error)
      !> How the impact is to be solved
      type(solver_settings_t), intent(in) :: settings
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      logical :: two_terms

      two_terms = abs(settings%second_coefficient) > 0.0_wp
      if (settings%time_step > 0.0_wp .and. settings%end_time > 0.0_wp &
         .and. .not. settings%time_step < settings%end_time) then
         call raise(error, error_input, 'solver.time_step must be below solver.end_time')
      else if (impact%kernel_viscosity() > 0.0_wp .and. two_terms) then
         call raise(error, error_input, 'the second term of the Volterra series has no ' &
            //'meaning with a viscosity, whose kernel is a delta function')
      else if (impact%kernel_viscosity() > 0.0_wp .and. impact%plate%frozen()) then
         call raise(error, error_input, "waves = 'frozen' is made for the paper's plates, " &
            //"without a viscosity; use waves = 'relaxing'")
      else if (impact%law%receding .and. two_terms) then
         call raise(error, error_input, receding_without_second_term)
      else if (impact%law%receding .and. settings%scheme /= 'product') then
         call raise(error, error_input, receding_without_papers_scheme)
      else if (impact%law%receding .and. settings%ghost) then
         call raise(error, error_input, receding_without_ghost)
      else if (impact%plate%hereditary() .and. settings%scheme /= 'product') then
         call raise(error, error_input, hereditary_without_papers_scheme)
      end if
   end subroutine check_settings

   !> Solve an impact by the method auto, or as it is to be solved
   subroutine solve_in_short(impact, outcome, error, settings)
      type(impact_t), intent(in) :: impact
      !> Its outcome; one that is no separation has a status and no numbers
      type(outcome_t), intent(out) :: outcome
      !> Error of code `error_input` if the settings do not go with the impact, `error_numerical` if
      !> the solution fails or is far from the accuracy asked for; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> How it is to be solved; absent: all defaults
      type(solver_settings_t), intent(in), optional :: settings

      class(solver_t), allocatable :: solver
      type(solver_settings_t) :: wanted
      type(trajectory_t) :: trajectory

      if (present(settings)) wanted = settings
      call new_solver(solver, wanted, impact, error)
      if (.not. allocated(error)) call solve_by(solver, impact, trajectory, outcome, error)
   end subroutine solve_in_short

   !> Build a solver for an impact
   subroutine new_solver_for_impact(solver, settings, impact, error)
      !> The solver; not allocated on failure
      class(solver_t), allocatable, intent(out) :: solver
      !> How the impact is to be solved
      type(solver_settings_t), intent(in) :: settings
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      call check_settings(settings, impact, error)
      if (.not. allocated(error)) call new_solver_for_all(solver, settings, error)
   end subroutine new_solver_for_impact

   !> Build a solver for any impact that passes `check_settings`
   subroutine new_solver_for_all(solver, settings, error)
      !> The solver; not allocated on failure
      class(solver_t), allocatable, intent(out) :: solver
      !> How impacts are to be solved
      type(solver_settings_t), intent(in) :: settings
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(auto_t), allocatable :: auto
      type(ive_t), allocatable :: ive
      type(product_t), allocatable :: product
      type(adams_bashforth_t), allocatable :: adams_bashforth
      type(solver_settings_t) :: fallback
      real(wp) :: accuracy

      if (settings%method == 'ive' .or. &
          (settings%method == 'auto' .and. settings%scheme == 'product')) then
         accuracy = settings%accuracy
         if (.not. accuracy > 0.0_wp) accuracy = default_accuracy('ive')
         allocate (ive)
         call new_ive(ive, accuracy, settings%end_time, error, settings%second_coefficient, &
            settings%ghost)
         if (allocated(error)) return
         if (settings%method == 'ive') then
            call move_alloc(ive, solver)
         else
            allocate (auto)
            auto%ive = ive
            ! the time step is that of a method which the user has not asked for
            fallback = settings
            fallback%time_step = 0.0_wp
            call new_product(auto%product, fallback)
            call move_alloc(auto, solver)
         end if
      else if (settings%method /= 'direct' .and. settings%method /= 'auto') then
         call raise(error, error_input, "unknown method '"//trim(settings%method) &
            //"'; known: auto, ive, direct")
      else if (settings%scheme == 'product') then
         allocate (product)
         call new_product(product, settings)
         call move_alloc(product, solver)
      else if (settings%scheme == 'adams_bashforth') then
         allocate (adams_bashforth)
         call new_adams_bashforth(adams_bashforth, settings, error)
         if (.not. allocated(error)) call move_alloc(adams_bashforth, solver)
      else
         call raise(error, error_input, "unknown scheme '"//trim(settings%scheme) &
            //"'; known: product, adams_bashforth")
      end if
   end subroutine new_solver_for_all

end module vcor_solver
