!> The table of the command verify: laws of impact, each as a case that anybody can run
module vcor_app_laws
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_quiet_nan, ieee_value
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : validate
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_io_case_reader, only : read_case_text
   use vcor_kinds, only : pi, wp
   use vcor_sweep_quantity, only : quantity_value
   implicit none
   private

   public :: law_t, laws, verdict_t, evaluate

   !> A law: an impact of which a number is known
   type :: law_t
      !> What the law says
      character(len=32) :: title = ''
      !> Where the number comes from
      character(len=56) :: source = ''
      !> Column of the summary, and its unit in the table
      character(len=12) :: quantity = 'cor'
      real(wp) :: unit = 1.0_wp
      !> The number, in this unit
      real(wp) :: expected = 0.0_wp
      !> Error of what the methods share, such as a table of the contact law
      real(wp) :: shared = 0.0_wp
      !> Methods that solve the impact, separated by blanks
      character(len=10) :: methods = 'ive direct'
      !> Groups of the case, without the sphere and the solver
      character(len=240) :: text = ''
   end type law_t

   !> Judgement of a law for one method
   type :: verdict_t
      character(len=7) :: method = ''
      !> NaN if there is no value
      real(wp) :: found = 0.0_wp, deviation = 0.0_wp
      real(wp) :: tolerance = 0.0_wp
      logical :: passed = .false.
   end type verdict_t

   !> The sphere of Green's paper; all plates have its density and Poisson's ratio
   character(len=*), parameter :: sphere = "&sphere radius = 0.01, material = 'steel' /" &
      //"&material name = 'steel', model = 'rigid', density = 7800 /"
   character(len=*), parameter :: plate = "&material name = 'plate', density = 1100, " &
      //"poisson_ratio = 0.5, "
   character(len=*), parameter :: elastic = plate//"model = 'elastic', modulus = 15e6 /"
   character(len=*), parameter :: rubber = plate &
      //"model = 'sls', glassy_modulus = 15e6, alpha = 300, beta = 1200 /"
   character(len=*), parameter :: fast = "&impact velocity = 10 /"
   character(len=*), parameter :: on_half_space = fast &
      //"&plate material = 'plate', waves = 'none' /"

   !> Time scale T = (m/(k sqrt(v0)))^(2/5) of the elastic impact on a half space,
   !> k = (4/3) sqrt(R) E/(1 - nu^2) [s], here from the numbers alone
   real(wp), parameter :: scale = (4.0_wp/3.0_wp*pi*0.01_wp**3*7800.0_wp &
      /(4.0_wp/3.0_wp*sqrt(0.01_wp)*15.0e6_wp/0.75_wp*sqrt(10.0_wp)))**0.4_wp
   !> Duration of Hertz's impact, (4/5) B(2/5, 1/2) (5/4)^(2/5) T = 3.2180654597190435 T [s]
   real(wp), parameter :: duration = 0.8_wp*1.25_wp**0.4_wp &
      *gamma(0.4_wp)*gamma(0.5_wp)/gamma(0.9_wp)*scale
   real(wp), parameter :: milli = 1.0e-3_wp

   !> The laws. Zener's plate has alpha m/T = 0.2, alpha = sqrt(3 rho/E')/(16 rho h^2), and the
   !> dashpot (2/3) T E, which makes b = (3/2) eta/(E T) = 1. Their numbers are from
   !> tests/reference/make_kelvin_voigt.py; those of power law and rubber from make_reference.py, by
   !> spectral collocation of the Volterra equation; that of the layer from make_layers.py,
   !> for a table of its law with ten digits
   type(law_t), parameter :: laws(*) = [ &
      law_t('Hertz, elastic: t0 [ms]', 'H. Hertz 1882, closed form', 'contact_time', &
      milli, duration/milli, text=on_half_space//elastic), &
      law_t("Zener's plate, lambda 0.2: cor", 'C. Zener 1941, Taylor series', &
      expected=0.71404487999215247657_wp, text=fast//"&plate material = 'plate', " &
      //"half_thickness = 0.01661683717663147, waves = 'constant' /"//elastic), &
      law_t('power law t^-1/2: cor', 'no time scale; spectral collocation', &
      expected=0.28565312277610_wp, text=on_half_space//plate &
      //"model = 'power_law', coefficient = 1e6, exponent = 0.5 /"), &
      law_t('Kelvin-Voigt, b = 1: cor', 'T. Schwager, T. Poeschel 2008, Taylor series', &
      expected=0.39393060322987319305_wp, text=on_half_space//plate//"model = 'prony', " &
      //"equilibrium_modulus = 15e6, viscosity = 4318.031357862497 /"), &
      law_t('two methods, rubber: cor', 'I. Green, spectral collocation', &
      expected=0.4319868986469853_wp, text=fast//"&plate material = 'plate', " &
      //"half_thickness = 0.02, waves = 'relaxing' /"//rubber), &
      law_t('layer bonded to a floor: cor', 'Fredholm equation, receding contact', &
      expected=0.613633897937_wp, shared=1.0e-10_wp, &
      text="&impact velocity = 2 /&plate material = 'plate', " &
      //"thickness = 0.01, base = 'bonded' /&contact law = 'receding' /"//rubber), &
      law_t('coupled contact and waves: cor', 'contact and waves as one, another discretisation', &
      expected=0.38090382_wp, methods='coupled', text=fast//"&plate material = 'plate', " &
      //"thickness = 0.04, waves = 'body' /"//rubber)]

   !> Names of the methods and the accuracies that they must reach, twice what they are asked for.
   !> For ive that is the smallest that the solver accepts, for direct half of its default
   character(len=*), parameter :: names(3) = [character(len=7) :: 'ive', 'direct', 'coupled']
   real(wp), parameter :: accuracies(3) = [2.0e-11_wp, 1.0e-6_wp, 1.0e-5_wp]

contains

   !> Solve the impact of a law by its methods
   subroutine evaluate(law, verdicts)
      type(law_t), intent(in) :: law
      !> One for each method
      type(verdict_t), allocatable, intent(out) :: verdicts(:)

      integer :: method

      allocate (verdicts(0))
      do method = 1, size(names)
         if (index(law%methods, trim(names(method))) == 0) cycle
         verdicts = [verdicts, judge(law, method, value_of(law, method))]
      end do
   end subroutine evaluate

   !> Value that a method finds
   function value_of(law, method) result(value)
      type(law_t), intent(in) :: law
      integer, intent(in) :: method
      !> In the unit of the law; NaN if the impact has no result
      real(wp) :: value

      type(case_t) :: case
      type(problem_t) :: problem
      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error

      value = ieee_value(value, ieee_quiet_nan)
      call read_case_text(case, sphere//trim(law%text)//"&solver method = '"//trim(names(method)) &
         //"' /", 'law', error)
      if (.not. allocated(error)) call validate(case, error)
      if (allocated(error)) return
      call case%set(case%address('solver', 'accuracy'), 0.5_wp*accuracies(method))
      call problem_of_case(problem, case, error)
      if (.not. allocated(error)) call problem%solve(trajectory, outcome, error)
      if (allocated(error)) return
      if (outcome%status == contact_separated) &
         value = quantity_value(outcome, trim(law%quantity))/law%unit
   end function value_of

   !> Judge a value: a restitution must have the accuracy of the method, other quantities ten times
   !> that, since steps are chosen for cor. NaN fails
   pure function judge(law, method, found) result(verdict)
      type(law_t), intent(in) :: law
      integer, intent(in) :: method
      !> The value, in the unit of the law
      real(wp), intent(in) :: found
      type(verdict_t) :: verdict

      verdict%method = names(method)
      verdict%found = found
      verdict%deviation = found
      verdict%tolerance = accuracies(method)
      if (law%quantity /= 'cor') verdict%tolerance = 10.0_wp*law%expected*verdict%tolerance
      verdict%tolerance = verdict%tolerance + law%shared
      if (.not. ieee_is_finite(found)) return
      verdict%deviation = found - law%expected
      verdict%passed = abs(verdict%deviation) <= verdict%tolerance
   end function judge

end module vcor_app_laws
