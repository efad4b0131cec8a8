!> What the data say nothing about: what relaxes before they begin and after they end
!>
!> A modulus that still falls where the data end goes on falling, and no datum tells how far. A law
!> of few parameters says how, and is right if it is the law of the material. A series has no say:
!> what relaxes later is part of its equilibrium modulus, and its slowest term lies in between. The
!> same holds where the data begin. So what the standard error of a modulus is worth depends on the
!> slope at that end: if a decade more of it is more than the standard error, the error is only that
!> of a material that the model describes beyond the data too. So is that of a relaxation time
!> beyond the data.
module vcor_fit_ends
   use vcor_kinds, only : wp
   use vcor_fit_result, only : fit_t, state_free, unseen_earlier, unseen_later
   use vcor_fit_samples, only : samples_t
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: mark_ends

   !> Change of the modulus over a decade that is none: for a series as good as any data, for a law,
   !> which goes on by itself, more
   real(wp), parameter :: flat_series = 5.0e-3_wp, flat_law = 0.1_wp

contains

   !> Mark the parameters whose values depend on what the data do not show
   subroutine mark_ends(fit, material, samples)
      !> The fit, with standard errors
      type(fit_t), intent(inout) :: fit
      !> Its material
      class(material_t), intent(in) :: material
      !> The samples
      type(samples_t), intent(in) :: samples

      real(wp) :: early, late, error, time
      integer :: i, n

      associate (flat => merge(flat_series, flat_law, fit%data%model == 'prony'))
         early = fall(material, samples%first_time(), samples%dynamic, flat)
         late = fall(material, samples%last_time(), samples%dynamic, flat)
      end associate
      n = size(fit%parameters)
      error = 0.0_wp
      do i = 1, n
         associate (parameter => fit%parameters(i))
            ! a time of a series goes with its modulus
            if (parameter%name /= 'times') error = parameter%error
            if (parameter%state /= state_free) cycle
            select case (parameter%name)
            case ('equilibrium_modulus')
               if (late > error) parameter%unseen = unseen_later
            case ('alpha')
               ! the rubbery modulus is glassy_modulus*alpha/beta
               if (late > fit%data%number('glassy_modulus')*error/fit%data%number('beta')) &
                  parameter%unseen = unseen_later
            case ('glassy_modulus', 'relaxing_modulus')
               if (early > error) parameter%unseen = unseen_earlier
            case ('moduli', 'times')
               if (i <= 3 .and. early > error) parameter%unseen = unseen_earlier
               if (i >= n - 1 .and. late > error) parameter%unseen = unseen_later
            case ('beta', 'time')
               time = parameter%value
               if (parameter%name == 'beta') time = 1.0_wp/time
               if (fit%data%model == 'cerf') time = time**2
               if (time < samples%first_time()) parameter%unseen = unseen_earlier
               if (time > samples%last_time()) parameter%unseen = unseen_later
            case default
               continue
            end select
         end associate
      end do
   end subroutine mark_ends

   !> Fall of the modulus over a decade, by its slope; 0 where it is flat
   function fall(material, time, dynamic, flat) result(change)
      !> The material
      class(material_t), intent(in) :: material
      !> Time [s]
      real(wp), intent(in) :: time
      !> Whether it is that of the storage modulus at the angular frequency 1/time
      logical, intent(in) :: dynamic
      !> Part of the modulus that is no change
      real(wp), intent(in) :: flat
      !> Fall of the relaxation modulus, or of the storage modulus [Pa]
      real(wp) :: change

      !> Half the step of the difference
      real(wp), parameter :: step = 1.0e-3_wp
      real(wp) :: moduli(2), times(2)

      times = time*exp([-step, step])
      if (dynamic) then
         moduli = real(material%complex_modulus(cmplx(0.0_wp, 1.0_wp/times, wp)), wp)
      else
         moduli = material%relaxation(times)
      end if
      change = log(10.0_wp)*(moduli(1) - moduli(2))/(2.0_wp*step)
      if (change <= flat*moduli(2)) change = 0.0_wp
   end function fall

end module vcor_fit_ends
