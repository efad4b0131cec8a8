!> Common part of all solvers: settings, abstract type, and the evaluation of an impact with the
!> check of its accuracy
module vcor_solver_type
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_resting, contact_separated, trajectory_t
   use vcor_kinds, only : pi, wp
   use vcor_solver_features, only : features, method_in_use, method_table, methods, of_body, &
      of_bounces, of_frozen_plate, of_ghost, of_gravity, of_hereditary_plate, of_layer, &
      of_paper_scheme, of_receding, of_relaxing_plate, of_second_term, of_structure, &
      of_thin_plate, of_viscosity, paper, why_unread
   implicit none
   private

   public :: solver_t, solver_settings_t, solve_impact, default_accuracy, features_of, &
      light_plate, as_text

   !> Length of the longest name in the settings
   integer, parameter :: longest_name = len('adams_bashforth')

   !> Settings of a solution
   type :: solver_settings_t
      !> One of `method_choices` of `vcor_solver_features`
      character(len=longest_name) :: method = 'auto'
      !> Scheme of the direct method: product or adams_bashforth
      character(len=longest_name) :: scheme = 'product'
      !> adams_bashforth: form of Eq. (8), a or b
      character(len=longest_name) :: form = 'a'
      !> adams_bashforth: rule of the sums, rectangle or trapezoid
      character(len=longest_name) :: quadrature = 'trapezoid'
      !> Time step of the direct method [s]; 0: chosen from the accuracy
      real(wp) :: time_step = 0.0_wp
      !> End of the computation [s]; 0: chosen from the time scale of the contact
      real(wp) :: end_time = 0.0_wp
      !> Wanted accuracy of the coefficient of restitution [-]; 0: the default of the method
      real(wp) :: accuracy = 0.0_wp
      !> Coefficient c2 of the second term of the Volterra series, Eq. (10) [m^-1.5]; 0: without it
      real(wp) :: second_coefficient = 0.0_wp
      !> End at the first separation from a structure, whether or not it is the last
      logical :: first_contact = .false.
      !> Continue after the separation, to `end_time` or to twice the contact time
      logical :: ghost = .false.
      !> Number of bounces under the weight to follow
      integer :: bounces = 1
   end type solver_settings_t

   !> A method of solution. It may keep what it computes for similar impacts, which changes no
   !> result: each thread has its own copy
   type, abstract :: solver_t
      !> Settings with which it was built
      type(solver_settings_t) :: settings
   contains
      !> Compute the course of an impact
      procedure(solve_i), deferred :: solve
   end type solver_t

   abstract interface
      !> Compute the course of an impact
      subroutine solve_i(self, impact, trajectory, error)
         import :: error_t, impact_t, solver_t, trajectory_t
         class(solver_t), intent(inout) :: self
         type(impact_t), intent(in) :: impact
         !> Course of the impact; one that does not end in separation is a status, not an error
         type(trajectory_t), intent(out) :: trajectory
         type(error_t), allocatable, intent(out) :: error
      end subroutine solve_i
   end interface

contains

   !> Features of an impact and of the settings of its solution, without the method
   pure function features_of(settings, impact) result(has)
      type(solver_settings_t), intent(in) :: settings
      !> Absent: those of the settings only
      type(impact_t), intent(in), optional :: impact
      logical :: has(size(features))

      has = .false.
      has(of_second_term) = abs(settings%second_coefficient) > 0.0_wp
      has(of_ghost) = settings%ghost
      has(of_bounces) = settings%bounces > 1
      has(of_paper_scheme) = settings%scheme /= 'product'
      if (.not. present(impact)) return
      has(of_body) = impact%face%has_waves
      has(of_thin_plate) = impact%target%moves()
      has(of_hereditary_plate) = impact%target%hereditary()
      has(of_frozen_plate) = impact%target%frozen()
      has(of_relaxing_plate) = impact%target%varies() .and. .not. impact%target%frozen()
      has(of_structure) = impact%target%structure%exists()
      has(of_layer) = impact%law%is_of_layer()
      has(of_receding) = impact%law%receding
      has(of_viscosity) = impact%kernel_viscosity() > 0.0_wp
      has(of_gravity) = impact%gravity > 0.0_wp
   end function features_of

   !> Accuracy of the coefficient of restitution if none is requested
   pure function default_accuracy(method) result(accuracy)
      !> Its name in `methods` of `vcor_solver_features`
      character(len=*), intent(in) :: method
      !> Accuracy [-]
      real(wp) :: accuracy

      accuracy = method_table(findloc(methods == method, .true., dim=1))%accuracy
   end function default_accuracy

   !> Solve an impact, and compare its estimated error with the requested accuracy, only here
   subroutine solve_impact(solver, impact, trajectory, outcome, error)
      class(solver_t), intent(inout) :: solver
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(inout) :: trajectory
      !> Outcome; without separation it has only a status
      type(outcome_t), intent(out) :: outcome
      !> Error of code `error_numerical` if the solution fails, is far from the requested accuracy
      !> or overflows; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: advice(2) = [character(len=59) :: &
         'give a larger solver.accuracy', &
         'give a larger solver.accuracy or a shorter solver.time_step']
      character(len=*), parameter :: fault(2) = [character(len=45) :: &
         'makes the force fall as the indentation grows', 'keeps the force from returning to zero']
      character(len=9) :: depth(2)
      real(wp) :: ratio, scale

      call solver%solve(impact, trajectory, error)
      if (.not. allocated(error)) then
         outcome = evaluate(impact, trajectory)
         if (outcome%status == contact_resting &
             .and. .not. abs(solver%settings%second_coefficient) > 0.0_wp) &
            call outcome%come_to_rest(impact)
         if (all(outcome%status /= [contact_separated, contact_resting])) return
         if (trajectory%returns .and. .not. solver%settings%first_contact) then
            call raise(error, error_numerical, 'the structure strikes the sphere again after the ' &
               //"first separation, or may, which method = 'ive' does not follow: use method = " &
               //"'auto'")
            return
         end if
         if (outcome%max_indentation > impact%law%deepest()) then
            write (depth, '(es9.2)') [outcome%max_indentation, impact%law%deepest()]
            call raise(error, error_numerical, 'the contact becomes wider than its law is known ' &
               //'for: found an indentation of '//trim(adjustl(depth(1)))//' m, expected at ' &
               //'most '//trim(adjustl(depth(2)))//' m, where the radius of the contact is 20 ' &
               //'times the thickness of a layer on a base or 0.85 times the radius of a true ' &
               //'sphere; take a slower impact')
            return
         end if
         if (outcome%status == contact_resting) return
         if (.not. outcome%is_finite()) then
            call raise(error, error_numerical, 'the numbers of this impact are out of the ' &
               //'range that can be computed')
         else if (trajectory%misses_by_far()) then
            call raise(error, error_numerical, 'the estimated error of cor, ' &
               //as_text(max(outcome%cor_error, outcome%cor_sphere_error)) &
               //', is more than a hundred times the accuracy asked for, ' &
               //as_text(outcome%accuracy) &
               //': '//trim(advice(merge(2, 1, takes_step(solver%settings, impact)))))
         end if
      end if
      if (.not. allocated(error)) return
      if (error%code /= error_numerical) return
      scale = impact%time_scale()
      ratio = solver%settings%second_coefficient &
         *impact%law%u(impact%law%depth*impact%speed_scale(scale)*scale)
      ! the force u + c2 u^2 falls beyond u = -1/(2 c2); q (c2 q - 1), left at u = 0, is a push if
      ! the internal variable q exceeds 1/c2
      if (ratio < -0.5_wp .or. ratio > 1.0_wp) call raise(error, error_numerical, 'the second ' &
         //'term of the Volterra series, about '//as_text(abs(ratio))//' times the first, ' &
         //trim(fault(merge(1, 2, ratio < 0.0_wp)))//': give a solver.volterra_coefficient ' &
         //'nearer to 0')
      if (light_plate(impact) /= '') then
         error%message = error%message//'; '//trim(light_plate(impact))
      else if (any(solver%settings%method == ['ive   ', 'direct']) &
               .and. solver%settings%scheme == 'product') then
         ! the only advice about methods: it ends there, as auto has no other one to go to; it
         ! refuses a time step
         error%message = error%message//"; method = 'auto'"
         if (solver%settings%time_step > 0.0_wp) &
            error%message = error%message//' without solver.time_step'
         error%message = error%message//' tries the other method, too'
      end if
   end subroutine solve_impact

   !> Whether the time step of the settings, or the paper's, is that of the solution
   pure function takes_step(settings, impact) result(takes)
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      logical :: takes

      logical :: has(size(features))
      integer :: method

      has = features_of(settings, impact)
      method = method_in_use(settings%method, settings%scheme, has)
      takes = why_unread('solver', 'time_step', method, has) == ''
      if (takes .and. method /= paper) takes = settings%time_step > 0.0_wp
   end function takes_step

   !> Why a plate that is too light for the sphere has no rebound, or next to none, whatever the
   !> time: an elastic one leaves 0.68/lambda^5 of the velocity if lambda > 3, at most 3e-3
   pure function light_plate(impact) result(text)
      type(impact_t), intent(in) :: impact
      !> In words, with lambda by the storage moduli at pi/(elastic contact time); blank if the
      !> plate is not light. Of fixed length, see `as_text`
      character(len=320) :: text

      ! the share of elastic impacts, computed: 0.6793 for lambda = 3 to 15, 0.678 for 2.4
      real(wp), parameter :: light = 3.0_wp, share = 0.68_wp
      real(wp) :: lambda

      text = ''
      lambda = impact%inelasticity_at(pi/(impact%law%contact_time*impact%time_scale()))
      if (.not. lambda > light) return
      text = 'the plate is too light: with an inelasticity lambda of '//as_text(lambda) &
         //' by the storage modulus it absorbs the impact, and about 0.68/lambda^5 = ' &
         //as_text(share/lambda**5)//' of the velocity remains; take a larger ' &
         //'plate.half_thickness or a lighter sphere, or give plate.base if it lies on a floor'
   end function light_plate

   !> A number as text of fixed length: gfortran 12 keeps the length of a deferred-length function
   !> result in static storage, where threads collide
   pure function as_text(number) result(text)
      !> The number, > 0
      real(wp), intent(in) :: number
      !> Text such as 1.0E-08
      character(len=7) :: text

      write (text, '(es7.1)') number
   end function as_text

end module vcor_solver_type
