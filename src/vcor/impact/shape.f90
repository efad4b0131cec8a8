!> Shapes of the body that strikes: one table of their names and of the numbers that each has, and
!> the law of the force of each
!>
!> A new shape is three changes of this file: its name and its row in `shapes`, rows for its numbers
!> in `shape_parameters`, and its case in `describe_shape`. The keys of `&sphere`, their checks, the
!> reading of the numbers, help and sweeps over them follow.
module vcor_impact_shape
   use vcor_error, only : error_t
   use vcor_impact_law, only : cone_factor, profile_factor, punch_factor, sphere_factor
   use vcor_kinds, only : wp
   use vcor_material_type, only : parameter_t
   use vcor_number, only : interval_t, positive
   implicit none
   private

   public :: shape_t, shapes, sphere_shapes, other_shapes, shape_sphere, shape_true_sphere
   public :: shape_parameter_t, shape_parameters, describe_shape, find_shape

   !> Names of the shapes that have a radius, so that their mass follows from the density of their
   !> material, and of the others, separated by blanks
   character(len=*), parameter :: sphere_shapes = 'sphere true_sphere'
   character(len=*), parameter :: other_shapes = 'cone punch power'

   !> A shape
   type :: shape_t
      !> Its name
      character(len=16) :: name = ''
      !> What it is, one line
      character(len=112) :: meaning = ''
      !> Whether the radius of its contact follows the indentation, so that the contact recedes
      logical :: recedes = .true.
   end type shape_t

   !> The shapes
   type(shape_t), parameter :: shapes(*) = [ &
      shape_t('sphere', 'a paraboloid of this radius, as Hertz has it'), &
      shape_t('true_sphere', 'the sphere itself, for contacts that are not small'), &
      shape_t('cone', 'a cone of this half_angle'), &
      shape_t('punch', 'a flat cylinder of this punch_radius', recedes=.false.), &
      shape_t('power', 'a body of revolution z = C r^p')]
   !> Places of those that others treat apart
   integer, parameter :: shape_sphere = findloc(shapes%name == 'sphere', .true., dim=1), &
      shape_true_sphere = findloc(shapes%name == 'true_sphere', .true., dim=1)

   !> A number of a shape other than a sphere
   type :: shape_parameter_t
      !> Name of the shape
      character(len=16) :: shape = ''
      !> The number; its name is the key in &sphere
      type(parameter_t) :: parameter
   end type shape_parameter_t

   !> The numbers of all shapes but the spheres
   type(shape_parameter_t), parameter :: shape_parameters(*) = [ &
      shape_parameter_t('cone', parameter_t('half_angle', &
      'Angle between the axis of a cone and its side', 'deg', &
      interval_t(0.0_wp, 90.0_wp, .true., .true.))), &
      shape_parameter_t('punch', parameter_t('punch_radius', 'Radius of a flat punch', 'm', &
      positive)), &
      shape_parameter_t('power', parameter_t('profile_coefficient', 'C of a profile z = C r^p', &
      'm^(1-p)', positive)), &
      shape_parameter_t('power', parameter_t('profile_power', 'p of a profile z = C r^p', '', &
      interval_t(lower=1.0_wp, lower_open=.true.)))]

contains

   !> Place of a shape
   pure function find_shape(name) result(place)
      character(len=*), intent(in) :: name
      !> Place in `shapes`; 0 if there is no such shape
      integer :: place

      place = findloc(shapes%name == name, .true., dim=1)
   end function find_shape

   !> Exponent and factor of the contact law of a shape
   pure subroutine describe_shape(shape, radius, surface_radius, numbers, exponent, factor, error)
      !> Its place in `shapes`
      integer, intent(in) :: shape
      !> Radius of a sphere [m]
      real(wp), intent(in) :: radius
      !> Radius of curvature of the surface [m]: 0 = flat, negative = concave
      real(wp), intent(in) :: surface_radius
      !> Numbers of the other shapes, in the order and the units of `shape_parameters`
      real(wp), intent(in) :: numbers(size(shape_parameters))
      !> n of u ~ s^n [-]
      real(wp), intent(out) :: exponent
      !> K [m^(2-n)]
      real(wp), intent(out) :: factor
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      select case (shapes(shape)%name)
      case ('cone')
         exponent = 2.0_wp
         factor = cone_factor(value('half_angle'))
      case ('punch')
         exponent = 1.0_wp
         factor = punch_factor(value('punch_radius'))
      case ('power')
         exponent = 1.0_wp + 1.0_wp/value('profile_power')
         factor = profile_factor(value('profile_coefficient'), value('profile_power'))
      case default
         exponent = 1.5_wp
         call sphere_factor(radius, surface_radius, factor, error)
      end select

   contains

      !> Number of the shape by its name
      pure real(wp) function value(name)
         character(len=*), intent(in) :: name

         value = numbers(findloc(shape_parameters%parameter%name == name, .true., dim=1))
      end function value
   end subroutine describe_shape

end module vcor_impact_shape
