!> References of impacts with waves by meshes much finer than those of the method:
!> for each case file a line with cor_sphere, contact time and largest
!> force. 160 to 640 steps, 1600 springs and 13 elements of the hats, extrapolated in the steps, and
!> 19 elements for what more hats change
program fine_impacts
   use, intrinsic :: iso_fortran_env, only : output_unit
   use vcor, only : case_t, error_t, problem_of_case, problem_t, read_case, validate, wp
   use vcor_benchmark_stopwatch, only : stop_on
   use vcor_impact_problem, only : impact_t
   use vcor_solver_coupled_kernel, only : kernel_t, mesh_t, new_kernel
   use vcor_solver_coupled_march, only : course_ended, course_outgrows, course_t, march
   implicit none

   integer, parameter :: springs = 1600, hats = 14, more_hats = 20
   !> Steps after the window
   integer, parameter :: after = 8
   character(len=1000) :: path
   integer :: i

   do i = 1, command_argument_count()
      call get_command_argument(i, path)
      call solve(trim(path))
   end do

contains

   !> Solve a case and print its results
   subroutine solve(path)
      !> The case file
      character(len=*), intent(in) :: path

      type(case_t) :: case
      type(problem_t) :: problem
      type(error_t), allocatable :: error
      type(course_t) :: course
      real(wp) :: window, radius, value(3, 0:2), two(3, 2), change(3)
      integer :: j

      call read_case(case, path, error)
      call stop_on(error)
      call validate(case, error)
      call stop_on(error)
      call problem_of_case(problem, case, error)
      call stop_on(error)
      associate (impact => problem%impact)
         window = 4.0_wp*impact%time_scale()
         radius = impact%law%radius(impact%factor, impact%velocity*window/4.0_wp)
         do
            course = course_on(impact, mesh_t(160, 400, 8, window, radius))
            if (course%status == course_ended) exit
            if (course%status == course_outgrows) radius = 1.2_wp*radius
            if (course%status /= course_outgrows) window = 1.2_wp*window
         end do
         window = course%contact_time
         if (impact%law%start_exponent > 1.0_wp) radius = 1.04_wp*maxval(course%radius)
         do j = 0, 2
            value(:, j) = results(impact, 160*2**j, hats, window, radius)
         end do
         change = results(impact, 160, more_hats, window, radius) - value(:, 0)
         two = (4.0_wp*value(:, 1:2) - value(:, 0:1))/3.0_wp
         ! the coefficient has an error of third order as well
         two(1, 2) = two(1, 2) + (two(1, 2) - two(1, 1))/7.0_wp
         ! the error of the hats is of second order
         two(:, 2) = two(:, 2) + change*(1.0_wp + 1.0_wp/((19.0_wp/13.0_wp)**2 - 1.0_wp))
         write (output_unit, '(a, 3(1x, es22.14))') path, two(:, 2)
      end associate
   end subroutine solve

   !> Coefficient of restitution, contact time [s] and largest force [N] of a march
   function results(impact, steps, hats, window, radius) result(value)
      type(impact_t), intent(in) :: impact
      !> Steps over the window and hats
      integer, intent(in) :: steps, hats
      !> Window [s] and radius of the row [m]
      real(wp), intent(in) :: window, radius
      real(wp) :: value(3)

      type(course_t) :: course

      course = course_on(impact, mesh_t(steps + after, springs, hats, &
         window*real(steps + after, wp)/real(steps, wp), radius))
      value = [course%cor(impact), course%contact_time, maxval(course%force)]
   end function results

   !> Course on a mesh
   function course_on(impact, mesh) result(course)
      type(impact_t), intent(in) :: impact
      type(mesh_t), intent(in) :: mesh
      type(course_t) :: course

      type(kernel_t) :: kernel
      type(error_t), allocatable :: error

      call new_kernel(kernel, impact%face, mesh, error)
      call stop_on(error)
      call march(impact, kernel, course, error)
      call stop_on(error)
   end function course_on

end program fine_impacts
