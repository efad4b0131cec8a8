!> The numbers of an outcome under the names that files, the screen and --print use
module vcor_sweep_quantity
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : columns, contact_lasting, contact_separated, &
      contact_sticking
   use vcor_kinds, only : wp
   implicit none
   private

   public :: quantity_t, quantities, history_quantities
   public :: quantity_value, quantity_values, quantity_names, status_label, status_name, &
      status_code
   public :: status_t, statuses, point_pending, point_invalid, point_failed, longest_status

   !> Status of a point of a sweep beside the `contact_*` constants: it is not solved yet
   integer, parameter :: point_pending = -1
   !> Its parameters describe no impact
   integer, parameter :: point_invalid = 3
   !> The numerical solution failed
   integer, parameter :: point_failed = 4
   !> Letters of the longest name of a status
   integer, parameter :: longest_status = len('no_separation')

   !> One status
   type :: status_t
      !> One of the `contact_*` and `point_*` constants
      integer :: code
      !> Its name in the column `status`
      character(len=longest_status) :: name
      !> What it says, one line
      character(len=64) :: meaning
      !> What to do about it, one line
      character(len=96) :: advice
   end type status_t

   !> All that a contact, or a point of a sweep, may come to
   type(status_t), parameter :: statuses(*) = [ &
      status_t(contact_separated, 'separated', 'the force returned to zero: the normal end', ''), &
      status_t(contact_lasting, 'no_separation', &
      'end_time came before the force returned to zero', 'a larger solver.end_time; a thicker ' &
      //'plate where the inelasticity is above 20'), &
      status_t(contact_sticking, 'sticks', 'all motion died out in contact', 'nothing: the plate ' &
      //'is too light for it (inelasticity above about 5), or the material flows'), &
      status_t(point_invalid, 'invalid', &
      'in a sweep: the values of the point make no impact', &
      'the message says which one is out of range, or contradicts others'), &
      status_t(point_failed, 'failed', 'in a sweep: the numerical solution failed', &
      'the message says why; the other method, by solver.method, may succeed'), &
      status_t(point_pending, 'pending', 'in a sweep: the point is not solved yet', &
      'the same command with --resume')]

   !> One quantity
   type :: quantity_t
      !> Name of the column
      character(len=20) :: name
      !> Symbol in the paper and in docs/theory.md
      character(len=8) :: symbol
      !> Unit; 1 for a pure number
      character(len=8) :: unit
      !> What it is
      character(len=56) :: meaning
   end type quantity_t

   !> Numbers of a summary, in the order of its columns; steps and status follow
   type(quantity_t), parameter :: quantities(*) = [ &
      quantity_t('cor', 'e', '1', 'coefficient of restitution, relative velocity'), &
      quantity_t('cor_sphere', 'e_a', '1', 'coefficient of restitution, sphere alone'), &
      quantity_t('contact_time', 't0', 's', 'contact time'), &
      quantity_t('max_indentation', 's_max', 'm', 'largest indentation'), &
      quantity_t('max_force', 'F_max', 'N', 'largest contact force'), &
      quantity_t('residual_indentation', 's(t0)', 'm', 'indentation left at separation'), &
      quantity_t('residual_ratio', 's0/smax', '1', 'residual over largest indentation'), &
      quantity_t('hysteresis_energy', 'W_h', 'J', 'energy lost in the contact'), &
      quantity_t('wave_energy', 'W_wave', 'J', 'energy radiated into the plate'), &
      quantity_t('initial_energy', 'KE_0', 'J', 'kinetic energy before the impact'), &
      quantity_t('energy_imbalance', 'dW', 'J', 'what the energy budget misses'), &
      quantity_t('min_frequency', 'w_min', 'rad/s', 'lowest frequency of interest, 2 pi/t0'), &
      quantity_t('inelasticity', 'lambda', '1', "Zener's inelasticity parameter"), &
      quantity_t('loss_tangent', 'tan(d)', '1', 'loss tangent at min_frequency'), &
      quantity_t('cor_error', 'de', '1', 'estimated error of cor'), &
      quantity_t('cor_sphere_error', 'de_a', '1', 'estimated error of cor_sphere')]

   !> Columns of a history, in the order of the rows of a trajectory's state
   type(quantity_t), parameter :: history_quantities(columns) = [ &
      quantity_t('time', 't', 's', 'time since first contact'), &
      quantity_t('indentation', 's', 'm', 'indentation'), &
      quantity_t('relative_velocity', "s'", 'm/s', 'rate of the indentation'), &
      quantity_t('force', 'F', 'N', 'contact force'), &
      quantity_t('impulse', 'I', 'N s', 'impulse of the contact force'), &
      quantity_t('sphere_displacement', 'z', 'm', 'displacement of the sphere'), &
      quantity_t('sphere_velocity', "z'", 'm/s', 'velocity of the sphere'), &
      quantity_t('plate_displacement', 'U', 'm', 'displacement of the plate'), &
      quantity_t('plate_velocity', "U'", 'm/s', 'velocity of the plate')]

contains

   !> Value of a quantity, NaN where the impact did not end in separation
   pure function quantity_value(outcome, index) result(value)
      !> Outcome
      type(outcome_t), intent(in) :: outcome
      !> Place of the quantity in `quantities`
      integer, intent(in) :: index
      !> Value, in its unit
      real(wp) :: value

      real(wp) :: all_values(size(quantities))

      all_values = quantity_values(outcome)
      value = all_values(index)
   end function quantity_value

   !> Values of all quantities, NaN where the impact did not end in separation
   pure function quantity_values(outcome) result(values)
      !> Outcome
      type(outcome_t), intent(in) :: outcome
      !> Values, each in its unit, in the order of `quantities`
      real(wp) :: values(size(quantities))

      values = [outcome%cor, outcome%cor_sphere, outcome%contact_time, &
         outcome%max_indentation, outcome%max_force, outcome%residual_indentation, &
         outcome%residual_ratio, outcome%hysteresis_energy, outcome%wave_energy, &
         outcome%initial_energy, outcome%energy_imbalance, outcome%min_frequency, &
         outcome%inelasticity, outcome%loss_tangent, outcome%cor_error, &
         outcome%cor_sphere_error]
      if (outcome%status == contact_separated) return
      values = ieee_value(1.0_wp, ieee_quiet_nan)
      ! a contact that does not end has at least begun
      if (any(outcome%status == [contact_lasting, contact_sticking])) &
         where (quantities%name == 'initial_energy') values = outcome%initial_energy
   end function quantity_values

   !> Names of all columns of a summary, steps and status included, separated by blanks
   pure function quantity_names() result(names)
      !> Names
      character(len=:), allocatable :: names

      integer :: i

      names = ''
      do i = 1, size(quantities)
         names = names//trim(quantities(i)%name)//' '
      end do
      names = names//'steps status'
   end function quantity_names

   !> Name of a status
   pure function status_name(status) result(name)
      !> One of the `contact_*` and `point_*` constants
      integer, intent(in) :: status
      !> separated, no_separation, sticks, invalid, failed or pending
      character(len=:), allocatable :: name

      name = trim(status_label(status))
   end function status_name

   !> The same with blanks at its end
   elemental function status_label(status) result(label)
      !> One of the `contact_*` and `point_*` constants
      integer, intent(in) :: status
      !> Name
      character(len=longest_status) :: label

      integer :: i

      do i = 1, size(statuses)
         if (statuses(i)%code == status) exit
      end do
      label = 'failed'
      if (i <= size(statuses)) label = statuses(i)%name
   end function status_label

   !> Status by its name
   pure function status_code(name) result(status)
      !> Its name
      character(len=*), intent(in) :: name
      !> One of the `contact_*` and `point_*` constants; pending where there is no such name
      integer :: status

      integer :: i

      status = point_pending
      do i = 1, size(statuses)
         if (statuses(i)%name == name) status = statuses(i)%code
      end do
   end function status_code

end module vcor_sweep_quantity
