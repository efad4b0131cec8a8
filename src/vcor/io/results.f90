!> Outcomes, trajectories and moduli of materials as tables
!>
!>     summary       a row per impact; for materials a row for each: glassy and rubbery modulus, and
!>                   the values at t0 and omega_min
!>     history       a row per time
!>     bounces       a row per bounce
!>     relaxation    E(t), a row per material and time
!>     dynamic       E', E'' and tan(delta), a row per material and angular frequency
!>
!> In HDF5 the last two are arrays with the dimensions material and time, or frequency. Rigid
!> materials are in the summary only. The window of the case's own impact, t <= t0 and
!> omega >= omega_min, is given by contact_time and min_frequency of each table, which are missing
!> if the impact has no result, and by the column in_window.
module vcor_io_results
   use vcor_impact_bounces, only : bounces_t
   use vcor_impact_history, only : history
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_time, history_steps, trajectory_t
   use vcor_io_table, only : add_column, add_dimension, column_of, column_t, new_table, &
      real_column, table_t, text_column
   use vcor_kinds, only : wp
   use vcor_material_moduli, only : curves_t, loss_tangent, moduli_t
   use vcor_case_grid, only : axis_t, grid_t
   use vcor_sweep_quantity, only : bounce_quantities, bounce_values, history_quantities, &
      label_length, labels_of, quantity_t, summary_t
   implicit none
   private

   public :: summary_table, history_table, bounces_table, moduli_tables

   !> Value of in_window if there is no window
   integer, parameter :: unknown = -1
   !> Meaning of in_window
   character(len=*), parameter :: window_meaning = 'whether the impact of the case depends on ' &
      //'it: 1 yes, 0 no, -1 not known'

contains

   !> Summary: a row per impact. Its dimensions are the parameters that vary, with their paths as
   !> names; a single impact has the dimension `impact` of length one
   subroutine summary_table(table, title, case_text, grid, summary)
      type(table_t), intent(out) :: table
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: case_text
      type(grid_t), intent(in) :: grid
      !> Outcomes; they are moved to the table, not copied, as there may be a million
      type(summary_t), intent(inout) :: summary

      integer :: i

      call new_table(table, 'summary', title, case_text)
      do i = 1, size(grid%axes)
         call add_dimension(table, axis_column(grid%axes(i), grid%axes(i)%values))
      end do
      if (size(grid%axes) == 0) call add_dimension(table, 'impact', 1)
      do i = 1, size(summary%quantities)
         call add_column(table, quantity_column(summary%quantities(i), size(summary%status)))
      end do
      do i = 1, size(summary%values)
         call move_alloc(summary%values(i)%reals, table%columns(i)%reals)
         call move_alloc(summary%values(i)%integers, table%columns(i)%integers)
      end do
      table%columns(i)%integers = summary%status
      do i = 1, size(table%columns)
         associate (column => table%columns(i))
            if (column%kind == text_column) &
               column%integers = column%integers - summary%quantities(i)%first + 1
         end associate
      end do
   end subroutine summary_table

   !> Column of a parameter that varies
   pure function axis_column(axis, values) result(column)
      type(axis_t), intent(in) :: axis
      !> Its values, in the unit of the parameter
      real(wp), intent(in) :: values(:)
      type(column_t) :: column

      column = column_of(axis%name, values, axis%unit, axis%meaning)
      if (axis%unit == '') column%unit = '1'
   end function axis_column

   !> Column of a summary, without values
   function quantity_column(quantity, length) result(column)
      type(quantity_t), intent(in) :: quantity
      !> Number of its values
      integer, intent(in) :: length
      type(column_t) :: column

      character(len=label_length), allocatable :: labels(:)

      if (quantity%labels == '') then
         column = column_of(quantity%name, [integer ::], quantity%unit, quantity%meaning)
         if (.not. quantity%is_whole) column%kind = real_column
      else
         allocate (labels, source=labels_of(quantity))
         column = column_of(quantity%name, labels, '', quantity%meaning)
         column%integers = [integer ::]
      end if
      column%length = length
   end function quantity_column

   !> History: a row per time
   subroutine history_table(table, title, case_text, impact, trajectory)
      type(table_t), intent(out) :: table
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: case_text
      type(impact_t), intent(in) :: impact
      !> Its trajectory
      type(trajectory_t), intent(in) :: trajectory

      real(wp), allocatable :: state(:, :)
      integer :: j

      call new_table(table, 'history', title, case_text)
      call history(impact, trajectory, history_steps, state)
      associate (time => history_quantities(col_time))
         call add_dimension(table, column_of(time%name, state(col_time, :), time%unit, &
            time%meaning))
      end associate
      do j = 1, size(history_quantities)
         if (j == col_time) cycle
         associate (quantity => history_quantities(j))
            call add_column(table, column_of(quantity%name, state(j, :), quantity%unit, &
               quantity%meaning))
         end associate
      end do
   end subroutine history_table

   !> Bounces: a row per bounce
   subroutine bounces_table(table, title, case_text, bounces)
      type(table_t), intent(out) :: table
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: case_text
      type(bounces_t), intent(in) :: bounces

      real(wp) :: values(size(bounce_quantities), bounces%count)
      integer :: i, j

      do i = 1, bounces%count
         values(:, i) = bounce_values(i, bounces%list(i))
      end do
      call new_table(table, 'bounces', title, case_text)
      table%facts = [column_of('bouncing_time', [bounces%total_time], 's', &
         'time to the end of the bounces'), &
         column_of('bouncing_time_error', [bounces%total_time_error], 's', &
         'estimated error of bouncing_time')]
      do j = 1, size(bounce_quantities)
         associate (quantity => bounce_quantities(j))
            if (j == 1) then
               call add_dimension(table, column_of(quantity%name, nint(values(j, :)), &
                  quantity%unit, quantity%meaning))
            else if (quantity%is_whole) then
               call add_column(table, column_of(quantity%name, nint(values(j, :)), &
                  quantity%unit, quantity%meaning))
            else
               call add_column(table, column_of(quantity%name, values(j, :), quantity%unit, &
                  quantity%meaning))
            end if
         end associate
      end do
   end subroutine bounces_table

   !> Moduli as tables
   subroutine moduli_tables(moduli, title, case_text, tables)
      type(moduli_t), intent(in) :: moduli
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: case_text
      !> Tables with a row per material; per material and time; per material and frequency
      type(table_t), intent(out) :: tables(3)

      integer, allocatable :: all(:), soft(:)
      real(wp), allocatable :: storage(:), loss(:)
      integer :: i, longest

      all = [(i, i=1, size(moduli%materials))]
      soft = pack(all, [(.not. moduli%materials(i)%material%rigid, i=1, size(all))])
      longest = maxval([(len(moduli%materials(i)%material%name), i=1, size(all))])

      call begin(tables(1), 'summary', all)
      call add_summary(tables(1), moduli%materials)

      call begin(tables(2), 'relaxation', soft)
      call add_dimension(tables(2), column_of('time', moduli%times, 's', &
         'time since the strain step'))
      call add_column(tables(2), column_of('relaxation_modulus', &
         [(moduli%materials(soft(i))%relaxation, i=1, size(soft))], 'Pa', &
         'relaxation modulus E(t)'))
      call add_column(tables(2), column_of('in_window', &
         spread_out(moduli%times <= moduli%contact_time), &
         '1', window_meaning))

      storage = [(moduli%materials(soft(i))%storage, i=1, size(soft))]
      loss = [(moduli%materials(soft(i))%loss, i=1, size(soft))]
      call begin(tables(3), 'dynamic', soft)
      call add_dimension(tables(3), column_of('frequency', moduli%frequencies, 'rad/s', &
         'angular frequency'))
      call add_column(tables(3), column_of('storage_modulus', storage, 'Pa', "storage modulus E'"))
      call add_column(tables(3), column_of('loss_modulus', loss, 'Pa', "loss modulus E''"))
      call add_column(tables(3), column_of('loss_tangent', loss_tangent(storage, loss), '1', &
         "loss tangent E''/E'"))
      call add_column(tables(3), column_of('in_window', &
         spread_out(moduli%frequencies >= moduli%min_frequency), '1', window_meaning))

   contains

      !> Begin a table of some materials
      subroutine begin(table, name, items)
         type(table_t), intent(out) :: table
         character(len=*), intent(in) :: name
         !> Indices of the materials
         integer, intent(in) :: items(:)

         character(len=longest) :: names(size(items))
         integer :: k

         call new_table(table, name, title, case_text)
         if (moduli%contact_time > 0.0_wp) then
            table%facts = [column_of('contact_time', [moduli%contact_time], 's', &
               'contact time t0 of the impact: it depends on t <= t0'), &
               column_of('min_frequency', [moduli%min_frequency], 'rad/s', &
               'lowest frequency of interest, 2 pi/t0')]
         end if
         do k = 1, size(items)
            names(k) = moduli%materials(items(k))%material%name
         end do
         call add_dimension(table, column_of('material', names, '', 'name of the material'))
      end subroutine begin

      !> Values of in_window, repeated for each material
      pure function spread_out(inside) result(column)
         !> Whether a point is in the window, shape (points)
         logical, intent(in) :: inside(:)
         !> 1, 0 or -1, shape (points*materials)
         integer :: column(size(inside)*size(soft))

         integer :: k

         column = [(merge(1, 0, inside), k=1, size(soft))]
         if (.not. moduli%contact_time > 0.0_wp) column = unknown
      end function spread_out
   end subroutine moduli_tables

   !> Add the columns of the summary of materials
   pure subroutine add_summary(table, materials)
      type(table_t), intent(inout) :: table
      !> The materials, shape (n)
      type(curves_t), intent(in) :: materials(:)

      character(len=16) :: models(size(materials))
      real(wp), dimension(size(materials)) :: density, poisson_ratio, glassy, rubbery, viscosity
      real(wp) :: tangent(size(materials))
      integer :: i

      do i = 1, size(materials)
         models(i) = materials(i)%model
         associate (material => materials(i)%material)
            density(i) = material%density()
            poisson_ratio(i) = material%poisson_ratio()
            glassy(i) = material%glassy()
            rubbery(i) = material%rubbery()
            viscosity(i) = material%viscosity
         end associate
      end do
      tangent = loss_tangent(materials%storage_at_min, materials%loss_at_min)
      call add_column(table, column_of('model', models, '', 'model of the relaxation modulus'))
      call add_column(table, column_of('density', density, 'kg/m3', 'density, 0 where not given'))
      call add_column(table, column_of('poisson_ratio', poisson_ratio, '1', "Poisson's ratio"))
      call add_column(table, column_of('glassy_modulus', glassy, 'Pa', 'modulus at t = 0'))
      call add_column(table, column_of('rubbery_modulus', rubbery, 'Pa', &
         'modulus after long times'))
      call add_column(table, column_of('viscosity', viscosity, 'Pa s', &
         'dashpot in parallel, which the relaxation modulus leaves out'))
      call add_column(table, column_of('relaxation_modulus', materials%at_contact_time, 'Pa', &
         'relaxation modulus at contact_time'))
      call add_column(table, column_of('storage_modulus', materials%storage_at_min, 'Pa', &
         'storage modulus at min_frequency'))
      call add_column(table, column_of('loss_modulus', materials%loss_at_min, 'Pa', &
         'loss modulus at min_frequency'))
      call add_column(table, column_of('loss_tangent', tangent, '1', &
         'loss tangent at min_frequency'))
   end subroutine add_summary

end module vcor_io_results
