!> The course of one impact as figures need it: the history in units that suit it, cut at the end
!> of contact
module vcor_figure_course
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_t, raise
   use vcor_figure_result, only : get_axes, get_column, get_number, has_group, result_t
   use vcor_io_hdf5_reader, only : dataset_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: course_t, read_course

   !> A history with its outcome, in SI units
   type :: course_t
      !> Times [s], indentations [m], their rates [m/s], forces [N], shape (n)
      real(wp), allocatable :: time(:), indentation(:), velocity(:), force(:)
      !> Contact time [s]; NaN where the bodies did not separate
      real(wp) :: contact_time
      !> Coefficient of restitution and residual over largest indentation
      real(wp) :: cor, residual_ratio
      !> Largest indentation [m] and force [N], velocity of the impact [m/s]
      real(wp) :: max_indentation, max_force, impact_velocity
      !> Energy lost in the contact, and what it may be off by [J]
      real(wp) :: hysteresis_energy, energy_error
      !> Number of times up to the end of contact, which is the last of them
      integer :: contact_count
   end type course_t

   !> Error of an energy, in the initial energy, over that of the coefficient of restitution: the
   !> energy left, e^2 KE_0, changes by 2 e KE_0 de, and an error of three times the stated one is
   !> what `vcor verify` lets pass
   real(wp), parameter :: energy_share = 2.0_wp*3.0_wp

contains

   !> Read the course of an impact
   subroutine read_course(result, course, error)
      !> What a file holds
      type(result_t), intent(in) :: result
      type(course_t), intent(out) :: course
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(dataset_t), allocatable :: axes(:)

      if (.not. has_group(result, 'history')) then
         call get_axes(result, axes)
         if (size(axes) > 0) then
            call raise(error, error_input, result%path//': this is a sweep, which has no time ' &
               //'history; expected a single impact, or --kind sweep')
         else
            call raise(error, error_input, result%path//': there is no time history in this ' &
               //'file, expected that of a single impact, run with output.history = .true.')
         end if
         return
      end if
      call take('time', course%time)
      call take('indentation', course%indentation)
      call take('relative_velocity', course%velocity)
      call take('force', course%force)
      if (allocated(error)) return

      if (.not. (moves(course%indentation) .and. moves(course%velocity) &
         .and. moves(course%force))) then
         call raise(error, error_input, result%path//': the time history in this file is not ' &
            //'that of an impact: nothing moves, or numbers are missing')
         return
      end if

      course%contact_time = get_number(result, 'contact_time')
      course%cor = get_number(result, 'cor')
      course%residual_ratio = get_number(result, 'residual_ratio')
      course%hysteresis_energy = get_number(result, 'hysteresis_energy')
      course%energy_error = energy_share*get_number(result, 'initial_energy') &
         *get_number(result, 'cor_error')
      course%impact_velocity = maxval(course%velocity)
      course%max_indentation = largest('max_indentation', course%indentation)
      course%max_force = largest('max_force', course%force)
      call thin(course)
      call cut(course)

   contains

      !> Read a column
      subroutine take(name, values)
         character(len=*), intent(in) :: name
         !> Its values, as many as there are times
         real(wp), allocatable, intent(out) :: values(:)

         type(dataset_t) :: column

         if (allocated(error)) return
         call get_column(result, 'history', name, column, error)
         if (allocated(error)) return
         values = column%column%reals
         if (size(values) /= size(course%time) .or. size(values) < 2) call raise(error, &
            error_input, result%path//": '"//name//"' of 'history' has not as many values as " &
            //'there are times, or fewer than two')
      end subroutine take

      !> Whether values are finite, the largest of them above zero
      pure function moves(values)
         real(wp), intent(in) :: values(:)
         !> True if they are
         logical :: moves

         moves = all(ieee_is_finite(values))
         if (moves) moves = maxval(values) > 0.0_wp
      end function moves

      !> A largest value: the outcome's, which is between the times, or that of the history
      function largest(name, values)
         !> Its name in the summary
         character(len=*), intent(in) :: name
         !> Values of the history
         real(wp), intent(in) :: values(:)
         !> Largest value
         real(wp) :: largest

         largest = get_number(result, name)
         if (.not. ieee_is_finite(largest)) largest = maxval(values)
      end function largest
   end subroutine read_course

   !> Leave out times where there are more than a figure can show
   subroutine thin(course)
      type(course_t), intent(inout) :: course

      integer, parameter :: most_times = 500
      integer, allocatable :: kept(:)
      integer :: i, last, stride

      last = size(course%time)
      stride = (last + most_times - 1)/most_times
      if (stride < 2) return
      kept = [(i, i=1, last - 1, stride), last]
      course%time = course%time(kept)
      course%indentation = course%indentation(kept)
      course%velocity = course%velocity(kept)
      course%force = course%force(kept)
   end subroutine thin

   !> Put the end of contact in among the times
   subroutine cut(course)
      type(course_t), intent(inout) :: course

      real(wp), parameter :: tolerance = 1.0e-9_wp
      real(wp) :: share
      integer :: n

      course%contact_count = size(course%time)
      if (.not. ieee_is_finite(course%contact_time)) return
      n = count(course%time <= course%contact_time*(1.0_wp + tolerance))
      if (n < 1 .or. n >= size(course%time)) return
      if (course%contact_time - course%time(n) > tolerance*course%contact_time) then
         share = (course%contact_time - course%time(n))/(course%time(n + 1) - course%time(n))
         call insert(course%time)
         call insert(course%indentation)
         call insert(course%velocity)
         call insert(course%force)
         n = n + 1
      end if
      course%contact_count = n

   contains

      !> Put a value in, between its neighbours
      subroutine insert(values)
         !> Values, one more afterwards
         real(wp), allocatable, intent(inout) :: values(:)

         values = [values(:n), values(n) + share*(values(n + 1) - values(n)), values(n + 1:)]
      end subroutine insert
   end subroutine cut

end module vcor_figure_course
