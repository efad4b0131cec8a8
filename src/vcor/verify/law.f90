!> Laws of the verification table, and the judgement of their rows
!>
!> A law (Hertz's, Zener's ...) is a list of checks. A check has impacts, and rows that state the
!> expected value of a quantity of their outcomes, the tolerance and its reason. Two methods, ive
!> and direct, solve each check, or the coupled contact does, and its rows are judged for each
!> method. NaN fails.
!>
!> The impacts are of a sphere, rigid unless a law says otherwise, on a plate. The default ones are
!> those of Green's paper: a ball of 10 mm radius and 7800 kg/m3 on a plate of 20 mm half thickness,
!> 1100 kg/m3 and Poisson's ratio 0.5. Time scale and lambda are computed here independently of the
!> impact that the solvers see.
module vcor_verify_law
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_quiet_nan, ieee_value
   use vcor_error, only : error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus, pair_series
   use vcor_impact_face, only : base_free, face_t, new_face
   use vcor_impact_layer_law, only : lay, layer_t, profile_t
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_plate, only : new_plate, plate_t, waves_none
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_impact_trajectory, only : contact_separated
   use vcor_impact_response, only : base_bonded
   use vcor_kinds, only : pi, wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_solver, only : solve_impact, solver_settings_t
   use vcor_sweep_quantity, only : quantity_value
   implicit none
   private

   public :: row_t, law_t, verdict_t, judge, evaluate_law, others_follow
   public :: strike_t, time_scale, zener_plate, hertz_duration, elastic, sls, kelvin_voigt
   public :: density

   !> Reason of most tolerances of cor ...
   character(len=*), parameter :: as_asked = 'twice what the method is asked for'
   !> ... and of other quantities: the steps are chosen for cor, and the errors of the others are of
   !> the same order
   character(len=*), parameter :: others_follow = 'ten times the accuracy asked of cor'
   !> Methods that solve the impacts
   character(len=*), parameter :: methods(3) = [character(len=7) :: 'ive', 'direct', 'coupled']
   !> Accuracies that the methods must reach; half of these is requested. For ive half of it is the
   !> smallest value that the solver accepts, and the other half allows for rounding, about 5e-13
   !> per panel. For direct it is the default: below it the error estimate is too small if an
   !> elastic contact ends on a moving plate
   real(wp), parameter :: accuracies(3) = [2.0e-11_wp, 1.0e-6_wp, 2.0e-6_wp]

   !> Duration of Hertz's impact in units of T, (4/5) B(2/5, 1/2) (5/4)^(2/5) = 3.2180654597190435
   !> [-], independent of the constant that the solvers use
   real(wp), parameter :: hertz_duration = 0.8_wp*1.25_wp**0.4_wp &
      *gamma(0.4_wp)*gamma(0.5_wp)/gamma(0.9_wp)
   !> Density [kg/m3] and 1/(1 - nu^2) of the plates
   real(wp), parameter :: density = 1100.0_wp, plane_strain = 1.0_wp/(1.0_wp - 0.25_wp)

   !> A sphere strikes a plate
   type :: strike_t
      !> Material of the plate, of any model
      type(material_data_t) :: plate
      !> Material of the sphere, in series with the plate's; without a model: rigid
      type(material_data_t) :: sphere
      !> One of the `waves_*` constants
      integer :: waves = waves_none
      !> Whether the contact is receding
      logical :: receding = .false.
      !> Velocity [m/s]
      real(wp) :: velocity = 10.0_wp
      !> Mass of the sphere [kg]
      real(wp) :: mass = 4.0_wp/3.0_wp*pi*0.01_wp**3*7800.0_wp
      !> Radius of the sphere [m]
      real(wp) :: radius = 0.01_wp
      !> Half thickness of the plate [m]
      real(wp) :: half_thickness = 0.02_wp
      !> Thickness of a layer that is bonded to a rigid floor [m]; 0: a half space
      real(wp) :: layer = 0.0_wp
      !> Base of the plate if its face has waves, for the coupled contact
      integer :: base = base_free
   contains
      procedure :: get_impact
   end type strike_t

   abstract interface
      !> A number computed from the outcomes of a check, in the order of its impacts
      pure function measure_i(outcomes) result(value)
         import :: outcome_t, wp
         type(outcome_t), intent(in) :: outcomes(:)
         real(wp) :: value
      end function measure_i
   end interface

   !> Expected value of a quantity of the outcomes of a check
   type :: row_t
      character(len=40) :: name = ''
      !> Expected value
      real(wp) :: expected = 0.0_wp
      !> Largest deviation that passes, in the unit of the value: `times` the accuracy of the method
      !> plus `more`
      real(wp) :: times = 1.0_wp, more = 0.0_wp
      !> Reason of the tolerance
      character(len=100) :: reason = as_asked
      !> The value found: this quantity of this outcome, in this unit ...
      character(len=20) :: quantity = 'cor'
      integer :: subject = 1
      real(wp) :: unit = 1.0_wp
      !> ... or, if associated, this function of all outcomes
      procedure(measure_i), pointer, nopass :: measure => null()
      !> Outcome whose same quantity is expected instead of `expected`; 0: none ...
      integer :: twin = 0
      !> ... or, if associated, this function of all outcomes
      procedure(measure_i), pointer, nopass :: expectation => null()
   end type row_t

   !> Impacts and the rows about them; the first `count` rows are in use
   type :: check_t
      type(strike_t), allocatable :: strikes(:)
      !> First and last method that solve them, in `methods`
      integer :: first = 1, last = 2
      type(row_t) :: rows(6)
      integer :: count = 0
   end type check_t

   !> Checks from one source; the first `count` are in use
   type :: law_t
      !> What the law says and the source of its numbers, one line each
      character(len=:), allocatable :: title, source
      type(check_t), allocatable :: checks(:)
      integer :: count = 0
   contains
      procedure :: begin
      procedure :: add_check
      procedure :: add_row
   end type law_t

   !> Judgement of a row for one method
   type :: verdict_t
      character(len=40) :: name = ''
      character(len=7) :: method = ''
      character(len=100) :: reason = ''
      !> NaN if there is no value
      real(wp) :: expected = 0.0_wp, found = 0.0_wp, deviation = 0.0_wp
      real(wp) :: tolerance = 0.0_wp
      logical :: passed = .false.
   end type verdict_t

contains

   !> Begin a law
   subroutine begin(self, title, source)
      class(law_t), intent(out) :: self
      character(len=*), intent(in) :: title, source

      integer, parameter :: most_checks = 8

      self%title = title
      self%source = source
      allocate (self%checks(most_checks))
   end subroutine begin

   !> Begin a check: the rows that follow are about these impacts
   subroutine add_check(self, strikes, method)
      class(law_t), intent(inout) :: self
      type(strike_t), intent(in) :: strikes(:)
      !> Method that alone solves them; absent: ive and direct do
      character(len=*), intent(in), optional :: method

      self%count = self%count + 1
      allocate (self%checks(self%count)%strikes(size(strikes)))
      associate (check => self%checks(self%count))
         check%strikes(:) = strikes
         if (.not. present(method)) return
         check%first = findloc(methods == method, .true., dim=1)
         check%last = check%first
      end associate
   end subroutine add_check

   !> Append a row to the last check; absent arguments take the defaults of `row_t`
   subroutine add_row(self, name, expected, times, more, reason, quantity, unit, subject, twin, &
                      measure, expectation)
      class(law_t), intent(inout) :: self
      character(len=*), intent(in) :: name
      real(wp), intent(in), optional :: expected, times, more
      character(len=*), intent(in), optional :: reason, quantity
      real(wp), intent(in), optional :: unit
      integer, intent(in), optional :: subject, twin
      procedure(measure_i), optional :: measure, expectation

      associate (check => self%checks(self%count))
         check%count = check%count + 1
         associate (row => check%rows(check%count))
            row%name = name
            if (present(expected)) row%expected = expected
            if (present(times)) row%times = times
            if (present(more)) row%more = more
            if (present(reason)) row%reason = reason
            if (present(quantity)) row%quantity = quantity
            if (present(unit)) row%unit = unit
            if (present(subject)) row%subject = subject
            if (present(twin)) row%twin = twin
            if (present(measure)) row%measure => measure
            if (present(expectation)) row%expectation => expectation
         end associate
      end associate
   end subroutine add_row

   !> Solve the impacts of a law and judge its rows
   subroutine evaluate_law(law, verdicts)
      type(law_t), intent(in) :: law
      !> For each check the rows by ive, then those by direct
      type(verdict_t), allocatable, intent(out) :: verdicts(:)

      type(outcome_t), allocatable :: outcomes(:)
      integer :: i, k, method

      allocate (verdicts(0))
      do i = 1, law%count
         associate (check => law%checks(i))
            do method = check%first, check%last
               call solve_check(check, method, outcomes)
               verdicts = [verdicts, (judge(check%rows(k), method, outcomes), k=1, check%count)]
            end do
         end associate
      end do
   end subroutine evaluate_law

   !> Outcomes of the impacts of a check; shape (0) if one fails or does not end in separation
   subroutine solve_check(check, method, outcomes)
      type(check_t), intent(in) :: check
      integer, intent(in) :: method
      type(outcome_t), allocatable, intent(out) :: outcomes(:)

      type(outcome_t) :: outcome(size(check%strikes))
      type(solver_settings_t) :: settings
      type(impact_t) :: impact
      type(error_t), allocatable :: error
      integer :: i

      settings%method = trim(methods(method))
      settings%scheme = 'product'
      settings%accuracy = 0.5_wp*accuracies(method)
      allocate (outcomes(0))
      do i = 1, size(check%strikes)
         call check%strikes(i)%get_impact(impact, error, settings%method == 'coupled')
         if (.not. allocated(error)) call solve_impact(impact, outcome(i), error, settings)
         if (allocated(error)) return
         if (outcome(i)%status /= contact_separated) return
      end do
      outcomes = outcome
   end subroutine solve_check

   !> Judge a row
   pure function judge(row, method, outcomes) result(verdict)
      type(row_t), intent(in) :: row
      !> Number of the method in `methods`
      integer, intent(in) :: method
      !> Outcomes in the order of the impacts; shape (0): an impact had no outcome
      type(outcome_t), intent(in) :: outcomes(:)
      type(verdict_t) :: verdict

      verdict%name = row%name
      verdict%method = methods(method)
      verdict%reason = row%reason
      verdict%tolerance = row%times*accuracies(method) + row%more
      verdict%expected = row%expected
      verdict%found = ieee_value(verdict%found, ieee_quiet_nan)
      verdict%deviation = verdict%found
      if (size(outcomes) == 0) return
      if (associated(row%measure)) then
         verdict%found = row%measure(outcomes)
      else
         verdict%found = quantity_value(outcomes(row%subject), row%quantity)
         if (ieee_is_finite(verdict%found)) verdict%found = verdict%found/row%unit
      end if
      if (row%twin > 0) verdict%expected = quantity_value(outcomes(row%twin), row%quantity)
      if (associated(row%expectation)) verdict%expected = row%expectation(outcomes)
      if (.not. ieee_is_finite(verdict%found)) return
      if (.not. ieee_is_finite(verdict%expected)) return
      verdict%deviation = verdict%found - verdict%expected
      if (ieee_is_finite(verdict%tolerance)) &
         verdict%passed = abs(verdict%deviation) <= verdict%tolerance
   end function judge

   !> Build the impact, its equation of motion
   subroutine get_impact(self, impact, error, with_face)
      class(strike_t), intent(in) :: self
      type(impact_t), intent(out) :: impact
      type(error_t), allocatable, intent(out) :: error
      !> Whether it has the face of a plate with waves
      logical, intent(in) :: with_face

      class(material_t), allocatable :: sphere, body
      type(material_data_t) :: ball
      type(contact_modulus_t) :: modulus
      type(plate_t) :: plate
      type(contact_law_t) :: law
      type(face_t) :: face

      ball = self%sphere
      if (.not. allocated(ball%model)) ball%model = 'rigid'
      law%receding = self%receding
      call make_body(body, self%plate, error)
      if (.not. allocated(error)) call make_body(sphere, ball, error)
      if (.not. allocated(error)) &
         call new_contact_modulus(modulus, sphere, body, .false., error, pair_series)
      if (.not. allocated(error)) &
         call new_plate(plate, body, self%half_thickness, self%waves, error)
      if (with_face .and. .not. allocated(error)) call new_face(face, body, sphere, self%base, &
         2.0_wp*self%half_thickness, .true., error)
      if (.not. allocated(error)) call new_impact(impact, self%velocity, self%mass, self%radius, &
         0.0_wp, modulus, plate, error, law, face=face)
      if (.not. allocated(error) .and. self%layer > 0.0_wp) call lay(impact%law, &
         layer_t(base_bonded, body%poisson_ratio(), 1.0_wp, self%layer), profile_t(), &
         impact%factor, error)
   end subroutine get_impact

   !> Build a material with the density of the plates
   subroutine make_body(body, material, error)
      class(material_t), allocatable, intent(out) :: body
      type(material_data_t), intent(in) :: material
      type(error_t), allocatable, intent(out) :: error

      type(material_data_t) :: data

      data = material
      data%name = 'body'
      if (data%model /= 'rigid') call data%set('density', density)
      call new_material(body, data, error)
   end subroutine make_body

   !> Time scale T = (m/(k sqrt(v0)))^(2/5), k = (4/3) sqrt(R) E/(1 - nu^2), of a rigid sphere [s]
   pure function time_scale(strike, modulus) result(scale)
      type(strike_t), intent(in) :: strike
      !> Young's modulus E of the plate [Pa]
      real(wp), intent(in) :: modulus
      real(wp) :: scale

      scale = (strike%mass/(4.0_wp/3.0_wp*sqrt(strike%radius)*plane_strain*modulus &
         *sqrt(strike%velocity)))**0.4_wp
   end function time_scale

   !> A rigid sphere on an elastic plate of given lambda = alpha m/T, with
   !> alpha = sqrt(3 rho/E')/(16 rho h^2), which falls with the square of the half thickness h
   pure function zener_plate(modulus, waves, lambda) result(strike)
      !> Young's modulus [Pa]
      real(wp), intent(in) :: modulus
      !> One of the `waves_*` constants, except `waves_none`
      integer, intent(in) :: waves
      !> Zener's parameter [-], > 0
      real(wp), intent(in) :: lambda
      type(strike_t) :: strike

      strike = strike_t(elastic(modulus), waves=waves)
      strike%half_thickness = sqrt(sqrt(3.0_wp*density/(plane_strain*modulus)) &
         /(16.0_wp*density)*strike%mass/time_scale(strike, modulus)/lambda)
   end function zener_plate

   !> An elastic material
   pure function elastic(modulus) result(data)
      !> Young's modulus [Pa]
      real(wp), intent(in) :: modulus
      type(material_data_t) :: data

      data%model = 'elastic'
      call data%set('modulus', modulus)
   end function elastic

   !> A standard linear solid
   pure function sls(glassy_modulus, alpha, beta) result(data)
      !> Modulus at t = 0 [Pa]
      real(wp), intent(in) :: glassy_modulus
      !> Rates of Eq. (13) [1/s]: `beta` is the relaxation rate
      real(wp), intent(in) :: alpha, beta
      type(material_data_t) :: data

      data%model = 'sls'
      call data%set('glassy_modulus', glassy_modulus)
      call data%set('alpha', alpha)
      call data%set('beta', beta)
   end function sls

   !> A spring and a dashpot side by side
   pure function kelvin_voigt(modulus, viscosity) result(data)
      !> Modulus of the spring [Pa]
      real(wp), intent(in) :: modulus
      !> Viscosity of the dashpot [Pa s]
      real(wp), intent(in) :: viscosity
      type(material_data_t) :: data

      data%model = 'prony'
      call data%set('equilibrium_modulus', modulus)
      call data%set('viscosity', viscosity)
   end function kelvin_voigt

end module vcor_verify_law
