!> Bounces of a sphere under its weight: what is known of each, and how the motion ended
module vcor_impact_bounces
   use vcor_kinds, only : unset, wp
   implicit none
   private

   public :: bounce_t, bounces_t, ends_none, ends_count, ends_rest, ends_time, ends_contact, &
      ends_error, end_names

   !> How the motion ended: nothing has been solved yet
   integer, parameter :: ends_none = 0
   !> After the number of bounces asked for
   integer, parameter :: ends_count = 1
   !> The weight keeps the sphere in contact for good
   integer, parameter :: ends_rest = 2
   !> At the end time
   integer, parameter :: ends_time = 3
   !> In a contact that lasts
   integer, parameter :: ends_contact = 4
   !> Later bounces are not known to the accuracy that results need
   integer, parameter :: ends_error = 5

   !> Names of these ends, the first one that of `ends_none`
   character(len=*), parameter :: end_names(0:5) = [character(len=8) :: 'none', 'count', 'rest', &
      'end_time', 'contact', 'accuracy']

   !> A bounce
   type :: bounce_t
      !> First touch since the first one of all [s], and velocity of the sphere then [m/s]
      real(wp) :: time = 0.0_wp
      real(wp) :: velocity = 0.0_wp
      !> Velocity of the sphere after the bounce over that before it [-], and estimated error
      real(wp) :: cor = unset
      real(wp) :: cor_error = unset
      !> Last separation since the first touch of all [s]
      real(wp) :: separation = unset
      !> Largest height of the flight after it above the undisturbed surface [m]
      real(wp) :: height = unset
      !> Number of contacts with a structure
      integer :: contacts = 1
      !> Largest force [N] and indentation [m]
      real(wp) :: max_force = 0.0_wp
      real(wp) :: max_indentation = 0.0_wp
   end type bounce_t

   !> The bounces of an impact
   type :: bounces_t
      !> The bounces, used up to `count`
      type(bounce_t), allocatable :: list(:)
      integer :: count = 0
      !> One of the `ends_*` constants
      integer :: ending = ends_none
      !> Time of the end [s]: of the last separation, of the touch after which the sphere stays in
      !> contact, or the end time; and its estimated error [s]
      real(wp) :: total_time = 0.0_wp
      real(wp) :: total_time_error = unset
   contains
      procedure :: add
   end type bounces_t

contains

   !> Add a bounce
   pure subroutine add(self, bounce)
      class(bounces_t), intent(inout) :: self
      type(bounce_t), intent(in) :: bounce

      type(bounce_t), allocatable :: longer(:)

      if (.not. allocated(self%list)) allocate (self%list(16))
      if (self%count == size(self%list)) then
         allocate (longer(2*self%count))
         longer(:self%count) = self%list
         call move_alloc(longer, self%list)
      end if
      self%count = self%count + 1
      self%list(self%count) = bounce
   end subroutine add

end module vcor_impact_bounces
