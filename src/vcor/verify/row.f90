!> A row of the verification table, and the judge of rows
!>
!> A law (Hertz's, Zener's ...) is a list of rows. A row is data: the impacts to solve and how, what
!> is measured on their outcomes, the number that is expected and how far off it may be, with the
!> reason. Nothing is computed here but the verdict.
module vcor_verify_row
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_quiet_nan, ieee_value
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_sweep_quantity, only : quantity_value
   implicit none
   private

   public :: row_t, law_t, verdict_t, measure_i
   public :: judge, accuracy_of

   !> Accuracy that the internal-variable method is to show: asked for half of it, the smallest that
   !> it takes, it leaves the other half to rounding, some 5e-13 per panel
   real(wp), parameter :: ive_accuracy = 2.0e-11_wp
   !> The same for product integration, its default: below it the estimate of its
   !> error is too small where an elastic contact ends on a moving plate
   real(wp), parameter :: direct_accuracy = 1.0e-6_wp

   abstract interface
      !> A number that is made of the outcomes of a row's impacts
      pure function measure_i(outcomes, parameters) result(value)
         import :: outcome_t, wp
         !> Outcomes in the order of the impacts, shape (n)
         type(outcome_t), intent(in) :: outcomes(:)
         !> Parameters of the row, shape (m)
         real(wp), intent(in) :: parameters(:)
         !> The number
         real(wp) :: value
      end function measure_i
   end interface

   !> One row
   type :: row_t
      !> What is checked
      character(len=:), allocatable :: name
      !> Method that solves its impacts: ive or direct
      character(len=6) :: method = ''
      !> The number that is known
      real(wp) :: expected = 0.0_wp
      !> Largest deviation that passes, in the unit of the number
      real(wp) :: tolerance = 0.0_wp
      !> Why the tolerance is what it is
      character(len=:), allocatable :: reason
      !> Impacts, shape (n); not allocated: those of the row before
      type(impact_t), allocatable :: impacts(:)
      !> What is found, if `measure` is null: this quantity of the first outcome ...
      character(len=20) :: quantity = 'cor'
      !> ... in this unit
      real(wp) :: unit = 1.0_wp
      !> Whether the same quantity of the second outcome takes the place of `expected`
      logical :: pair = .false.
      !> What is found where it takes more than one quantity of one outcome
      procedure(measure_i), pointer, nopass :: measure => null()
      !> What takes the place of `expected` where the outcomes themselves tell it
      procedure(measure_i), pointer, nopass :: expectation => null()
      !> Parameters of the two, shape (m)
      real(wp), allocatable :: parameters(:)
   end type row_t

   !> A law: rows from one source
   type :: law_t
      !> What it says, one line
      character(len=:), allocatable :: title
      !> Where its numbers come from, one line
      character(len=:), allocatable :: source
      !> Its rows, shape (n), the first `count` of them in use
      type(row_t), allocatable :: rows(:)
      !> Number of rows
      integer :: count = 0
      !> What went wrong in building it; unallocated if nothing did
      type(error_t), allocatable :: error
   contains
      !> Begin a law
      procedure :: begin
      !> Append a row about a quantity
      procedure :: add
      !> Append a row about two impacts of one restitution
      procedure :: add_pair
      !> Append a row about a number that is made of several outcomes
      procedure :: add_measure
   end type law_t

   !> What came out of a row
   type :: verdict_t
      !> The number that was expected
      real(wp) :: expected = 0.0_wp
      !> The number that was found, NaN if there was none
      real(wp) :: found = 0.0_wp
      !> Found less expected, NaN if there was none
      real(wp) :: deviation = 0.0_wp
      !> Whether it is within the tolerance
      logical :: passed = .false.
   end type verdict_t

contains

   !> Begin a law
   pure subroutine begin(self, title, source)
      !> The law
      class(law_t), intent(inout) :: self
      !> What it says
      character(len=*), intent(in) :: title
      !> Where its numbers come from
      character(len=*), intent(in) :: source

      integer, parameter :: most_rows = 48

      self%title = title
      self%source = source
      self%count = 0
      allocate (self%rows(most_rows))
   end subroutine begin

   !> Append a row about a quantity of one impact
   pure subroutine add(self, name, method, expected, tolerance, reason, impact, quantity, unit)
      !> The law, begun
      class(law_t), intent(inout) :: self
      !> What is checked
      character(len=*), intent(in) :: name
      !> Method that solves the impact
      character(len=*), intent(in) :: method
      !> The number that is known
      real(wp), intent(in) :: expected
      !> Largest deviation that passes
      real(wp), intent(in) :: tolerance
      !> Why the tolerance is what it is
      character(len=*), intent(in) :: reason
      !> Impact; absent: that of the row before
      type(impact_t), intent(in), optional :: impact
      !> Quantity; absent: cor
      character(len=*), intent(in), optional :: quantity
      !> Its unit; absent: the SI unit
      real(wp), intent(in), optional :: unit

      self%count = self%count + 1
      associate (row => self%rows(self%count))
         row%name = name
         row%method = method
         row%expected = expected
         row%tolerance = tolerance
         row%reason = reason
         if (present(impact)) then
            allocate (row%impacts(1))
            row%impacts(1) = impact
         end if
         if (present(quantity)) row%quantity = quantity
         if (present(unit)) row%unit = unit
      end associate
   end subroutine add

   !> Append a row about two impacts of one restitution
   pure subroutine add_pair(self, name, method, tolerance, reason, impact, other)
      !> The law, begun
      class(law_t), intent(inout) :: self
      !> What is checked
      character(len=*), intent(in) :: name
      !> Method that solves the impacts
      character(len=*), intent(in) :: method
      !> Largest deviation that passes
      real(wp), intent(in) :: tolerance
      !> Why the tolerance is what it is
      character(len=*), intent(in) :: reason
      !> Impact whose cor is found
      type(impact_t), intent(in) :: impact
      !> Impact whose cor is expected
      type(impact_t), intent(in) :: other

      call self%add(name, method, 0.0_wp, tolerance, reason)
      associate (row => self%rows(self%count))
         allocate (row%impacts(2))
         row%impacts(1) = impact
         row%impacts(2) = other
         row%pair = .true.
      end associate
   end subroutine add_pair

   !> Append a row about a number that is made of several outcomes
   subroutine add_measure(self, name, method, expected, tolerance, reason, parameters, impacts, &
                          measure, expectation)
      !> The law, begun
      class(law_t), intent(inout) :: self
      !> What is checked
      character(len=*), intent(in) :: name
      !> Method that solves the impacts
      character(len=*), intent(in) :: method
      !> The number that is known
      real(wp), intent(in) :: expected
      !> Largest deviation that passes
      real(wp), intent(in) :: tolerance
      !> Why the tolerance is what it is
      character(len=*), intent(in) :: reason
      !> Parameters of the two procedures, shape (m)
      real(wp), intent(in) :: parameters(:)
      !> Impacts, shape (n); absent: those of the row before
      type(impact_t), intent(in), optional :: impacts(:)
      !> What is found; absent: cor of the first impact
      procedure(measure_i), optional :: measure
      !> What takes the place of `expected`; absent: nothing
      procedure(measure_i), optional :: expectation

      call self%add(name, method, expected, tolerance, reason)
      associate (row => self%rows(self%count))
         row%parameters = parameters
         if (present(impacts)) row%impacts = impacts
         if (present(measure)) row%measure => measure
         if (present(expectation)) row%expectation => expectation
      end associate
   end subroutine add_measure

   !> Accuracy that a method is to show, twice what it is asked for
   elemental function accuracy_of(method) result(accuracy)
      !> ive or direct
      character(len=*), intent(in) :: method
      !> Accuracy of the coefficient of restitution
      real(wp) :: accuracy

      accuracy = direct_accuracy
      if (method == 'ive') accuracy = ive_accuracy
   end function accuracy_of

   !> Judge a row by the outcomes of its impacts: what is not within the tolerance fails, NaN too
   pure function judge(row, outcomes) result(verdict)
      !> The row
      type(row_t), intent(in) :: row
      !> Outcomes in the order of the impacts; none: an impact had no outcome
      type(outcome_t), intent(in) :: outcomes(:)
      !> The verdict
      type(verdict_t) :: verdict

      verdict%expected = row%expected
      verdict%found = ieee_value(verdict%found, ieee_quiet_nan)
      verdict%deviation = verdict%found
      if (size(outcomes) == 0) return
      if (associated(row%measure)) then
         verdict%found = row%measure(outcomes, row%parameters)
      else
         verdict%found = quantity_of(row, outcomes(1))
      end if
      if (associated(row%expectation)) then
         verdict%expected = row%expectation(outcomes, row%parameters)
      else if (row%pair) then
         verdict%expected = quantity_of(row, outcomes(2))
      end if
      if (.not. ieee_is_finite(verdict%found)) return
      if (.not. ieee_is_finite(verdict%expected)) return
      verdict%deviation = verdict%found - verdict%expected
      if (.not. ieee_is_finite(row%tolerance)) return
      verdict%passed = abs(verdict%deviation) <= row%tolerance
   end function judge

   !> The quantity that a row is about, in its unit
   pure function quantity_of(row, outcome) result(value)
      !> The row
      type(row_t), intent(in) :: row
      !> An outcome
      type(outcome_t), intent(in) :: outcome
      !> The number; NaN for a quantity of this name that does not exist
      real(wp) :: value

      value = quantity_value(outcome, row%quantity)
      if (ieee_is_finite(value)) value = value/row%unit
   end function quantity_of

end module vcor_verify_row
