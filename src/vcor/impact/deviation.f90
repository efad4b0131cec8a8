!> Change of cor_sphere that exact mechanics would make, predicted from the impact as it was
!> computed
!>
!> Exact mechanics are the waves of the face as it is, a contact that recedes, and two bodies in
!> series. To first order the impact is an oscillator, 1/(m s^2) + C(s) = 0 with the compliance C of
!> contact and face, whose root s = w (i - eta) has w = pi/t0 and, as e = exp(-pi eta) of a motion
!> exp(st) over half a period, eta = -ln(e)/pi. A change dC moves the root and e by
!>
!>     d ln s = -(dC/C)/(2 + n),   n = d ln C/d ln s,   d ln e = -pi (1 + eta^2) Im d ln s
!>
!> A pulse is no single frequency: with the correlation R of the forces of the motion and of its
!> adjoint, exp(eta w u) times the autocorrelation of the pulse, a compliance c that moves the face
!> gives
!>
!>     W = -k int R'(u) c(u) du,   X = k w int R(u) c(u) du,   d ln e = (1 + eta^2)/(2 + n)
!>         (2 eta X - (1 - eta^2) W)
!>
!> where k makes W the share of the initial energy that c takes from an elastic impact. R is a sum
!> of exponentials, so W and X are values of c(s) at their exponents. docs/theory.md derives all
!> this.
module vcor_impact_deviation
   use vcor_impact_face, only : base_half_space
   use vcor_impact_mobility, only : mobility_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : pi, wp
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: face_losses_t, face_losses, predict

   !> Exponents of the autocorrelation of Hertz' pulse F(u), 0 < u < 1, of largest value 1, and
   !> their amplitudes: int F(v) F(v - u) dv = Re sum A exp(-q u), off by 8e-4 at most of 0.411,
   !> with its exact value and both derivatives at 0
   complex(wp), parameter :: exponents(2) = [(3.89749_wp, 6.97816_wp), (4.89107_wp, 2.31967_wp)]
   complex(wp), parameter :: amplitudes(2) = [(-0.147939_wp, 0.0799885_wp), &
      (0.559281_wp, 0.690063_wp)]
   !> int F du of this pulse
   real(wp), parameter :: impulse_share = 0.543341_wp
   !> Radius of the contact over its largest, in the mean of its square weighted by F^2
   real(wp), parameter :: radius_share = 0.94_wp

   !> What a pulse of force does to a face
   type :: face_losses_t
      !> W of the face as it is and of the model's [-], and X of their difference [-]
      real(wp) :: real_face = 0.0_wp, model = 0.0_wp, reaction = 0.0_wp
   end type face_losses_t

contains

   !> Predict the change of cor_sphere, and set the share of energy that is missing
   pure subroutine predict(outcome, impact, sphere, plate, modulus, plate_modulus, is_exact, &
                           losses)
      !> Outcome of a separation, its loss tangent at pi/t0 set; on return cor_deviation is set, and
      !> wave_loss if there are losses
      type(outcome_t), intent(inout) :: outcome
      type(impact_t), intent(in) :: impact
      class(material_t), intent(in) :: sphere
      class(material_t), intent(in) :: plate
      !> Modulus of the contact at i pi/t0 [Pa]
      complex(wp), intent(in) :: modulus
      !> Modulus of the plate there [Pa], Young's; 0 for a rigid one
      complex(wp), intent(in) :: plate_modulus
      !> Whether the contact is solved as one with the face: law and pair are exact
      logical, intent(in) :: is_exact
      !> Losses to the face; absent: there is no face that takes any
      type(face_losses_t), intent(in), optional :: losses

      ! second order in the loss: measured on half spaces, where half of the energy is missing
      real(wp), parameter :: second = 0.3_wp
      ! where parts of opposite sign cancel, what is left is at least this share of their sum, or
      ! eta^2: a plate that takes nearly all skews the pulse, which the correlation leaves out
      real(wp), parameter :: trust = 0.2_wp
      type(face_losses_t) :: face
      complex(wp) :: series
      real(wp) :: e, eta, slope, change, part, whole, weight, more

      e = floor_of(outcome%cor_sphere)
      eta = -log(e)/pi
      if (present(losses)) face = losses
      part = eta*face%model/pi
      slope = -2.0_wp/pi*atan(outcome%peak_loss_tangent)*(1.0_wp - part) - part
      part = (1.0_wp + eta**2)/(2.0_wp + max(slope, -1.0_wp))
      change = part*(2.0_wp*eta*face%reaction &
         - (1.0_wp - eta**2)*(face%real_face - face%model))
      whole = part*(2.0_wp*eta*abs(face%reaction) &
         + abs((1.0_wp - eta**2)*(face%real_face - face%model)))
      change = change*(1.0_wp + second*bounded(abs(change)))
      if (.not. is_exact) then
         if (.not. (sphere%rigid .or. plate%rigid)) then
            series = 1.0_wp/(sphere%complex_modulus(cmplx(0.0_wp, pi/outcome%contact_time, wp)) &
               *sphere%plane_strain_factor()) + 1.0_wp/(plate_modulus*plate%plane_strain_factor())
            more = pi*part*aimag(series*modulus)
            change = change + more
            whole = whole + abs(more)
         end if
         if (.not. impact%law%receding) then
            more = law_change(outcome, impact)
            change = change + more
            whole = whole + more
         end if
      end if
      change = sign(max(abs(change), max(trust, eta**2)*whole), change)
      ! under the weight the pulse is larger than the impulse of the impact, and so is that of the
      ! adjoint motion, which meets the bodies with the velocity of their separation
      weight = impact%gravity*outcome%contact_time/impact%velocity
      change = change*(1.0_wp + 0.5_wp*weight)*(1.0_wp + 0.5_wp*weight/e)
      outcome%cor_deviation = e*(exp(bounded(change)) - 1.0_wp)
      if (.not. present(losses)) return
      part = (0.5_wp*(1.0_wp + e + weight))**2
      outcome%wave_loss = kept(part*face%model) - kept(part*face%real_face)
   end subroutine predict

   !> An exponent, in the range in which exp has a meaning here
   pure function bounded(exponent)
      real(wp), intent(in) :: exponent
      real(wp) :: bounded

      ! exp(-5) = 7e-3: more of the energy than this is lost, and the change is outside in any case
      real(wp), parameter :: most = 5.0_wp

      bounded = min(max(exponent, -most), most)
   end function bounded

   !> Share of the energy that waves leave; none are a source
   pure function kept(loss)
      !> Share that a small pulse would lose [-]
      real(wp), intent(in) :: loss
      real(wp) :: kept

      kept = exp(-bounded(max(loss, 0.0_wp)))
   end function kept

   !> Restitution that the formulas take
   pure function floor_of(restitution) result(e)
      real(wp), intent(in) :: restitution
      !> [-], in the range in which they were measured
      real(wp) :: e

      e = min(max(restitution, 0.02_wp), 1.0_wp)
   end function floor_of

   !> Exponent n of the law where the indentation is largest: 3/2 on a half space, more on a layer
   pure function exponent_of(outcome, impact) result(n)
      type(outcome_t), intent(in) :: outcome
      type(impact_t), intent(in) :: impact
      real(wp) :: n

      associate (s => outcome%max_indentation)
         n = s*impact%law%slope(s)/impact%law%u(s)
      end associate
   end function exponent_of

   !> Change of ln(e) from the integral over all the past to a contact that recedes
   !>
   !> To first order in the relaxation psi(t) = k(0) - k(t), the forces differ on the way back, t1
   !> being the time of the same indentation before, by int_t1^t psi(t - x) [u'(s(x)) - u'(s(t))]
   !> s'(x) dx: the work of this is 0.208 tan(d) of e for a loss tangent that does not depend on
   !> frequency, and in proportion to n - 1. The denominator is a fit to 150 materials with loss
   !> tangents up to 1.2, which is off by 0.003 in the mean, 0.013 at most
   pure function law_change(outcome, impact) result(change)
      type(outcome_t), intent(in) :: outcome
      type(impact_t), intent(in) :: impact
      real(wp) :: change

      change = 0.416_wp*(exponent_of(outcome, impact) - 1.0_wp)*outcome%peak_loss_tangent &
         /sqrt(1.0_wp + 9.0_wp*outcome%peak_loss_tangent)
   end function law_change

   !> Losses of the pulse of an impact to the face of its plate
   pure subroutine face_losses(losses, outcome, impact, plate, base, thickness, mobility, &
                               has_modes)
      type(face_losses_t), intent(out) :: losses
      !> Outcome of a separation, its loss tangent at pi/t0 and radius of contact set
      type(outcome_t), intent(in) :: outcome
      type(impact_t), intent(in) :: impact
      !> Material of the plate, with a density
      class(material_t), intent(in) :: plate
      !> base_half_space, base_free, base_bonded or base_sliding
      integer, intent(in) :: base
      !> Thickness H [m]; any for a half space
      real(wp), intent(in) :: thickness
      type(mobility_t), intent(inout) :: mobility
      !> Whether the model is a thin plate by its modes: up to the first reflection it is an
      !> infinite one that remembers
      logical, intent(in) :: has_modes

      complex(wp) :: s, rate, modulus, extra, thin
      real(wp) :: time, decay, factor, alpha(2)
      integer :: i

      call mobility%describe(base, plate%poisson_ratio(), atan2(aimag(exponents), &
         real(exponents, wp)))
      time = effective_time(outcome, impact)
      ! the exponents stay in the right half plane
      decay = min(-log(floor_of(outcome%cor_sphere)), 2.0_wp)
      alpha = 0.0_wp
      if (impact%target%moves() .and. .not. impact%target%hereditary()) &
         alpha = mean_alpha(impact, time)
      do i = 1, size(exponents)
         rate = exponents(i)/time
         s = (exponents(i) - decay)/time
         modulus = plate%complex_modulus(s)
         call mobility%compliance(i, s/sqrt(modulus/(2.0_wp*(1.0_wp + plate%poisson_ratio()) &
            *plate%density())), radius_share*outcome%contact_radius, thickness, extra)
         extra = extra/(modulus*plate%plane_strain_factor())
         losses%real_face = losses%real_face + real(amplitudes(i)*rate*extra, wp)
         losses%reaction = losses%reaction + real(amplitudes(i)*extra, wp)
         if (.not. (impact%target%moves() .or. has_modes)) cycle
         thin = 1.0_wp/s
         if (impact%target%hereditary() .or. has_modes) then
            thin = thin*sqrt(3.0_wp/(plate%density()*plate%plane_strain_factor()*modulus)) &
               /(4.0_wp*thickness**2)
            alpha = 1.0_wp
         end if
         losses%model = losses%model + alpha(1)*real(amplitudes(i)*rate*thin, wp)
         losses%reaction = losses%reaction - alpha(2)*real(amplitudes(i)*thin, wp)
      end do
      ! twice the momentum is the impulse of the elastic pulse, and W the energy over m v^2/2
      factor = 8.0_wp/impulse_share**2*impact%mass/time
      losses%real_face = factor*losses%real_face
      losses%model = factor*losses%model
      losses%reaction = factor*losses%reaction*pi/time
   end subroutine face_losses

   !> Duration of Hertz' pulse that is as long as the impact's, by the second moment of the force
   pure function effective_time(outcome, impact) result(time)
      type(outcome_t), intent(in) :: outcome
      type(impact_t), intent(in) :: impact
      !> Time [s]
      real(wp) :: time

      real(wp) :: n

      n = exponent_of(outcome, impact)
      ! inverse square of the width of elastic pulses of exponent n over that of Hertz' pulse, a
      ! polynomial that is exact to 1e-3 for n = 1 to 4
      time = outcome%contact_time*sqrt(26.55_wp/(11.97_wp + n*(7.94_wp + 1.183_wp*n)))
      ! a pulse of a lossy material has a tail, which the law without receding contact cuts off:
      ! both measured on half spaces
      time = time*(1.0_wp + 0.08_wp*outcome%peak_loss_tangent)
      if (.not. (impact%law%receding .or. outcome%is_coupled())) time = time &
         + 0.24_wp*(n - 1.0_wp)*sqrt(outcome%peak_loss_tangent)*outcome%contact_time
   end function effective_time

   !> Means of alpha(t) of a plate U = alpha I over the pulse, weighted as W and X weigh it: by
   !> -F' I and F I, by Gauss' rule of six nodes
   pure function mean_alpha(impact, time) result(alpha)
      type(impact_t), intent(in) :: impact
      !> Duration of the pulse [s]
      real(wp), intent(in) :: time
      !> The two means [m/(N s)]
      real(wp) :: alpha(2)

      real(wp), parameter :: node(6) = [0.03376524_wp, 0.16939531_wp, 0.38069041_wp, &
         0.61930959_wp, 0.83060469_wp, 0.96623476_wp]
      real(wp), parameter :: loss(6) = [-0.00012190_wp, -0.02876324_wp, -0.15944790_wp, &
         0.39267680_wp, 0.63914304_wp, 0.15651321_wp]
      real(wp), parameter :: reaction(6) = [0.00000768_wp, 0.00969065_wp, 0.22095454_wp, &
         0.54415161_wp, 0.21533440_wp, 0.00986113_wp]
      real(wp) :: values(6)

      values = impact%target%alpha(node*time)
      alpha = [sum(loss*values), sum(reaction*values)]
   end function mean_alpha

end module vcor_impact_deviation
