!> Solvers by the name of their method
module vcor_solver
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver_auto, only : auto_t
   use vcor_solver_ive, only : ive_t, new_ive
   use vcor_solver_marching, only : marching_t, new_marching
   use vcor_solver_product, only : new_product, product_t
   use vcor_solver_solution, only : solve_by => solve_impact
   use vcor_solver_type, only : solver_t
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

   !> Letters of the longest name of a method
   integer, parameter :: longest_method = len('direct')
   !> Letters of the longest name in the settings
   integer, parameter :: longest_name = len('adams_bashforth')

   !> How an impact is to be solved
   type :: solver_settings_t
      !> One of auto, ive, direct
      character(len=longest_name) :: method = 'auto'
      !> Scheme of the direct method: product or adams_bashforth
      character(len=longest_name) :: scheme = 'product'
      !> adams_bashforth: form of Eq. (8), a or b
      character(len=longest_name) :: form = 'a'
      !> adams_bashforth: sums, rectangle or trapezoid
      character(len=longest_name) :: quadrature = 'trapezoid'
      !> Time step of the direct method [s]; 0: follows from the accuracy
      real(wp) :: time_step = 0.0_wp
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp) :: end_time = 0.0_wp
      !> Wanted accuracy of the coefficient of restitution [-]; 0: that of the method
      real(wp) :: accuracy = 0.0_wp
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5]; 0: without it
      real(wp) :: second_coefficient = 0.0_wp
      !> Go on after the separation
      logical :: ghost = .false.
   end type solver_settings_t

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

   !> The method: `auto` is ive, which hands over to direct where it fails, but direct where a
   !> scheme other than product is asked for
   pure function method_for(method, scheme) result(name)
      !> What the user asks for: auto, ive or direct
      character(len=*), intent(in) :: method
      !> Scheme of the direct method that the user asks for
      character(len=*), intent(in) :: scheme
      !> ive or direct
      character(len=:), allocatable :: name

      character(len=longest_method) :: found

      call find_method(method, scheme, found)
      name = trim(found)
   end function method_for

   !> The same without a text of deferred length: gfortran 12 keeps the length of one that a
   !> function returns in static storage, where threads collide
   pure subroutine find_method(method, scheme, name)
      !> What the user asks for: auto, ive or direct
      character(len=*), intent(in) :: method
      !> Scheme of the direct method that the user asks for
      character(len=*), intent(in) :: scheme
      !> ive or direct
      character(len=longest_method), intent(out) :: name

      name = method
      if (method /= 'auto') return
      name = 'direct'
      if (scheme == 'product') name = 'ive'
   end subroutine find_method

   !> Accuracy of the coefficient of restitution where none is asked for
   pure function default_accuracy(method) result(accuracy)
      !> ive or direct
      character(len=*), intent(in) :: method
      !> Accuracy [-]
      real(wp) :: accuracy

      accuracy = 1.0e-6_wp
      if (method == 'ive') accuracy = 1.0e-8_wp
   end function default_accuracy

   !> Check that an impact can be solved as it is to be; the solver itself is the same for all of
   !> them
   subroutine check_settings(settings, impact, error)
      !> How the impact is to be solved
      type(solver_settings_t), intent(in) :: settings
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (settings%time_step > 0.0_wp .and. settings%end_time > 0.0_wp &
         .and. .not. settings%time_step < settings%end_time) then
         call raise(error, error_input, 'solver.time_step must be below solver.end_time')
      else if (impact%kernel_viscosity() > 0.0_wp) then
         if (abs(settings%second_coefficient) > 0.0_wp) then
            call raise(error, error_input, 'the second term of the Volterra series has no ' &
               //'meaning with a viscosity, whose kernel is a delta function')
         else if (impact%plate%frozen()) then
            call raise(error, error_input, "waves = 'frozen' is made for the paper's plates, " &
               //"without a viscosity; use waves = 'relaxing'")
         end if
      end if
      if (.not. allocated(error)) call check_mechanics(settings, impact, error)
   end subroutine check_settings

   !> Check that law and plate are those that the solver is made for
   subroutine check_mechanics(settings, impact, error)
      !> How the impact is to be solved
      type(solver_settings_t), intent(in) :: settings
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      logical :: papers_scheme

      papers_scheme = settings%scheme /= 'product'
      if (impact%law%receding) then
         if (abs(settings%second_coefficient) > 0.0_wp) then
            call raise(error, error_input, receding_without_second_term)
         else if (papers_scheme) then
            call raise(error, error_input, receding_without_papers_scheme)
         else if (settings%ghost) then
            call raise(error, error_input, receding_without_ghost)
         end if
      else if (impact%plate%hereditary() .and. papers_scheme) then
         call raise(error, error_input, hereditary_without_papers_scheme)
      end if
   end subroutine check_mechanics

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
      type(marching_t), allocatable :: marching
      character(len=longest_method) :: method
      real(wp) :: accuracy

      call find_method(settings%method, settings%scheme, method)
      select case (method)
      case ('ive')
         allocate (ive)
         call new_ive(ive, accuracy_for('ive'), settings%end_time, error, &
            settings%second_coefficient, settings%ghost)
         if (allocated(error)) return
         if (settings%method == 'auto') then
            allocate (auto)
            auto%ive = ive
            ! the time step is that of a method which the user has not asked for
            call new_product(auto%product, 0.0_wp, accuracy_for('direct'), settings%end_time, &
               settings%second_coefficient, settings%ghost)
            call move_alloc(auto, solver)
         else
            call move_alloc(ive, solver)
         end if
      case ('direct')
         select case (settings%scheme)
         case ('product')
            allocate (product)
            accuracy = accuracy_for('direct')
            if (settings%time_step > 0.0_wp) accuracy = settings%accuracy
            call new_product(product, settings%time_step, accuracy, settings%end_time, &
               settings%second_coefficient, settings%ghost)
            call move_alloc(product, solver)
         case ('adams_bashforth')
            allocate (marching)
            call new_marching(marching, settings%time_step, settings%end_time, &
               trim(settings%form), trim(settings%quadrature), error, settings%second_coefficient, &
               settings%ghost, settings%accuracy)
            if (.not. allocated(error)) call move_alloc(marching, solver)
         case default
            call raise(error, error_input, "unknown scheme '"//trim(settings%scheme) &
               //"'; known: product, adams_bashforth")
         end select
      case default
         call raise(error, error_input, "unknown method '"//trim(settings%method) &
            //"'; known: auto, ive, direct")
      end select

   contains

      !> The accuracy asked for, or that of a method
      pure function accuracy_for(name)
         !> ive or direct
         character(len=*), intent(in) :: name
         !> Accuracy [-]
         real(wp) :: accuracy_for

         accuracy_for = settings%accuracy
         if (.not. accuracy_for > 0.0_wp) accuracy_for = default_accuracy(name)
      end function accuracy_for
   end subroutine new_solver_for_all

end module vcor_solver
