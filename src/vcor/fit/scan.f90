!> Where the fit of a model with a few parameters starts
!>
!> All of the models are E_0 + E_1 f(t; p), linear in two moduli for a given shape p, which is a
!> time, an exponent or both. So the shapes are scanned over all that the data can tell apart, with
!> the best two moduli for each by non-negative least squares. No start is guessed.
module vcor_fit_scan
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_fit_problem, only : misfit, problem_t
   use vcor_fit_result, only : moduli_of, parameter_t, state_fixed
   use vcor_numeric_nnls, only : solve_nnls
   implicit none
   private

   public :: find_starts

   !> Times of the scan per decade, and how far they go beyond the data, as a factor
   real(wp), parameter :: per_decade = 4.0_wp, beyond = 1.0e2_wp
   !> Exponents of the scan
   real(wp), parameter :: exponents(*) = [0.02_wp, 0.05_wp, 0.1_wp, 0.15_wp, 0.2_wp, 0.25_wp, &
      0.3_wp, 0.35_wp, 0.4_wp, 0.45_wp, 0.5_wp, 0.55_wp, 0.6_wp, 0.65_wp, 0.7_wp, 0.75_wp, &
      0.8_wp, 0.85_wp, 0.9_wp, 0.95_wp, 0.98_wp]
   !> Most minima of the scan that are followed
   integer, parameter :: most_starts = 6

contains

   !> Starts of the iteration: the minima of a scan of all shapes, the lowest ones first
   subroutine find_starts(problem, starts)
      !> The problem
      type(problem_t), intent(in) :: problem
      !> Values of all parameters, shape (parameters, starts)
      real(wp), allocatable, intent(out) :: starts(:, :)

      real(wp), allocatable :: times(:), powers(:), cost(:, :), values(:, :, :)
      logical, allocatable :: lowest(:, :)
      integer :: i, k, place(2)

      allocate (times, source=times_of_scan(problem))
      allocate (powers, source=powers_of_scan(problem))
      allocate (cost(0:size(times) + 1, 0:size(powers) + 1), source=huge(1.0_wp))
      allocate (values(size(problem%parameters), size(times), size(powers)))
      do k = 1, size(powers)
         do i = 1, size(times)
            call scan_shape(problem, times(i), powers(k), values(:, i, k), cost(i, k))
         end do
      end do
      allocate (lowest(size(times), size(powers)))
      do k = 1, size(powers)
         do i = 1, size(times)
            lowest(i, k) = cost(i, k) < huge(1.0_wp) &
               .and. cost(i, k) <= minval(cost(i - 1:i + 1, k - 1:k + 1))
         end do
      end do
      allocate (starts(size(problem%parameters), min(most_starts, count(lowest))))
      do i = 1, size(starts, 2)
         place = minloc(cost(1:size(times), 1:size(powers)), mask=lowest)
         lowest(place(1), place(2)) = .false.
         starts(:, i) = values(:, place(1), place(2))
      end do
   end subroutine find_starts

   !> Times of the scan; a time that is given, or that the model does not have, is the only one
   pure function times_of_scan(problem) result(times)
      !> The problem
      type(problem_t), intent(in) :: problem
      !> Times [s]
      real(wp), allocatable :: times(:)

      real(wp) :: first, last
      integer :: i, n

      first = problem%samples%first_time()/beyond
      last = problem%samples%last_time()*beyond
      n = 1 + ceiling(per_decade*log10(last/first))
      times = first*(last/first)**([(real(i, wp), i=0, n - 1)]/real(n - 1, wp))
      if (problem%model == 'power_law') times = [1.0_wp]
      do i = 1, size(problem%parameters)
         associate (parameter => problem%parameters(i))
            if (parameter%state /= state_fixed) cycle
            select case (parameter%name)
            case ('time')
               times = [parameter%value]
            case ('beta')
               times = [1.0_wp/parameter%value]
               if (problem%model == 'cerf') times = times**2
            case default
               continue
            end select
         end associate
      end do
   end function times_of_scan

   !> Exponents of the scan; one that is given, or that the model does not have, is the only one
   pure function powers_of_scan(problem) result(powers)
      !> The problem
      type(problem_t), intent(in) :: problem
      !> Exponents
      real(wp), allocatable :: powers(:)

      integer :: i

      powers = [1.0_wp]
      do i = 1, size(problem%parameters)
         if (problem%parameters(i)%name /= 'exponent') cycle
         powers = exponents
         if (problem%parameters(i)%state == state_fixed) powers = [problem%parameters(i)%value]
      end do
   end function powers_of_scan

   !> The best moduli for one shape, and what is left then
   subroutine scan_shape(problem, time, power, values, cost)
      !> The problem
      type(problem_t), intent(in) :: problem
      !> Time of the shape [s]
      real(wp), intent(in) :: time
      !> Exponent of the shape
      real(wp), intent(in) :: power
      !> Values of all parameters
      real(wp), intent(out) :: values(:)
      !> Sum of the squares of the residuals
      real(wp), intent(out) :: cost

      !> Part of the data that a modulus which is not needed starts from
      real(wp), parameter :: little = 1.0e-3_wp
      type(parameter_t) :: parameters(size(values))
      class(material_t), allocatable :: material
      type(error_t), allocatable :: error
      real(wp) :: a(problem%samples%count(), 2), b(problem%samples%count()), modulus(2)
      integer :: i

      cost = huge(cost)
      values = 0.0_wp
      call new_material(material, unit_shape(problem%model, time, power), error)
      if (allocated(error)) return
      a(:, 2) = moduli_of(material, problem%samples)/problem%samples%all()
      a(:, 1) = 0.0_wp
      a(:size(problem%samples%modulus), 1) = 1.0_wp/problem%samples%modulus
      b = 1.0_wp
      parameters = problem%parameters
      if (problem%model == 'sls') then
         call solve_nnls(a, b, modulus)
      else
         do i = 1, 2
            if (parameters(i)%state /= state_fixed) cycle
            b = b - parameters(i)%value*a(:, i)
            a(:, i) = 0.0_wp
         end do
         call solve_nnls(a, b, modulus)
      end if
      modulus = max(modulus, little*minval(problem%samples%modulus))

      do i = 1, size(parameters)
         if (parameters(i)%state == state_fixed) cycle
         select case (parameters(i)%name)
         case ('equilibrium_modulus')
            parameters(i)%value = modulus(1)
         case ('relaxing_modulus', 'coefficient')
            parameters(i)%value = modulus(2)
         case ('glassy_modulus')
            parameters(i)%value = sum(modulus)
         case ('alpha')
            parameters(i)%value = modulus(1)/sum(modulus)/time
         case ('beta')
            parameters(i)%value = 1.0_wp/time
            if (problem%model == 'cerf') parameters(i)%value = sqrt(1.0_wp/time)
         case ('time')
            parameters(i)%value = time
         case default
            parameters(i)%value = power
         end select
      end do
      values = parameters%value
      cost = sum(misfit(problem%model, parameters, problem%samples)**2)
   end subroutine scan_shape

   !> The shape of a model, without equilibrium modulus and with a relaxing modulus of 1 Pa
   pure function unit_shape(model, time, power) result(data)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Time [s]
      real(wp), intent(in) :: time
      !> Exponent
      real(wp), intent(in) :: power
      !> Description
      type(material_data_t) :: data

      data%name = model
      data%model = model
      call data%set('glassy_modulus', 1.0_wp)
      call data%set('relaxing_modulus', 1.0_wp)
      call data%set('coefficient', 1.0_wp)
      call data%set('exponent', power)
      call data%set('time', time)
      call data%set('beta', 1.0_wp/time)
      if (model == 'cerf') call data%set('beta', sqrt(data%number('beta')))
   end function unit_shape

end module vcor_fit_scan
