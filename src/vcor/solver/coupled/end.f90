!> The end of the contact, which lies between steps
module vcor_solver_coupled_end
   use vcor_impact_face, only : base_half_space
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver_coupled_course, only : course_ended, course_t
   use vcor_solver_coupled_kernel, only : kernel_t
   implicit none
   private

   public :: end_contact, leave

   !> Exponent of the law of a sphere; smaller ones are those of blunter bodies
   real(wp), parameter :: round = 1.5_wp

contains

   !> Steps from the root of a falling series to its end, by inverse interpolation
   pure function before_end(value) result(steps)
      !> Values at equal steps, falling, the root near the last
      real(wp), intent(in) :: value(:)
      !> Steps, < 0 if the root is after the end
      real(wp) :: steps

      real(wp) :: share
      integer :: i, j, n

      n = size(value)
      steps = 0.0_wp
      do i = 1, n
         share = real(n - i, wp)
         do j = 1, n
            if (j /= i) share = share*value(j)/(value(j) - value(i))
         end do
         steps = steps + share
      end do
   end function before_end

   !> Find the time at which the contact has ended.
   !>
   !> While the waves are faster than the edge, the contact of a body of profile h = C x^n shrinks
   !> as a^n ~ t_s - t and its force falls as (t_s - t)^(1 + 1/n). This sends out waves, and the
   !> compression on the axis ends in a way that no step resolves. If those of an elastic half
   !> space, as stiff as the plate in a step, had passed, the approach there would fall steadily:
   !> what else the face does is slow. Its root t_s does not depend on steps and springs. What the
   !> waves do near it is an impact problem of its own with one length L, at which the edge is as
   !> fast as they are, L^(n-1) = V/(C c), and one time, L/c: V is the speed at which the steady
   !> approach falls, and C x^n the profile of the body less that of the dent out of which it rises.
   !> Of a sphere C = 1/R, and L = R V/c.
   !>
   !> Springs that remember are left by the body at last where they were touched at first, at h =
   !> v0 t_c. With k(t) of the pressure of a compression left, their pressure is that of the steady
   !> approach less k(t) h, so that C is k(t0) times that of the body; of a sphere it is measured
   !> beside the axis, with all else that is curved.
   !>
   !> So the contact ends L/c times a number before t_s that depends on n, Poisson's ratio of the
   !> plate and the part of the striker in the local compliance alone, `advance`; a cone has no such
   !> length, and what is sharper than a sphere hardly one. On a layer thinner than L the waves come
   !> back before the end: there, and on a face without waves for blunt bodies, the end is that of
   !> the compression as marched
   pure subroutine end_contact(course, impact, kernel, axis, beside, hats)
      !> The course, its last step the first without contact
      type(course_t), intent(inout) :: course
      type(impact_t), intent(in) :: impact
      type(kernel_t), intent(in) :: kernel
      !> Compression on the axis from step 0 to the last [m]
      real(wp), intent(in) :: axis(0:)
      !> Compression at `kernel%beside` in the last but one of them [m]
      real(wp), intent(in) :: beside
      !> Forces of the hats in all steps [N]
      real(wp), contiguous, intent(in) :: hats(:)

      ! error of `advance` (see there) with that of the shape of the body over its dent, of a sphere
      ! and of blunter bodies: these are within 0.006 of marches of 2560 steps and 64 hats
      real(wp), parameter :: unknown(2) = [0.006_wp, 0.01_wp]
      ! steps between the values from which the root is found: with 2 and 8 contact times of 40
      ! random impacts change by up to 2e-5, less than half of what is stated
      integer, parameter :: spans = 4
      real(wp), allocatable :: steady(:)
      real(wp) :: early, fast, root
      integer :: i, k, stride
      logical :: is_steady

      course%status = course_ended
      k = course%steps
      fast = 0.0_wp
      is_steady = impact%law%start_exponent >= round
      if (allocated(kernel%passing) .and. impact%law%start_exponent > 1.0_wp &
          .and. impact%law%start_exponent <= round) call find_time_of_waves(fast, is_steady)
      early = advance(kernel%moduli%poisson_ratio, kernel%striker_share, &
         impact%law%start_exponent)*fast
      if (is_steady) then
         ! a root that is several steps ahead is found from values that reach as far back
         stride = max(1, min(k/spans, ceiling(early/(real(spans, wp)*course%dt))))
         steady = [(axis(i) + passing(i, 1), i=k - stride*min(spans, k/stride), k, stride)]
         is_steady = all(steady(2:) < steady(:size(steady) - 1))
      end if
      if (is_steady) then
         root = before_end(steady)*real(stride, wp)
         ! the waves advance the end by less than L/c
         is_steady = root >= -max(1.0_wp, fast/course%dt) .and. root <= real(k, wp)
      end if
      if (is_steady) then
         course%contact_time = (real(k, wp) - root)*course%dt - early
         course%time_error = merge(unknown(2), unknown(1), &
            impact%law%start_exponent < round)*fast
      else
         call end_of_fall(axis(max(0, k - 4):k), root, course%time_error)
         course%contact_time = (real(k, wp) - root)*course%dt
         course%time_error = course%time_error*course%dt
      end if

   contains

      !> L/c, with the speed of shear waves in a step, as in the waves that pass, and whether the
      !> plate is thicker than L
      pure subroutine find_time_of_waves(time, is_thick)
         !> L/c [s]
         real(wp), intent(out) :: time
         !> False too if the body rises out of a dent that is as curved as it, and if L/c is longer
         !> than the contact
         logical, intent(out) :: is_thick

         real(wp) :: rise, here, rate, speed, power, length

         time = 0.0_wp
         power = 1.0_wp/(impact%law%start_exponent - 1.0_wp)
         here = axis(k - 1) + passing(k - 1, 1)
         associate (x => kernel%row%node(kernel%beside))
            ! so near to the axis a blunt body is flatter than what the march knows of the dent
            if (impact%law%start_exponent < round) then
               rise = impact%law%profile(impact%factor, x)*relaxed(kernel%local(0:k))
            else
               rise = here - (beside + passing(k - 1, 2))
            end if
            is_thick = rise > tiny(rise)
            if (.not. is_thick) return
            rate = 1.0_wp/course%dt
            speed = rate/real(impact%face%per_shear_speed(cmplx(rate, kind=wp)), wp)
            length = x*(max(0.0_wp, here - axis(k) - passing(k, 1))*rate*x/(rise*speed)) &
               **(1.0_wp/(power - 1.0_wp))
         end associate
         time = length/speed
         is_thick = time <= real(k, wp)*course%dt .and. (impact%face%base == base_half_space &
            .or. length <= impact%face%thickness)
      end subroutine find_time_of_waves

      !> Displacement of a node by the waves that pass
      pure function passing(step, node) result(displacement)
         !> Step, and 1: on the axis, 2: at `kernel%beside`
         integer, intent(in) :: step, node
         !> Displacement [m], 0 without waves
         real(wp) :: displacement

         integer :: first

         displacement = 0.0_wp
         if (.not. allocated(kernel%passing)) return
         associate (n => kernel%mesh%hats, lags => size(kernel%passing, 2))
            first = max(1, step - lags + 1)
            displacement = sum(kernel%passing(:, lags - step + first:, node) &
               *reshape(hats(n*(first - 1) + 1:n*step), [n, step - first + 1]))
         end associate
      end function passing
   end subroutine end_contact

   !> Part of the pressure of a compression that is left after the last of the steps
   pure function relaxed(local) result(part)
      !> Weights of the springs, shape (0:steps)
      real(wp), intent(in) :: local(0:)
      real(wp) :: part

      real(wp) :: pressure(0:ubound(local, 1))
      integer :: n

      do n = 0, ubound(local, 1)
         pressure(n) = 1.0_wp - sum(local(n:1:-1)*pressure(:n - 1))/local(0)
      end do
      part = pressure(ubound(local, 1))
   end function relaxed

   !> End of a compression between the last step in which it is positive and the next. While the
   !> edge is slower than the waves it falls as a line, and as soon as it is 0 the face moves
   !> otherwise: a parabola through its last values ends there. Once the edge is faster, the
   !> pressure does not know of it and falls steadily in time and radius, P ~ (t0 - t) - r^2; the
   !> compression is its integral across the contact and falls as the power 3/2 of the time left.
   !> It is then nearly the same line on both sides of 0, which the parabola reaches too early. The
   !> two enclose the end
   pure subroutine end_of_fall(axis, steps, error)
      !> Compression on the axis in the last steps [m], the contact over in the last
      real(wp), intent(in) :: axis(:)
      !> Steps from the end of the fall to the last step, and their error
      real(wp), intent(out) :: steps, error

      real(wp) :: fall, bend, slope, square, line, parabola
      integer :: n

      n = findloc(axis > 0.0_wp, .true., dim=1, back=.true.)
      ! of a ring that is left behind no more than the last step in contact is known
      steps = 0.5_wp
      error = 0.5_wp
      if (n < 3 .or. n < size(axis) - 2 .or. n == size(axis)) return
      line = axis(n)/(axis(n) - axis(n + 1))
      ! u(x) = u - fall x + bend x (x + 1)/2, x steps after the last
      fall = axis(n - 1) - axis(n)
      bend = axis(n) - 2.0_wp*axis(n - 1) + axis(n - 2)
      slope = fall - 0.5_wp*bend
      square = slope**2 - 2.0_wp*bend*axis(n)
      parabola = 1.0_wp
      if (slope > 0.0_wp .and. square >= 0.0_wp) &
         parabola = min(1.0_wp, 2.0_wp*axis(n)/(slope + sqrt(square)))
      steps = real(size(axis) - n, wp) - 0.5_wp*(line + parabola)
      error = 0.5_wp*abs(line - parabola)
   end subroutine end_of_fall

   !> Time by which the waves advance the end of the contact, over L/c: by marches of a body that is
   !> withdrawn at the speed V from an elastic half space, with 200 steps in L/c
   !> (tests/reference/end_of_contact.py). The compression under a sphere ends as the power 3/2 of
   !> the time left, of a soft striker after a longer line; the roots of both enclose the end, and
   !> the polynomial is within 0.005 of their middle. The force under blunter bodies ends as the
   !> power 2 of it or, of a soft striker, as 3/2 and less; the polynomial is within 0.01 of the
   !> larger of the root of the first and the last step in contact, for n = 2.5, 3, 4, 6 and 12. Of
   !> a soft striker the waves are a small perturbation, by the first factor
   elemental function advance(poisson_ratio, striker_share, start_exponent)
      !> Poisson's ratio of the plate [-]
      real(wp), intent(in) :: poisson_ratio
      !> Part of the striker in the local compliance, 0 (rigid) to 1
      real(wp), intent(in) :: striker_share
      !> Exponent of the law of the static contact at its start, 1 + 1/n of a body x^n, n >= 2
      real(wp), intent(in) :: start_exponent
      real(wp) :: advance

      ! coefficients of powers of Poisson's ratio, for each power of the part of the striker, for
      ! each power of 1 - 2/n
      real(wp), parameter :: c(0:2, 0:3, 0:2) = reshape([ &
         0.055_wp, 0.071_wp, -0.174_wp, &
         0.270_wp, 0.332_wp, -1.873_wp, &
         1.287_wp, -2.272_wp, 5.414_wp, &
         -0.804_wp, 1.081_wp, -2.286_wp, &
         0.728_wp, 0.175_wp, -1.974_wp, &
         3.199_wp, -5.684_wp, 11.880_wp, &
         -7.790_wp, 8.312_wp, -4.683_wp, &
         4.178_wp, -2.655_wp, -6.106_wp, &
         -0.083_wp, -0.601_wp, 2.903_wp, &
         -2.909_wp, 3.904_wp, -5.271_wp, &
         5.072_wp, -1.672_wp, -15.730_wp, &
         -2.340_wp, -1.827_wp, 20.063_wp], [3, 4, 3])
      real(wp) :: blunt, at(0:3)

      blunt = 2.0_wp*(round - start_exponent)
      at = matmul([1.0_wp, poisson_ratio, poisson_ratio**2], &
         c(:, :, 0) + blunt*(c(:, :, 1) + blunt*c(:, :, 2)))
      associate (s => striker_share)
         advance = (1.0_wp - s)*(at(0) + s*(at(1) + s*(at(2) + s*at(3))))
      end associate
   end function advance

   !> Free flight of the sphere from the end of the contact on
   pure subroutine leave(course, impact)
      !> The course, with contact time and impulse
      type(course_t), intent(inout) :: course
      type(impact_t), intent(in) :: impact

      real(wp) :: flight

      associate (k => course%steps)
         course%velocity(k) = impact%free_velocity(course%contact_time) &
            - course%impulse/impact%mass
         flight = real(k, wp)*course%dt - course%contact_time
         course%z(k) = course%z(k) - (course%velocity(k) + 0.5_wp*impact%gravity*flight)*flight
      end associate
   end subroutine leave

end module vcor_solver_coupled_end
