!> Sums of exponentials that stand for a kernel: spectra, and what the solver makes of them
program test_exponential_sum
   use vcor_error, only : error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_target, only : new_plate, target_t, waves_none
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_in_series, only : new_in_series
   use vcor_solver_ive, only : ive_t, new_ive
   use vcor_solver_direct_product, only : new_product, product_t
   use vcor_solver_type, only : solver_settings_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   implicit none

   real(wp), parameter :: exponents(*) = [0.05_wp, 0.1_wp, 0.25_wp, 0.5_wp, 0.75_wp, 0.9_wp]

   call suite("exponential_sum")
   call test_windows()
   call test_accuracy()
   call test_near_one()
   call test_near_zero()
   call test_series()
   call test_methods()
   call test_long_contact()
   call finish()

contains

   !> A material by its model
   subroutine make(model, exponent, material)
      !> power_law, cerf or mittag_leffler
      character(len=*), intent(in) :: model
      !> Exponent
      real(wp), intent(in) :: exponent
      !> The material
      class(material_t), allocatable, intent(out) :: material

      type(material_data_t) :: data
      type(error_t), allocatable :: error

      data%name = "material"
      data%model = model
      call data%set('density', 1100.0_wp)
      call data%set('equilibrium_modulus', 0.0_wp)
      call data%set('coefficient', 1.0e6_wp)
      call data%set('exponent', exponent)
      call data%set('relaxing_modulus', 1.0e8_wp)
      call data%set('beta', 700.0_wp)
      call data%set('time', 1.0e-4_wp)
      call new_material(material, data, error)
      call check(.not. allocated(error), model//" is built")
   end subroutine make

   !> The integral of a sum from 0 to t, dashpot included
   pure function integral(terms, t)
      !> The sum
      type(exponential_sum_t), intent(in) :: terms
      !> Time [s]
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: integral

      real(wp) :: x(size(terms%rates))

      ! 1 - exp(-x) without cancellation where a rate is slow
      x = terms%rates*t
      x = merge(2.0_wp*sinh(0.5_wp*min(x, 1.0_wp))*exp(-0.5_wp*min(x, 1.0_wp)), 1.0_wp - exp(-x), &
         x < 1.0_wp)
      integral = terms%equilibrium*t + terms%viscosity + sum(terms%moduli/terms%rates*x)
   end function integral

   !> On windows of any length the sum is the modulus, with positive terms, and its error is what it
   !> says
   subroutine test_windows()
      ! the step of the rule is made for 1e-9; large exponents, whose modulus falls steeply, get the
      ! least, a hundredfold, and the integral, which is what counts for short times, within
      ! thirty times
      real(wp), parameter :: accuracy = 1.0e-9_wp, pointwise = 1.0e-7_wp, whole = 3.0e-8_wp
      character(len=*), parameter :: models(*) = [character(len=14) :: "power_law", "cerf", &
         "mittag_leffler"]
      real(wp), parameter :: windows(*) = [1.0e-9_wp, 1.0e-3_wp, 1.0_wp, 1.0e6_wp]
      class(material_t), allocatable :: material
      type(exponential_sum_t) :: terms
      real(wp) :: t, largest
      integer :: i, j, k, m

      do i = 1, size(models)
         do j = 1, size(exponents)
            call make(trim(models(i)), exponents(j), material)
            do k = 1, size(windows)
               call material%exponentials(windows(k), accuracy, terms)
               call check(all(terms%moduli > 0.0_wp) .and. all(terms%rates > 0.0_wp) &
                  .and. terms%viscosity >= 0.0_wp .and. terms%equilibrium >= 0.0_wp, &
                  trim(models(i))//": all terms are positive")
               call check(terms%error > 0.0_wp .and. terms%error <= pointwise, &
                  trim(models(i))//": the error told is small")
               largest = 0.0_wp
               do m = 0, 20
                  t = windows(k)*0.25_wp**(real(m, wp)/20.0_wp)
                  largest = max(largest, abs(integral(terms, t)/material%integral(t) - 1.0_wp))
               end do
               ! five samples of an error that oscillates
               call check(largest <= 3.0_wp*terms%error + 1.0e-13_wp, &
                  trim(models(i))//": and it is that of the integral up to any later time")
               call check_relative(integral(terms, windows(k)), material%integral(windows(k)), &
                  whole, trim(models(i))//": integral over the window")
            end do
         end do
      end do
   end subroutine test_windows

   !> The error falls with the accuracy asked for, and the number of terms follows its logarithm
   subroutine test_accuracy()
      class(material_t), allocatable :: material
      type(exponential_sum_t) :: terms
      integer :: i, before

      call make("power_law", 0.5_wp, material)
      before = 0
      do i = 4, 12
         call material%exponentials(1.0e-3_wp, 10.0_wp**(-i), terms)
         call check(terms%error <= 300.0_wp*10.0_wp**(-i), "the error follows the accuracy")
         call check(size(terms%rates) > before, "more accuracy takes more terms")
         call check(size(terms%rates) <= 4*i, "and not many")
         before = size(terms%rates)
      end do
   end subroutine test_accuracy

   !> Next to exponent 1 the spectrum is a narrow peak: few terms more find it
   subroutine test_near_one()
      real(wp), parameter :: distance(*) = [1.0e-1_wp, 1.0e-2_wp, 1.0e-4_wp, 1.0e-8_wp]
      class(material_t), allocatable :: material
      type(exponential_sum_t) :: terms
      integer :: i

      do i = 1, size(distance)
         call make("mittag_leffler", 1.0_wp - distance(i), material)
         call material%exponentials(1.0e-3_wp, 1.0e-10_wp, terms)
         call check(terms%error <= 1.0e-8_wp, "the peak is met")
         call check(size(terms%rates) <= 150, "by no more than some hundred terms")
         ! at the peak rounding of the rate is magnified by the inverse of its width
         call check_relative(integral(terms, 1.0e-3_wp), material%integral(1.0e-3_wp), &
            1.0e-9_wp + 10.0_wp*epsilon(1.0_wp)/distance(i), "its integral")
      end do

      ! a power law has half of its integral beyond any rate
      do i = 1, 3
         call make("power_law", 1.0_wp - distance(i), material)
         call material%exponentials(1.0e-3_wp, 1.0e-10_wp, terms)
         call check_relative(integral(terms, 1.0e-5_wp), material%integral(1.0e-5_wp), 1.0e-8_wp, &
            "the integral of a power law next to a dashpot")
      end do
      do i = 1, 8
         call make("power_law", 1.0_wp - 0.002_wp*real(i, wp), material)
         call material%exponentials(1.0e-3_wp, 1.0e-6_wp, terms)
         call check_relative(integral(terms, 1.0e-3_wp), material%integral(1.0e-3_wp), 1.0e-7_wp, &
            "what lies beyond all rates is added")
      end do
   end subroutine test_near_one

   !> Next to exponent 0 most of the spectrum lies below all rates that can be computed
   subroutine test_near_zero()
      real(wp), parameter :: exponent(*) = [3.0e-2_wp, 1.0e-2_wp, 1.0e-3_wp, 1.0e-8_wp]
      class(material_t), allocatable :: material
      type(exponential_sum_t) :: terms
      integer :: i

      do i = 1, size(exponent)
         call make("power_law", exponent(i), material)
         call material%exponentials(1.0e-3_wp, 1.0e-10_wp, terms)
         call check(terms%error <= 1.0e-9_wp, "what lies below all rates is added")
         call make("mittag_leffler", exponent(i), material)
         call material%exponentials(1.0e-3_wp, 1.0e-10_wp, terms)
         call check(terms%error <= 1.0e-9_wp, "what lies below all rates is added")
      end do
   end subroutine test_near_zero

   !> Materials in series have the features of their spectrum where it pleases: few refinements find
   !> them, and not with twice the terms
   subroutine test_series()
      character(len=*), parameter :: models(*) = [character(len=14) :: "power_law", &
         "mittag_leffler"]
      real(wp), parameter :: steep(*) = [0.5_wp, 0.9_wp], windows(*) = [1.0e-3_wp, 10.0_wp]
      integer, parameter :: most_terms(*) = [100, 300]
      real(wp), parameter :: accuracy = 1.0e-8_wp
      class(material_t), allocatable :: one, other, series
      type(exponential_sum_t) :: terms
      type(error_t), allocatable :: error
      integer :: i

      do i = 1, size(windows)
         call make(trim(models(i)), 0.05_wp, one)
         call make(trim(models(i)), steep(i), other)
         if (allocated(series)) deallocate (series)
         call new_in_series(series, one, 1.0_wp, other, 1.0_wp, error)
         call series%exponentials(windows(i), accuracy, terms)
         call check(terms%error <= 2.0_wp*accuracy, "a series is met")
         call check(size(terms%rates) <= most_terms(i), "by few terms")
      end do
   end subroutine test_series

   !> Impact of a steel sphere on a half space
   subroutine make_impact(material, impact)
      !> Material of the half space
      class(material_t), intent(in) :: material
      !> The impact
      type(impact_t), intent(out) :: impact

      type(material_data_t) :: data
      class(material_t), allocatable :: rigid
      type(contact_modulus_t) :: modulus
      type(target_t) :: plate
      type(error_t), allocatable :: error

      data%name = "steel"
      data%model = "rigid"
      call new_material(rigid, data, error)
      call new_contact_modulus(modulus, rigid, material, .false., error)
      call new_plate(plate, material, 0.02_wp, waves_none, error)
      call new_impact(impact, 5.0_wp, 0.03_wp, 0.01_wp, 0.0_wp, modulus, plate, error)
      call check(.not. allocated(error), "an impact is built")
   end subroutine make_impact

   !> Pure power laws of six exponents by both methods: direct extrapolated by Richardson's rule to
   !> the order that three steps show
   subroutine test_methods()
      real(wp), parameter :: agreement = 1.0e-7_wp, accuracy = 1.0e-8_wp
      class(material_t), allocatable :: material
      type(impact_t) :: impact
      type(ive_t) :: ive
      type(product_t) :: product
      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp) :: cor, direct(3), ratio
      integer :: i, j

      call new_ive(ive, solver_settings_t(accuracy=accuracy), error)
      do i = 1, size(exponents)
         call make("power_law", exponents(i), material)
         call make_impact(material, impact)
         call ive%solve(impact, trajectory, error)
         call check(.not. allocated(error), "ive solves a power law")
         outcome = evaluate(impact, trajectory)
         cor = outcome%cor
         call check(outcome%cor_error <= accuracy, "its estimate is within the accuracy")
         call check(trajectory%kernel_terms > 20 .and. trajectory%kernel_error > 0.0_wp, &
            "it says what stood for the kernel")
         do j = 1, 3
            call new_product(product, solver_settings_t(accuracy=1.0e-6_wp, &
               time_step=outcome%contact_time/(500.0_wp*2.0_wp**j)))
            call product%solve(impact, trajectory, error)
            direct(j) = cor_of(impact, trajectory)
         end do
         ratio = (direct(1) - direct(2))/(direct(2) - direct(3))
         call check(ratio > 2.0_wp, "direct converges")
         call check_close(cor, direct(3) + (direct(3) - direct(2))/(ratio - 1.0_wp), agreement, &
            "both methods agree on a power law")
      end do
   end subroutine test_methods

   !> Coefficient of restitution of a trajectory
   function cor_of(impact, trajectory) result(cor)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(in) :: trajectory
      !> -s'(t0)/v0
      real(wp) :: cor

      type(outcome_t) :: outcome

      outcome = evaluate(impact, trajectory)
      cor = outcome%cor
   end function cor_of

   !> A contact that outlasts the window of the first sum is solved again with a longer one: where
   !> the modulus falls steeply the contact lasts for many of its time scales
   subroutine test_long_contact()
      real(wp), parameter :: reference = 2.642558875e-2_wp
      class(material_t), allocatable :: material
      type(impact_t) :: impact
      type(ive_t) :: ive
      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error

      call new_ive(ive, solver_settings_t(), error)
      call make("power_law", 0.9_wp, material)
      call make_impact(material, impact)
      call ive%solve(impact, trajectory, error)
      outcome = evaluate(impact, trajectory)
      call check(outcome%status == contact_separated, "the bodies separate")
      call check_close(outcome%cor, reference, 1.0e-8_wp, "exponent 0.9")
   end subroutine test_long_contact

end program test_exponential_sum
