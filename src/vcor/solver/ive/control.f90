!> Control of the lengths of panels: which are refused, and how long the next one is
!>
!> A panel of p stages adds to the difference of the two solutions a share that falls as the power
!> 2p - 2 of its length. `excess` is that share over what a panel may add, so a panel is accepted if
!> it is at most 1. The exceptions have their reasons at `is_refused` and `shorten`.
module vcor_solver_ive_control
   use vcor_kinds, only : wp
   use vcor_tuning, only : ive_cut, ive_part, ive_safety, ive_tolerable
   implicit none
   private

   public :: control_t, length_factor

   !> State of the control
   type :: control_t
      !> Difference of the two solutions that a panel may add, over the reference velocity, and
      !> accuracy of the results [-]
      real(wp) :: tolerance = 0.0_wp, accuracy = 0.0_wp
      !> What the panel adds to the difference of the motion, over the reference velocity [-]
      real(wp) :: growth = 0.0_wp
      !> What the panel adds to the difference of results over what it may add
      real(wp) :: excess = 0.0_wp
      !> `excess` of the panel refused before at this place, and its duration [s]; huge if none was
      real(wp) :: refused = huge(1.0_wp), refused_duration = 0.0_wp
      !> `excess` of the last panel of the contact that was refused before
      real(wp) :: refused_end = huge(1.0_wp)
      !> Duration wanted for the next panel, and that allowed for the last one of a rebound [s]
      real(wp) :: length = 0.0_wp, end_length = 0.0_wp
      !> An end that was found [s], and the time before which it is not tried again [s]
      real(wp) :: end_found = 0.0_wp, lead = 0.0_wp
      !> Number of panels of a rebound in which t1 seems to rise, and the end of the first one [s]
      integer :: growths = 0
      real(wp) :: growth_end = 0.0_wp
   contains
      procedure :: is_refused, shorten, halve
   end type control_t

contains

   !> Whether the panel is refused
   !>
   !> within: it adds no more than a panel may. A NaN is not within
   !>
   !> stalled: the panel before, longer and refused at the same place, added less than twice as
   !>    much, where the order of the rule makes it thousands of times as much. What is left is
   !>    inherited from earlier panels, or rounding, and no length removes it. Without it an impact
   !>    of a fractional material takes 52 panels in place of 34 at 1e-10. Not at first contact,
   !>    where nothing is inherited; not above `ive_tolerable`, since a force that jumps between two
   !>    nodes stalls as well
   !>
   !> settled_end: the same for the panel that ends the contact, if only the time of the end is in
   !>    excess and the motion is within the tolerance. The time at which a force falls to zero
   !>    with hardly a slope is known to rounding over that slope, which may be any multiple of the
   !>    accuracy: no bound applies. It concerns nearly fluid plates and springs of next to nothing,
   !>    which have no result at fine accuracies without it, and none of 630 usual impacts. A panel
   !>    without an end (huge) is refused all the same
   elemental function is_refused(self, ends, at_first_contact) result(refused)
      class(control_t), intent(in) :: self
      !> Whether the panel ends the contact
      logical, intent(in) :: ends
      !> Whether it begins with the contact
      logical, intent(in) :: at_first_contact
      logical :: refused

      logical :: within, stalled, settled_end

      within = self%excess <= 1.0_wp
      stalled = self%excess <= ive_tolerable .and. self%excess > 0.5_wp*self%refused &
         .and. .not. at_first_contact
      settled_end = ends .and. self%growth <= self%tolerance .and. self%excess < huge(1.0_wp) &
         .and. self%excess > 0.5_wp*self%refused_end
      refused = .not. (within .or. stalled .or. settled_end)
   end function is_refused

   !> Shorten a panel that was refused
   !>
   !> At the end of a growing contact the force has the branch point of u(s) at s = 0, and the error
   !> falls only as s u(s), with the power 1 + n of what is left of the contact, whatever the number
   !> of stages. The part `left` that may remain for the last panel follows from that power; panels
   !> of ordinary length lead to `lead`, where it begins. Without this the last panel would be cut
   !> again and again by the order of the rule, each time for a few per cent of the error.
   !>
   !> Elsewhere the order of the rule decides, unless two refusals at this place tell a lower one:
   !> where a mode settles within the panel the order is about 1. With the full order such panels
   !> are shortened by a few per cent at a time, each for the price of two solutions: the impact
   !> above takes 60 panels in place of 34.
   pure subroutine shorten(self, duration, stages, ends, start, recedes, start_exponent)
      class(control_t), intent(inout) :: self
      !> Duration of the panel, which is after an event the time to it [s]
      real(wp), intent(in) :: duration
      !> Stages of the finer solution
      integer, intent(in) :: stages
      !> Whether the panel ends the contact
      logical, intent(in) :: ends
      !> Its start [s]
      real(wp), intent(in) :: start
      !> Whether the contact recedes
      logical, intent(in) :: recedes
      !> Exponent n of u(s) ~ s^n at s = 0
      real(wp), intent(in) :: start_exponent

      real(wp) :: order, left, last, shorter

      last = self%refused
      self%refused = self%excess
      if (ends) self%refused_end = self%excess
      if (ends .and. .not. recedes) then
         self%end_found = start + duration
         order = 1.0_wp + start_exponent
         left = min(1.0_wp - ive_part, max((1.0_wp - ive_part)**4, self%excess**(-1.0_wp/order)))
         self%lead = self%end_found - 1.001_wp*left*duration
         self%length = duration
         return
      end if
      order = real(2*stages - 2, wp)
      if (last < huge(last) .and. self%refused_duration > duration) order = max(1.0_wp, &
         min(order, log(last/self%excess)/log(self%refused_duration/duration)))
      self%refused_duration = duration
      shorter = duration*max(ive_cut, length_factor(max(1.0_wp, self%excess), order))
      if (ends) then
         self%end_length = shorter
      else
         self%length = shorter
      end if
   end subroutine shorten

   !> Halve a panel whose equations cannot be solved
   pure subroutine halve(self, duration, start)
      class(control_t), intent(inout) :: self
      !> Its duration and its start [s]
      real(wp), intent(in) :: duration, start

      self%length = 0.5_wp*duration
      self%end_length = min(self%end_length, self%length)
      ! the end is not where it seemed to be
      if (start < self%lead) self%lead = 0.0_wp
   end subroutine halve

   !> Factor from the length of a panel to one with an excess of 1, in steps: rounding in a small
   !> difference must not move the panels
   elemental function length_factor(excess, order) result(factor)
      real(wp), intent(in) :: excess
      !> Power of the length with which the excess grows
      real(wp), intent(in) :: order
      real(wp) :: factor

      ! of 109 random impacts 8 steps make 4 per cent more panels, and 1000 save less than one
      real(wp), parameter :: steps = 16.0_wp

      factor = aint(steps*ive_safety*min(excess**(-1.0_wp/order), 1.0_wp/epsilon(1.0_wp)))/steps
   end function length_factor

end module vcor_solver_ive_control
