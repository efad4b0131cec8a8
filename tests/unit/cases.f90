!> Impacts for the tests: from case files, from a few numbers, at random
module vcor_test_cases
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_error, only : error_input, error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_target, only : new_plate, target_t
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_io_case_reader, only : read_case
   use vcor_kinds, only : pi, wp
   use vcor_material_prony, only : new_rigid, prony_t
   use vcor_material_type, only : material_t
   use vcor_solver_ive, only : ive_t, new_ive
   use vcor_solver_direct_product, only : new_product, product_t
   use vcor_solver_type, only : solver_settings_t, solver_t
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : validate
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_test, only : check, check_contains
   implicit none
   private

   public :: random_t
   public :: success, refused, read_impact, rigid_on_plate, body_on_body, run, make_ive, &
      make_product

   !> Random numbers, the same on every machine: the multiplicative generator of Park and Miller,
   !> Commun. ACM 31 (1988) 1192, doi:10.1145/63039.63042
   type :: random_t
      !> State, 1 .. 2^31 - 2
      integer(int64) :: state = 20240229_int64
   contains
      !> Uniform between two bounds
      procedure :: between
      !> Between two positive bounds, the logarithm uniform
      procedure :: log_between
      !> Uniform integer between two bounds, both included
      procedure :: among
   end type random_t

contains

   !> Check that nothing went wrong; the message of the error becomes the name of the failed check
   subroutine success(error, what)
      !> The error, unallocated on success
      type(error_t), allocatable, intent(in) :: error
      !> What was done
      character(len=*), intent(in) :: what

      if (allocated(error)) then
         call check(.false., what//": "//error%message)
      else
         call check(.true., what)
      end if
   end subroutine success

   !> Check that something was refused as bad input
   subroutine refused(error, what, reason)
      type(error_t), allocatable, intent(in) :: error
      !> What was refused
      character(len=*), intent(in) :: what
      !> What the message must name, empty: anything; absent: what was refused
      character(len=*), intent(in), optional :: reason

      call check(allocated(error), what//" is refused")
      if (.not. allocated(error)) return
      call check(error%code == error_input, what//" is an error of the input")
      if (present(reason)) then
         if (reason /= "") &
            call check_contains(error%message, reason, what//": the message says why")
      else
         call check_contains(error%message, what, what//": the message says why")
      end if
   end subroutine refused

   !> The impact of a case file
   subroutine read_impact(filename, impact)
      !> Name of the file
      character(len=*), intent(in) :: filename
      !> The impact
      type(impact_t), intent(out) :: impact

      type(problem_t) :: problem
      type(case_t) :: case
      type(error_t), allocatable :: error

      call read_case(case, filename, error)
      if (.not. allocated(error)) call validate(case, error)
      if (.not. allocated(error)) call problem_of_case(problem, case, error)
      call success(error, filename//" is read and built")
      impact = problem%impact
   end subroutine read_impact

   !> The paper's impact: a rigid sphere of 10 mm and 7800 kg/m3 on a plate of half thickness 20 mm
   subroutine rigid_on_plate(material, waves, velocity, impact, mass, radius)
      !> Material of the plate, of 1100 kg/m3 where it has no density
      class(material_t), intent(in) :: material
      !> One of the `waves_*` constants
      integer, intent(in) :: waves
      !> Velocity of approach [m/s], > 0
      real(wp), intent(in) :: velocity
      !> The impact
      type(impact_t), intent(out) :: impact
      !> Mass of the sphere [kg]; absent: from its density
      real(wp), intent(in), optional :: mass
      !> Radius of the sphere [m]; absent: 10 mm
      real(wp), intent(in), optional :: radius

      type(prony_t) :: rigid
      type(error_t), allocatable :: error

      call new_rigid(rigid)
      call rigid%set_constants(error, density=7800.0_wp)
      call body_on_body(rigid, material, waves, velocity, impact, mass, radius)
   end subroutine rigid_on_plate

   !> A sphere on a plate of half thickness 20 mm, the two of different materials
   subroutine body_on_body(sphere, material, waves, velocity, impact, mass, radius)
      !> Material of the sphere, of 1100 kg/m3 where it has no density
      class(material_t), intent(in) :: sphere
      !> Material of the plate, of 1100 kg/m3 where it has no density
      class(material_t), intent(in) :: material
      !> One of the `waves_*` constants
      integer, intent(in) :: waves
      !> Velocity of approach [m/s], > 0
      real(wp), intent(in) :: velocity
      !> The impact
      type(impact_t), intent(out) :: impact
      !> Mass of the sphere [kg]; absent: from its density
      real(wp), intent(in), optional :: mass
      !> Radius of the sphere [m]; absent: 10 mm
      real(wp), intent(in), optional :: radius

      real(wp), parameter :: usual_density = 1100.0_wp, half_thickness = 0.02_wp
      class(material_t), allocatable :: surface
      type(contact_modulus_t) :: modulus
      type(target_t) :: plate
      type(error_t), allocatable :: error
      real(wp) :: r, m

      r = 0.01_wp
      if (present(radius)) r = radius
      m = usual_density
      if (sphere%density() > 0.0_wp) m = sphere%density()
      m = 4.0_wp/3.0_wp*pi*r**3*m
      if (present(mass)) m = mass
      allocate (surface, source=material)
      if (.not. surface%density() > 0.0_wp) &
         call surface%set_constants(error, density=usual_density)

      call new_contact_modulus(modulus, sphere, surface, .false., error)
      if (.not. allocated(error)) call new_plate(plate, surface, half_thickness, waves, error)
      if (.not. allocated(error)) call new_impact(impact, velocity, m, r, 0.0_wp, modulus, plate, &
         error)
      if (allocated(error)) call success(error, "an impact is built")
   end subroutine body_on_body

   !> Solve and evaluate; the check that there was no error is counted when there was one
   subroutine run(solver, impact, outcome)
      !> The solver
      class(solver_t), intent(inout) :: solver
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its outcome
      type(outcome_t), intent(out) :: outcome

      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      call solver%solve(impact, trajectory, error)
      if (allocated(error)) then
         call success(error, "an impact is solved")
      else
         outcome = evaluate(impact, trajectory)
      end if
   end subroutine run

   !> The internal-variable method
   subroutine make_ive(accuracy, solver)
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> The solver
      type(ive_t), intent(out) :: solver

      type(error_t), allocatable :: error

      call new_ive(solver, solver_settings_t(accuracy=accuracy), error)
      if (allocated(error)) call success(error, "the internal-variable method is set up")
   end subroutine make_ive

   !> Product integration, with a given time step or to a given accuracy
   subroutine make_product(time_step, accuracy, solver)
      !> Time step [s]; 0: refined until the accuracy is reached
      real(wp), intent(in) :: time_step
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> The solver
      type(product_t), intent(out) :: solver

      call new_product(solver, solver_settings_t(time_step=time_step, accuracy=accuracy))
   end subroutine make_product

   !> A uniform random number
   function between(self, lower, upper) result(x)
      !> The generator
      class(random_t), intent(inout) :: self
      !> Lower bound
      real(wp), intent(in) :: lower
      !> Upper bound
      real(wp), intent(in) :: upper
      !> Number, lower < x < upper
      real(wp) :: x

      integer(int64), parameter :: multiplier = 48271_int64, modulus = 2147483647_int64

      self%state = mod(multiplier*self%state, modulus)
      x = lower + (upper - lower)*(real(self%state, wp)/real(modulus, wp))
   end function between

   !> A random number whose logarithm is uniform
   function log_between(self, lower, upper) result(x)
      !> The generator
      class(random_t), intent(inout) :: self
      !> Lower bound, > 0
      real(wp), intent(in) :: lower
      !> Upper bound, > 0
      real(wp), intent(in) :: upper
      !> Number, lower < x < upper
      real(wp) :: x

      x = lower*(upper/lower)**self%between(0.0_wp, 1.0_wp)
   end function log_between

   !> A random integer
   function among(self, lower, upper) result(i)
      !> The generator
      class(random_t), intent(inout) :: self
      !> Lower bound
      integer, intent(in) :: lower
      !> Upper bound
      integer, intent(in) :: upper
      !> Integer, lower <= i <= upper
      integer :: i

      i = lower + int(self%between(0.0_wp, real(upper - lower + 1, wp)))
   end function among

end module vcor_test_cases
