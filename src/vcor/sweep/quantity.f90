!> Columns of a summary and of a history for files, the screen and --print: names, units and values;
!> and the outcomes of many impacts by column
module vcor_sweep_quantity
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_error, only : error_file, error_t, raise
   use vcor_impact_bounces, only : bounce_t, end_names
   use vcor_impact_history, only : history_columns
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_lasting, contact_resting, &
      contact_separated, contact_sticking, contact_unknown
   use vcor_impact_validity, only : level_none, levels, thresholds
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text
   implicit none
   private

   public :: quantity_t, quantities, history_quantities, values_of, row_of
   public :: bounce_quantities, bounce_values
   public :: quantity_value, quantity_names, quantity_place, labels_of, label_length
   public :: summary_t, values_t, new_summary
   public :: status_t, statuses, status_name, point_pending, point_invalid, point_failed

   !> Status of a point of a sweep in addition to the `contact_*` constants: not solved yet. It has
   !> no name, since only finished sweeps are written
   integer, parameter :: point_pending = contact_unknown
   !> Its parameters describe no impact
   integer, parameter :: point_invalid = 3
   !> The numerical solution failed
   integer, parameter :: point_failed = 4

   !> One status
   type :: status_t
      !> One of the `contact_*` and `point_*` constants
      integer :: code
      !> Its name in the column `status`
      character(len=13) :: name
      !> Meaning, one line
      character(len=64) :: meaning
      !> Advice, one line
      character(len=96) :: advice
   end type status_t

   !> All states of a contact or of a solved point of a sweep, in the order of their codes
   type(status_t), parameter :: statuses(*) = [ &
      status_t(contact_separated, 'separated', 'the force returned to zero: the normal end', ''), &
      status_t(contact_lasting, 'no_separation', &
      'end_time came before the force returned to zero', 'plate.base where the plate lies on a ' &
      //'floor; else a thicker one, or a larger solver.end_time'), &
      status_t(contact_sticking, 'sticks', 'all motion decayed in contact', 'nothing: the plate ' &
      //'is too light for it (inelasticity above about 5), or the material flows'), &
      status_t(point_invalid, 'invalid', &
      'in a sweep: the values of the point make no impact', &
      'the message says which one is out of range, or contradicts others'), &
      status_t(point_failed, 'failed', 'in a sweep: the numerical solution failed', &
      'the message says why; the other method, by solver.method, may succeed'), &
      status_t(contact_resting, 'rests', 'its weight keeps the sphere in contact for good', &
      'nothing: residual_indentation is that at rest, of a fluid the last one')]

   !> A column of a file
   type :: quantity_t
      !> Name of the column
      character(len=20) :: name
      !> Symbol in the paper and in docs/theory.md
      character(len=8) :: symbol
      !> Unit; 1 for a pure number, empty for a text
      character(len=8) :: unit
      !> Meaning
      character(len=56) :: meaning
      !> Whether its values are whole numbers
      logical :: is_whole = .false.
      !> Texts that the numbers stand for, each after a blank; empty if the values are numbers
      character(len=320) :: labels = ''
      !> Number of the first text
      integer :: first = 0
   end type quantity_t

   !> Largest number of columns of a summary
   integer, parameter :: most = 64
   !> Length of the longest text of a column
   integer, parameter :: label_length = 20

   !> Columns of a summary, as `list_columns` fills them
   type :: list_t
      !> Number of columns
      integer :: n = 0
      !> Values
      real(wp) :: values(most) = 0.0_wp
      !> Descriptions, shape (most); unallocated if only values are needed
      type(quantity_t), allocatable :: quantities(:)
   contains
      procedure :: add
   end type list_t

   !> Values of one column, shape (points); NaN or 0 if a point has none or is new
   type :: values_t
      !> Real numbers, in their unit
      real(wp), allocatable :: reals(:)
      !> Whole numbers, and numbers of texts
      integer, allocatable :: integers(:)
   end type values_t

   !> Outcomes of many impacts, by column
   type :: summary_t
      !> Descriptions of the columns, the status last
      type(quantity_t), allocatable :: quantities(:)
      !> Values of all columns except the status, in the order of `quantities`
      type(values_t), allocatable :: values(:)
      !> Status, one of the `contact_*` and `point_*` constants, shape (points)
      integer, allocatable :: status(:)
      !> Whether the estimated error is above the accuracy requested, shape (points)
      logical, allocatable :: inexact(:)
   contains
      procedure :: put, row
   end type summary_t

   !> Columns of a history, in the order of its rows
   type(quantity_t), parameter :: history_quantities(history_columns) = [ &
      quantity_t('time', 't', 's', 'time since first contact'), &
      quantity_t('indentation', 's', 'm', 'indentation'), &
      quantity_t('relative_velocity', "s'", 'm/s', 'rate of the indentation'), &
      quantity_t('force', 'F', 'N', 'contact force'), &
      quantity_t('impulse', 'I', 'N s', 'impulse of the contact force'), &
      quantity_t('sphere_displacement', 'z', 'm', 'displacement of the sphere'), &
      quantity_t('sphere_velocity', "z'", 'm/s', 'velocity of the sphere'), &
      quantity_t('plate_displacement', 'U', 'm', 'displacement of the plate'), &
      quantity_t('plate_velocity', "U'", 'm/s', 'velocity of the plate'), &
      quantity_t('contact_radius', 'a', 'm', 'radius of the contact')]

   !> Columns of bounces, in the order of `bounce_values`
   type(quantity_t), parameter :: bounce_quantities(*) = [ &
      quantity_t('bounce', 'n', '1', 'number of the bounce', is_whole=.true.), &
      quantity_t('time', 't', 's', 'first touch, since that of the first bounce'), &
      quantity_t('velocity', 'v', 'm/s', 'velocity of the sphere at first touch'), &
      quantity_t('cor', 'e', '1', 'velocity of the sphere after over that before'), &
      quantity_t('cor_error', 'de', '1', 'estimated error of cor'), &
      quantity_t('contacts', 'n', '1', 'number of contacts with a structure', is_whole=.true.), &
      quantity_t('last_separation', 't_n', 's', 'last separation, since the first touch of all'), &
      quantity_t('rebound_height', 'H', 'm', 'height of the flight above the surface at rest'), &
      quantity_t('max_force', 'F_max', 'N', 'largest contact force'), &
      quantity_t('max_indentation', 's_max', 'm', 'largest indentation')]

contains

   !> Values of a bounce
   pure function bounce_values(number, bounce) result(values)
      !> Its number
      integer, intent(in) :: number
      type(bounce_t), intent(in) :: bounce
      !> Values, each in its unit, in the order of `bounce_quantities`
      real(wp) :: values(size(bounce_quantities))

      values = [real(number, wp), bounce%time, bounce%velocity, bounce%cor, bounce%cor_error, &
         real(bounce%contacts, wp), bounce%separation, bounce%height, bounce%max_force, &
         bounce%max_indentation]
   end function bounce_values

   !> List the columns of a summary in their order: name, symbol, unit, meaning, value. A new column
   !> needs no other place. Without a result the outcome has NaN for its numbers
   pure subroutine list_columns(list, outcome)
      !> The columns
      type(list_t), intent(inout) :: list
      !> Outcome that the values are taken from
      type(outcome_t), intent(in) :: outcome

      call list%add('cor', 'e', '1', 'coefficient of restitution, relative velocity', outcome%cor)
      call list%add('cor_sphere', 'e_a', '1', 'coefficient of restitution, sphere alone', &
         outcome%cor_sphere)
      call list%add('contact_time', 't0', 's', 'contact time', outcome%contact_time)
      call list%add('max_indentation', 's_max', 'm', 'largest indentation', &
         outcome%max_indentation)
      call list%add('max_force', 'F_max', 'N', 'largest contact force', outcome%max_force)
      call list%add('residual_indentation', 's(t0)', 'm', 'indentation left at separation', &
         outcome%residual_indentation)
      call list%add('residual_ratio', 's0/smax', '1', 'ratio of residual to largest indentation', &
         outcome%residual_ratio)
      call list%add('hysteresis_energy', 'W_h', 'J', 'energy lost in the contact', &
         outcome%hysteresis_energy)
      call list%add('wave_energy', 'W_wave', 'J', 'energy given to the plate or structure', &
         outcome%wave_energy)
      call list%add('energy_loss', 'W', 'J', 'all that the sphere lost, int F dz', &
         outcome%energy_loss)
      call list%add('initial_energy', 'KE_0', 'J', 'kinetic energy before the impact', &
         outcome%initial_energy)
      call list%add('energy_imbalance', 'dW', 'J', 'energy imbalance: lost, not accounted for', &
         outcome%energy_imbalance)
      call list%add('contacts', 'n', '1', 'number of contacts with a structure', &
         real(outcome%contacts, wp), is_whole=.true.)
      call list%add('last_separation', 't_n', 's', 'time of the last separation', &
         outcome%last_separation)
      call list%add('structure_energy', 'W_s', 'J', 'energy left in a structure', &
         outcome%structure_energy)
      call list%add('bounces', 'N', '1', 'number of bounces', real(outcome%bounces, wp), &
         is_whole=.true.)
      call list%add('bouncing_time', 't_N', 's', 'time to the end of the bounces', &
         outcome%bouncing_time)
      call list%add('bouncing_time_error', 'dt_N', 's', 'estimated error of bouncing_time', &
         outcome%bouncing_time_error)
      call list%add('bounces_end', '', '', 'how the bounces ended', &
         real(outcome%bounces_end, wp), labels=end_names, first=0)
      call list%add('min_frequency', 'w_min', 'rad/s', 'lowest frequency of interest, 2 pi/t0', &
         outcome%min_frequency)
      call list%add('inelasticity', 'lambda', '1', "Zener's inelasticity parameter", &
         outcome%inelasticity)
      call list%add('loss_tangent', 'tan(d)', '1', 'loss tangent at min_frequency', &
         outcome%loss_tangent)
      call list%add('cor_error', 'de', '1', 'estimated error of cor', outcome%cor_error)
      call list%add('cor_sphere_error', 'de_a', '1', 'estimated error of cor_sphere', &
         outcome%cor_sphere_error)
      call list%add('contact_time_error', 'dt0', 's', 'estimated error of contact_time', &
         outcome%contact_time_error)
      call list%add('max_force_error', 'dF_max', 'N', 'estimated error of max_force', &
         outcome%max_force_error)
      call list%add('resilience', 'e_a^2', '1', 'rebound resilience, cor_sphere^2', &
         outcome%resilience)
      call list%add('rebound_height', 'H_1', 'm', 'rebound height after a drop from drop_height', &
         outcome%rebound_height)
      call list%add('contact_radius', 'a', 'm', 'largest radius of the contact', &
         outcome%contact_radius)
      call list%add('contact_ratio', 'a/R', '1', 'ratio of contact_radius to the radius', &
         outcome%contact_ratio)
      call list%add('thickness_ratio', 'a/2h', '1', &
         "contact_radius / thickness, times the plate's share", &
         outcome%thickness_ratio)
      call list%add('layer_ratio', 'a/H', '1', 'contact_radius / thickness, on a base', &
         outcome%layer_ratio)
      call list%add('layer_stiffening', 'F/F_H', '1', &
         'force / force on a half space, on a base', outcome%layer_stiffening)
      call list%add('layer_strain', 's/H', '1', &
         'indentation / thickness, on a base', outcome%layer_strain)
      call list%add('plate_wave_number', 'kH', '1', 'thickness times wave number at pi/t0', &
         outcome%plate_wave_number)
      call list%add('needed_extent', 'pi/k', 'm', 'nearest edge that does not send waves back', &
         outcome%needed_extent)
      call list%add('deflection_ratio', 'U/2h', '1', 'largest plate displacement / thickness', &
         outcome%deflection_ratio)
      call list%add('highest_mode', 'w_m/w_0', '1', &
         'highest mode of a file, times t0/pi', outcome%highest_mode)
      call list%add('block_reach', 'c_s t0/2L', '1', &
         'reach of the waves / size of the block that they fill', outcome%block_reach)
      call list%add('weight_ratio', 'mg/F', '1', 'ratio of the weight of the sphere to max_force', &
         outcome%weight_ratio)
      call list%add('mass_ratio', 'm/m_s', '1', 'mass / mass of a solid ball of its density', &
         outcome%mass_ratio)
      call list%add('mean_pressure', 'p_m', 'Pa', 'mean pressure at the largest force', &
         outcome%mean_pressure)
      call list%add('axis_tension', '-p_0/p_m', '1', &
         'largest tension on the axis / mean_pressure', outcome%axis_tension)
      call list%add('cor_deviation', 'D_e', '1', &
         'predicted change of cor_sphere by exact mechanics', outcome%cor_deviation)
      call list%add('wave_loss', 'W_1/KE_0', '1', &
         'share of energy in waves that is not computed', outcome%wave_loss)
      call list%add('peak_loss_tangent', 'tan(d)_p', '1', 'loss tangent at pi/t0', &
         outcome%peak_loss_tangent)
      call list%add('peak_storage_modulus', "E'_p", 'Pa', &
         'storage modulus of the contact at pi/t0', outcome%peak_storage_modulus)
      call list%add('validity', '', '', 'whether the model holds: the worst of the measures', &
         real(outcome%validity, wp), labels=levels, first=level_none)
      call list%add('validity_cause', '', '', 'measure that decides on validity', &
         real(outcome%validity_cause, wp), &
         labels=[character(len=label_length) :: 'none', thresholds%measure], first=0)
      call list%add('steps', '', '1', 'number of time steps', real(outcome%steps, wp), &
         is_whole=.true.)
      ! the status must be the last column
      call list%add('status', '', '', 'how the contact ended', real(outcome%status, wp), &
         labels=statuses%name, first=contact_separated)
   end subroutine list_columns

   !> Add a column: of numbers, of whole numbers, or of texts
   pure subroutine add(self, name, symbol, unit, meaning, value, is_whole, labels, first)
      class(list_t), intent(inout) :: self
      character(len=*), intent(in) :: name, symbol, unit, meaning
      !> Value in this unit, or number of the text; the unit of texts is empty
      real(wp), intent(in) :: value
      !> Whether values are whole numbers, as those of texts always are
      logical, intent(in), optional :: is_whole
      !> All texts, each one word, and the number of the first one
      character(len=*), intent(in), optional :: labels(:)
      integer, intent(in), optional :: first

      integer :: i

      self%n = self%n + 1
      self%values(self%n) = value
      if (.not. allocated(self%quantities)) return
      associate (quantity => self%quantities(self%n))
         quantity = quantity_t(name, symbol, unit, meaning)
         quantity%is_whole = present(is_whole) .or. present(labels)
         if (.not. present(labels)) return
         do i = 1, size(labels)
            quantity%labels = trim(quantity%labels)//' '//labels(i)
         end do
         quantity%first = first
      end associate
   end subroutine add

   !> Columns of a summary
   pure function quantities()
      !> Descriptions, in their order, the status last
      type(quantity_t), allocatable :: quantities(:)

      type(list_t) :: list

      allocate (list%quantities(most))
      call list_columns(list, outcome_t())
      quantities = list%quantities(:list%n)
   end function quantities

   !> Values of an outcome
   pure function values_of(outcome) result(values)
      type(outcome_t), intent(in) :: outcome
      !> Values of the columns, each in its unit, in the order of `quantities`
      real(wp), allocatable :: values(:)

      type(list_t) :: list

      call list_columns(list, outcome)
      values = list%values(:list%n)
   end function values_of

   !> Place of a quantity among the columns
   pure function quantity_place(name) result(place)
      character(len=*), intent(in) :: name
      !> Place in `quantities`; 0 if there is none of this name
      integer :: place

      type(quantity_t), allocatable :: list(:)

      allocate (list, source=quantities())
      do place = size(list), 1, -1
         if (list(place)%name == name) return
      end do
   end function quantity_place

   !> Value of a quantity of an outcome
   pure function quantity_value(outcome, name) result(value)
      type(outcome_t), intent(in) :: outcome
      !> Name of the quantity
      character(len=*), intent(in) :: name
      !> Value, in its unit; NaN if the impact has none, or there is no such quantity
      real(wp) :: value

      type(list_t) :: list
      integer :: place

      value = ieee_value(value, ieee_quiet_nan)
      place = quantity_place(name)
      if (place == 0 .or. all(outcome%status /= [contact_separated, contact_resting])) return
      call list_columns(list, outcome)
      value = list%values(place)
   end function quantity_value

   !> Texts of a column
   pure function labels_of(quantity) result(labels)
      !> The column
      type(quantity_t), intent(in) :: quantity
      !> The texts; the first one has the number `quantity%first`
      character(len=label_length), allocatable :: labels(:)

      integer :: i

      ! a blank precedes each text
      allocate (labels(count([(quantity%labels(i:i) == ' ', i=1, len_trim(quantity%labels))])))
      read (quantity%labels, *) labels
   end function labels_of

   !> Names of all columns of a summary, separated by blanks
   pure function quantity_names() result(names)
      character(len=:), allocatable :: names

      type(quantity_t), allocatable :: list(:)
      integer :: i

      allocate (list, source=quantities())
      names = trim(list(1)%name)
      do i = 2, size(list)
         names = names//' '//trim(list(i)%name)
      end do
   end function quantity_names

   !> Name of a status
   pure function status_name(status) result(name)
      !> One of the `contact_*` and `point_*` constants
      integer, intent(in) :: status
      !> separated, no_separation, sticks, invalid, failed or rests
      character(len=13) :: name

      integer :: i

      name = 'failed'
      do i = 1, size(statuses)
         if (statuses(i)%code == status) name = statuses(i)%name
      end do
   end function status_name

   !> Allocate a summary of pending points, without values: NaN or 0. First check that there is
   !> enough memory to solve and write all points, which would otherwise show only after hours
   subroutine new_summary(self, points, error, threads)
      type(summary_t), intent(out) :: self
      integer, intent(in) :: points
      !> Error of code `error_file` if there is not enough memory, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Number of threads that solve them; absent: 1
      integer, intent(in), optional :: threads

      ! 8 bytes for each number, and one or two columns again while they are written; per thread a
      ! stack of 8 MB and its working storage
      integer(int64), parameter :: bytes_per_column = 12_int64, bytes_per_thread = 12000000_int64, &
         megabyte = 1000000_int64
      character, allocatable :: room(:)
      integer(int64) :: bytes
      integer :: i, status, team

      team = 1
      if (present(threads)) team = threads
      allocate (self%quantities, source=quantities())
      bytes = bytes_per_column*size(self%quantities)*int(points, int64) &
         + bytes_per_thread*int(team, int64)
      allocate (room(bytes), stat=status)
      if (status /= 0) then
         call raise(error, error_file, 'there is not enough memory for '//integer_text(points) &
            //' points by '//integer_text(team)//' thread(s), expected about ' &
            //integer_text(int(bytes/megabyte) + 1)//' MB')
         return
      end if
      deallocate (room)
      allocate (self%values(size(self%quantities) - 1))
      ! the first touch of so much memory takes as long as some per cent of the impacts
!$omp parallel do default(none) num_threads(max(1, min(team, points))) shared(self, points)
      do i = 1, size(self%values)
         if (self%quantities(i)%is_whole) then
            allocate (self%values(i)%integers(points), source=0)
         else
            allocate (self%values(i)%reals(points), source=ieee_value(1.0_wp, ieee_quiet_nan))
         end if
      end do
!$omp end parallel do
      allocate (self%status(points), source=point_pending)
      allocate (self%inexact(points), source=.false.)
   end subroutine new_summary

   !> The outcome of a point as numbers, which ranks send and a restart file keeps
   pure function row_of(outcome) result(row)
      type(outcome_t), intent(in) :: outcome
      !> Values of the columns, then 1 if its estimated error is above the accuracy requested, or 0
      real(wp), allocatable :: row(:)

      row = [values_of(outcome), merge(1.0_wp, 0.0_wp, outcome%misses())]
   end function row_of

   !> Store the outcome of a point
   pure subroutine put(self, place, row)
      class(summary_t), intent(inout) :: self
      integer, intent(in) :: place
      !> Its numbers from `row_of`
      real(wp), intent(in) :: row(:)

      integer :: i, n

      n = size(self%values)
      do i = 1, n
         if (allocated(self%values(i)%integers)) then
            self%values(i)%integers(place) = nint(row(i))
         else
            self%values(i)%reals(place) = row(i)
         end if
      end do
      self%status(place) = nint(row(n + 1))
      self%inexact(place) = row(n + 2) > 0.5_wp
   end subroutine put

   !> The outcome of a point as `put` has stored it
   pure function row(self, place)
      class(summary_t), intent(in) :: self
      integer, intent(in) :: place
      !> Its numbers as from `row_of`
      real(wp) :: row(size(self%values) + 2)

      integer :: i, n

      n = size(self%values)
      do i = 1, n
         if (allocated(self%values(i)%integers)) then
            row(i) = real(self%values(i)%integers(place), wp)
         else
            row(i) = self%values(i)%reals(place)
         end if
      end do
      row(n + 1) = real(self%status(place), wp)
      row(n + 2) = merge(1.0_wp, 0.0_wp, self%inexact(place))
   end function row

end module vcor_sweep_quantity
