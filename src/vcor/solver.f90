!> Factory of solvers by the name of their method, and the method `auto`
module vcor_solver
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_numerical, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_lasting, contact_separated, trajectory_t
   use vcor_kinds, only : coarsest_accuracy, finest_accuracy, wp
   use vcor_solver_coupled, only : coupled_t, new_coupled
   use vcor_solver_direct_product, only : new_product, product_t
   use vcor_solver_features, only : coupled, direct, features, method_choices, method_for, &
      method_in_use, refuse_features
   use vcor_solver_ive, only : ive_t, new_ive
   use vcor_solver_paper_adams_bashforth, only : adams_bashforth_t, new_adams_bashforth
   use vcor_solver_type, only : default_accuracy, features_of, solve_by => solve_impact, &
      solver_settings_t, solver_t
   use vcor_words, only : join_words
   implicit none
   private

   public :: solver_t, solver_settings_t, new_solver, solve_impact, check_settings, method_for
   public :: default_accuracy, settle

   !> The method `auto`: that which the table of `vcor_solver_features` gives for the impact; where
   !> it is internal variables, also product integration if they fail, or if a structure strikes
   !> again after the first separation. They fail if no sum of exponentials represents the kernel:
   !> for a table whose data begin long after the end of the contact, for some pairs, and for
   !> exponents near a limit; and if a receding contact grows again
   type, extends(solver_t) :: auto_t
      !> Method for waves in a plate of any thickness
      type(coupled_t), allocatable :: coupled
      !> First method for all others
      type(ive_t) :: ive
      !> Method for what internal variables do not solve, with the time step of the settings
      type(product_t) :: product
      !> Method if the first has no result, or one far from the requested accuracy; it chooses its
      !> steps, since a time step is for the method in use
      type(product_t) :: fallback
   contains
      procedure :: solve => solve_by_what_works
   end type auto_t

   !> Solve an impact with a given solver, or with settings, by default those of a case without
   !> &solver
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

   !> Check that an impact can be solved with the given settings; the solver itself is the same for
   !> all impacts
   subroutine check_settings(settings, impact, error)
      !> Settings of the solution
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      logical :: has(size(features))
      integer :: method

      call check_numbers(settings, error)
      if (allocated(error)) return
      has = features_of(settings, impact)
      method = method_in_use(settings%method, settings%scheme, has)
      has(method) = .true.
      if (method == coupled .and. .not. impact%face%is_built()) then
         call raise(error, error_input, "method = 'coupled' needs the face of the impact: " &
            //'new_face builds it', 'method')
      else
         call refuse_features(has, error)
      end if
      ! what no weight helps is refused first
      if (.not. allocated(error) .and. settings%bounces > 1 .and. .not. impact%gravity > 0.0_wp) &
         call raise(error, error_input, 'the sphere comes back under its weight only: expected ' &
         //'gravity > 0, or bounces = 1', 'bounces gravity')
   end subroutine check_settings

   !> Check the numbers among the settings
   subroutine check_numbers(settings, error)
      type(solver_settings_t), intent(in) :: settings
      !> Error of code `error_input`
      type(error_t), allocatable, intent(out) :: error

      if (.not. all(ieee_is_finite([settings%time_step, settings%end_time, settings%accuracy, &
          settings%second_coefficient]))) then
         call raise(error, error_input, 'the settings of a computation must be numbers', &
            'time_step end_time accuracy volterra_coefficient')
      else if (min(settings%time_step, settings%end_time, settings%accuracy) < 0.0_wp) then
         call raise(error, error_input, 'time_step, end_time and accuracy must not be negative', &
            'time_step end_time accuracy')
      else if (settings%accuracy > 0.0_wp .and. (settings%accuracy < finest_accuracy &
               .or. settings%accuracy > coarsest_accuracy)) then
         call raise(error, error_input, 'expected an accuracy in [1e-11, 0.1]', 'accuracy')
      else if (settings%time_step > 0.0_wp .and. settings%end_time > 0.0_wp &
         .and. .not. settings%time_step < settings%end_time) then
         call raise(error, error_input, 'a computation needs time_step < end_time', &
            'time_step end_time')
      end if
   end subroutine check_numbers

   !> Solve an impact with given settings, by default by the method `auto`
   subroutine solve_in_short(impact, outcome, error, settings, trajectory)
      type(impact_t), intent(in) :: impact
      !> Outcome; without separation it has only a status
      type(outcome_t), intent(out) :: outcome
      !> Error of code `error_input` if the settings do not suit the impact, `error_numerical` if
      !> the solution fails or is far from the requested accuracy; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Settings of the solution; absent: all defaults
      type(solver_settings_t), intent(in), optional :: settings
      !> Course of the impact
      type(trajectory_t), intent(out), optional :: trajectory

      class(solver_t), allocatable :: solver
      type(solver_settings_t) :: wanted
      type(trajectory_t) :: course

      if (.not. impact%modulus%is_built()) then
         call raise(error, error_input, 'the impact is empty: new_impact has not built it')
         return
      end if
      if (present(settings)) wanted = settings
      call new_solver(solver, wanted, impact, error)
      if (.not. allocated(error)) call solve_by(solver, impact, course, outcome, error)
      if (present(trajectory)) trajectory = course
   end subroutine solve_in_short

   !> Keep the mesh that suits an impact for all that are solved later, whose results then follow
   !> their numbers steadily, as differences need it. Only method coupled has one
   subroutine settle(solver, impact, error)
      class(solver_t), intent(inout) :: solver
      type(impact_t), intent(in) :: impact
      !> Why the impact has no result; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      select type (solver)
      type is (coupled_t)
         call solver%settle(impact, error)
      type is (auto_t)
         if (impact%face%has_waves) call solver%coupled%settle(impact, error)
      end select
   end subroutine settle

   !> Build a solver for an impact
   subroutine new_solver_for_impact(solver, settings, impact, error)
      !> The solver; not allocated on failure
      class(solver_t), allocatable, intent(out) :: solver
      !> Settings of the solution
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      type(error_t), allocatable, intent(out) :: error

      call check_settings(settings, impact, error)
      if (.not. allocated(error)) call new_solver_for_all(solver, settings, error)
   end subroutine new_solver_for_impact

   !> Build a solver for any impact that passes `check_settings`
   subroutine new_solver_for_all(solver, settings, error)
      !> The solver; not allocated on failure
      class(solver_t), allocatable, intent(out) :: solver
      !> Settings of the solution
      type(solver_settings_t), intent(in) :: settings
      type(error_t), allocatable, intent(out) :: error

      type(auto_t), allocatable :: auto
      type(coupled_t), allocatable :: coupled
      type(ive_t), allocatable :: ive
      type(product_t), allocatable :: product
      type(adams_bashforth_t), allocatable :: adams_bashforth
      type(solver_settings_t) :: fallback, first

      call check_numbers(settings, error)
      if (allocated(error)) return
      if (settings%method == 'ive') then
         allocate (ive)
         call new_ive(ive, settings, error)
         if (.not. allocated(error)) call move_alloc(ive, solver)
      else if (settings%method == 'coupled') then
         allocate (coupled)
         call new_coupled(coupled, settings)
         call move_alloc(coupled, solver)
      else if (settings%method == 'auto' .and. settings%scheme == 'product') then
         allocate (auto)
         ! the paper's variants go to the other method
         first = settings
         first%second_coefficient = 0.0_wp
         first%ghost = .false.
         first%bounces = 1
         call new_ive(auto%ive, first, error)
         if (allocated(error)) return
         auto%settings = settings
         call new_product(auto%product, settings)
         fallback = settings
         fallback%time_step = 0.0_wp
         call new_product(auto%fallback, fallback)
         allocate (auto%coupled)
         call new_coupled(auto%coupled, settings)
         call move_alloc(auto, solver)
      else if (settings%method /= 'direct' .and. settings%method /= 'auto') then
         call raise(error, error_input, "unknown method '"//trim(settings%method) &
            //"'; known: "//join_words(method_choices))
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

   !> Compute the course of an impact
   subroutine solve_by_what_works(self, impact, trajectory, error)
      class(auto_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      type(error_t), allocatable :: failure
      integer :: method

      method = method_in_use('auto', 'product', features_of(self%settings, impact))
      if (method == coupled) then
         call self%coupled%solve(impact, trajectory, error)
         return
      else if (method == direct) then
         call self%product%solve(impact, trajectory, error)
         return
      end if
      call self%ive%solve(impact, trajectory, error)
      if (allocated(error)) then
         if (error%code /= error_numerical) return
         call move_alloc(error, failure)
      else if (trajectory%status /= contact_separated &
               .or. .not. (trajectory%misses_by_far() .or. trajectory%returns)) then
         return
      end if
      call self%fallback%solve(impact, trajectory, error)
      if (.not. allocated(failure)) return
      if (allocated(error)) return
      ! running out of steps says nothing about a contact without a given end; on a structure the
      ! time has run out
      if (trajectory%status == contact_lasting .and. &
          .not. impact%target%structure%exists() .and. &
          .not. self%fallback%settings%end_time > 0.0_wp) call move_alloc(failure, error)
   end subroutine solve_by_what_works

end module vcor_solver
