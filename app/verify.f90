!> The command verify: the program against laws and known numbers, or a case by several methods
module vcor_app_verify
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_app_job, only : job_t
   use vcor_app_laws, only : evaluate, law_t, laws, verdict_t
   use vcor_app_screen, only : heading, padded, right, visible
   use vcor_rounded, only : short, significant
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_file, only : write_stdout
   use vcor_kinds, only : wp
   use vcor_sweep_quantity, only : status_name
   use vcor_text, only : integer_text
   use vcor_verify_agreement, only : attempt_case, attempt_count, attempt_first, attempt_halved, &
      attempt_refined, compared_t, comparison_t, error_of_best, is_honest
   use vcor_verify_methods, only : compare
   use vcor_verify_models, only : model_t, solve_models
   use vcor_version, only : version
   implicit none
   private

   public :: verify_program, verify_case

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

   !> Evaluate the laws and print a table
   subroutine verify_program(quiet, error)
      logical, intent(in) :: quiet
      !> Error of code `error_numerical` if a check fails, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(verdict_t), allocatable :: verdicts(:)
      character(len=:), allocatable :: first, text
      integer :: i, j, checks, failed

      checks = 0
      failed = 0
      first = ''
      text = 'vcor '//version//'  verification'//nl//nl//'  '//padded('law', 32) &
         //'method         expected            found deviation tolerance'//nl
      do i = 1, size(laws)
         call evaluate(laws(i), verdicts)
         do j = 1, size(verdicts)
            text = text//verdict_text(laws(i), verdicts(j))
            checks = checks + 1
            if (verdicts(j)%passed) cycle
            failed = failed + 1
            if (failed == 1) first = trim(laws(i)%title)//', '//trim(verdicts(j)%method)
         end do
      end do
      text = text//nl//'  A check passes if the deviation is at most the tolerance: twice the ' &
         //'error of cor that the'//nl//'  method was asked for, and ten times that share of a ' &
         //'contact time.'//nl//nl//'  sources of the expected numbers'//nl
      do i = 1, size(laws)
         text = text//'  '//padded(laws(i)%title, 32)//trim(laws(i)%source)//nl
      end do
      if (.not. quiet) call write_stdout(text//nl//integer_text(checks)//' checks, ' &
         //integer_text(failed)//' failed'//nl, error)
      if (failed > 0 .and. .not. allocated(error)) call raise(error, error_numerical, &
         integer_text(failed)//' of '//integer_text(checks)//' checks failed, the first one: ' &
         //first)
   end subroutine verify_program

   !> A line of the table of laws
   function verdict_text(law, verdict) result(text)
      type(law_t), intent(in) :: law
      type(verdict_t), intent(in) :: verdict
      character(len=:), allocatable :: text

      text = '  '//padded(law%title, 32)//verdict%method//significant(law%expected, 10, 16) &
         //significant(verdict%found, 10, 17)//column(verdict%deviation, 10) &
         //column(verdict%tolerance, 10)//'  '//merge('pass', 'FAIL', verdict%passed)//nl
   end function verdict_text

   !> Solve a case by all methods and print how far they agree
   subroutine verify_case(job, quiet, error)
      type(job_t), intent(in) :: job
      logical, intent(in) :: quiet
      !> Error of code `error_numerical` if they do not agree, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(comparison_t) :: comparison
      type(model_t), allocatable :: models(:)
      character(len=:), allocatable :: title

      call compare(job%case, job%sweep%problem, comparison, error)
      if (allocated(error)) then
         error%message = job%case%source//': '//error%message
         return
      end if
      call job%case%get('case', 'title', title)
      if (.not. quiet) then
         call solve_models(job%case, models)
         call write_stdout(comparison_text(job%case%source, title, comparison) &
            //models_text(models), error)
      end if
      if (allocated(comparison%objection) .and. .not. allocated(error)) &
         call raise(error, error_numerical, job%case%source//': '//comparison%objection)
   end subroutine verify_case

   !> Text of a comparison of methods
   function comparison_text(filename, title, comparison) result(text)
      character(len=*), intent(in) :: filename
      character(len=*), intent(in) :: title
      type(comparison_t), intent(in) :: comparison
      character(len=:), allocatable :: text

      text = heading(filename, title)//attempts_text(comparison)
      if (comparison%first_contact) text = text//'  note: these are solutions of the first ' &
         //'contact with the structure'//nl
      if (.not. comparison%two_methods) text = text//'  note: method ive has no result for ' &
         //'this case that is accurate enough, so only direct is shown'//nl
      if (comparison%separated) then
         text = text//nl//values_text(comparison)
         if (comparison%has_direct) text = text//nl//differences_text(comparison)
         text = text//nl//legend(comparison%has_direct)
      else if (.not. allocated(comparison%objection)) then
         text = text//'  all end in the same way, '//trim(status_name( &
            comparison%attempts(attempt_first)%outcome%status)) &
            //': there are no numbers to compare'//nl
      end if
      text = text//nl
      if (allocated(comparison%objection)) then
         text = text//'  not verified: '//comparison%objection//nl
      else if (comparison%separated) then
         text = text//'  verified: '//trusted_text(comparison%compared(1))//nl
         if (comparison%attempts(attempt_case)%made) text = text//'  the cor of the scheme ' &
            //'that the case asks for is off by '//short( &
            comparison%attempts(attempt_case)%distance(1))//nl
      else
         text = text//'  verified'//nl
      end if
      text = text//nl
   end function comparison_text

   !> What the columns of the tables are
   pure function legend(has_direct) result(text)
      !> Whether method direct is among them
      logical, intent(in) :: has_direct
      character(len=:), allocatable :: text

      text = '  states: error of cor as the solution states it; off by: its distance from the ' &
         //'best cor; honest: at'//nl//'  most three times what it states; dW/KE_0: energy ' &
         //'imbalance over the energy before; digits: those'//nl//'  that the first solution ' &
         //'shares with the best'
      if (has_direct) text = text//'; dt -> 0: limit of direct, order: of its error in dt'
      text = text//nl
   end function legend

   !> Table of a case with every plate model and both contact laws, then with the other pair if that
   !> makes a difference
   function models_text(models) result(text)
      type(model_t), intent(in) :: models(:)
      character(len=:), allocatable :: text

      character(len=:), allocatable :: legend, first
      integer :: i

      legend = 'half_space is body without a thickness'
      first = 'waves'
      if (models(1)%label /= '') then
         legend = 'half_modes: half; infinite: no ends'
         first = 'structure'
      end if
      text = '  effect of the choice of model; * marks that of the case; '//legend//nl &
         //'  '//padded(first, 10)//'  '//padded('law', 9)//right('cor', 16) &
         //right('cor_sphere', 16)//right('contact_time [s]', 18) &
         //right('residual_indentation [m]', 26)//nl
      do i = 1, size(models)
         associate (this => models(i))
            if (this%pair /= models(max(1, i - 1))%pair .and. this%waves /= 'body') &
               text = text//"  the same with pair = '"//trim(this%pair)//"'"//nl
            text = text//merge('* ', '  ', this%given)//merge('half_space', merge(this%label, &
               this%waves, this%label /= ''), this%is_half_space)//'  '//this%law
            if (allocated(this%failure)) then
               text = text//right('refused', 16)//nl
            else if (this%outcome%status /= contact_separated) then
               text = text//right(status_name(this%outcome%status), 16)//nl
            else
               ! those without an error of their own are known about as well as cor_sphere
               associate (d => known_digits(1.0_wp, this%outcome%cor_sphere_error, 8))
                  text = text//known(this%outcome%cor, this%outcome%cor_error) &
                     //known(this%outcome%cor_sphere, this%outcome%cor_sphere_error) &
                     //significant(this%outcome%contact_time, d, 18) &
                     //part(this%outcome%residual_indentation, this%outcome%max_indentation, &
                     d, 0, 26)//nl
               end associate
            end if
         end associate
      end do
      text = text//nl

   contains

      !> A coefficient with the digits that its error allows, at most eight
      function known(value, error) result(digits)
         real(wp), intent(in) :: value, error
         character(len=:), allocatable :: digits

         digits = significant(value, known_digits(value, error, 8), 16)
      end function known
   end function models_text

   !> Significant digits that an error leaves of a number, at least two
   pure function known_digits(value, error, most) result(digits)
      real(wp), intent(in) :: value
      !> Error of the number, >= 0
      real(wp), intent(in) :: error
      !> Most digits
      integer, intent(in) :: most
      integer :: digits

      ! below any error, so that nothing is divided by zero
      real(wp), parameter :: least = 1.0e-20_wp

      digits = max(2, min(most, floor(log10(max(0.1_wp, abs(value)/max(error, least))))))
   end function known_digits

   !> A part of a whole with the digits that it has where the whole has `digits`; 0 if it has none
   pure function part(value, whole, digits, more, width) result(text)
      real(wp), intent(in) :: value
      !> The whole, > 0
      real(wp), intent(in) :: whole
      !> Digits of the whole that can be trusted
      integer, intent(in) :: digits
      !> Further digits to show, for comparison
      integer, intent(in) :: more
      integer, intent(in) :: width
      character(len=:), allocatable :: text

      real(wp) :: seen

      seen = visible(value, whole, digits)
      text = right('0', width)
      if (abs(seen) > 0.0_wp) text = significant(seen, &
         max(2, min(12, digits + more + nint(log10(abs(seen)/whole)))), width)
   end function part

   !> What can be trusted of a quantity: its best value, to as many digits
   pure function trusted_text(quantity) result(text)
      type(compared_t), intent(in) :: quantity
      character(len=:), allocatable :: text

      text = 'no digit of '//trim(quantity%name)//' can be trusted'
      if (quantity%digits > 0) text = integer_text(quantity%digits)//' digits of ' &
         //trim(quantity%name)//' = '//significant(quantity%best, quantity%digits, 0) &
         //' can be trusted'
   end function trusted_text

   !> Table of all solutions: settings, cor and its stated and true errors
   function attempts_text(comparison) result(text)
      type(comparison_t), intent(in) :: comparison
      character(len=:), allocatable :: text

      character(len=21) :: label
      character(len=9) :: honest
      integer :: i

      label = 'solution'
      text = '  '//label//' accuracy step [s]  steps              cor   states   off by' &
         //'  dW/KE_0'//nl
      do i = 1, attempt_count
         associate (this => comparison%attempts(i))
            if (.not. this%made) cycle
            label = this%label
            text = text//'  '//label//given(this%accuracy)//given(this%time_step)
            if (allocated(this%failure)) then
               text = text//'   failed'//nl
               cycle
            end if
            text = text//right(integer_text(this%outcome%steps), 7)
            if (.not. comparison%separated) then
               text = text//'   '//trim(status_name(this%outcome%status))//nl
               cycle
            end if
            honest = ''
            if (i /= attempt_case) honest = &
               merge('  honest ', '  TOO LOW', all(is_honest(this, error_of_best(comparison))))
            text = text//significant(this%outcome%cor, &
               2 + known_digits(this%outcome%cor, this%outcome%cor_error, 9), 17) &
               //column(this%outcome%cor_error, 9) &
               //column(this%distance(1), 9)//column(this%imbalance(), 9)//trim(honest)//nl
         end associate
      end do
   end function attempts_text

   !> Table of all quantities by both methods
   function values_text(comparison) result(text)
      type(comparison_t), intent(in) :: comparison
      character(len=:), allocatable :: text

      character(len=22) :: name
      integer :: i

      name = 'quantity'
      text = '  '//name//right(trim(comparison%attempts(attempt_first)%label), 19)
      if (comparison%two_methods) text = text//right( &
         trim(comparison%attempts(attempt_first)%label)//', refined', 19)
      if (comparison%has_direct) text = text//right('direct, dt -> 0', 19)//'   order'
      text = text//'  digits'//nl
      do i = 1, size(comparison%compared)
         associate (this => comparison%compared(i))
            name = this%name
            text = text//'  '//name//value_text(this%value(attempt_first))
            if (comparison%two_methods) text = text//value_text(this%value(attempt_refined))
            if (comparison%has_direct) text = text//value_text(this%direct%limit) &
               //order_text(this%direct%order)
            text = text//right(integer_text(this%digits), 8)//nl
         end associate
      end do

   contains

      !> A value of the quantity, with two digits more than can be trusted, where the methods differ
      function value_text(value)
         real(wp), intent(in) :: value
         character(len=:), allocatable :: value_text

         associate (this => comparison%compared(i))
            value_text = part(value, this%scale, this%digits, 2, 19)
         end associate
      end function value_text
   end function values_text

   !> Table of the distances of all solutions from the best value
   function differences_text(comparison) result(text)
      type(comparison_t), intent(in) :: comparison
      character(len=:), allocatable :: text

      character(len=22) :: name
      integer :: i, j

      name = 'less '//trim(merge('ive, refined   ', 'direct, dt -> 0', comparison%two_methods))
      text = '  '//name//right(trim(comparison%attempts(attempt_first)%label), 11) &
         //'  direct dt       dt/2       dt/4'
      if (comparison%two_methods) text = text//'    dt -> 0'
      if (comparison%attempts(attempt_case)%made) text = text//'   as given'
      text = text//nl
      do i = 1, size(comparison%compared)
         associate (this => comparison%compared(i))
            name = this%name
            text = text//'  '//name//column(this%value(attempt_first) - this%best, 11)
            do j = 1, size(attempt_halved)
               text = text//column(this%value(attempt_halved(j)) - this%best, 11)
            end do
            if (comparison%two_methods) text = text//column(this%direct%limit - this%best, 11)
            if (comparison%attempts(attempt_case)%made) &
               text = text//column(this%value(attempt_case) - this%best, 11)
            text = text//nl
         end associate
      end do
   end function differences_text

   !> A requested number, if any
   pure function given(value) result(text)
      !> The number; 0: none
      real(wp), intent(in) :: value
      character(len=9) :: text

      text = ''
      if (value > 0.0_wp) text = column(value, 9)
   end function given

   !> An order of convergence
   pure function order_text(order) result(text)
      real(wp), intent(in) :: order
      character(len=8) :: text

      text = right('-', 8)
      if (ieee_is_finite(order)) write (text, '(f8.2)') max(-99.0_wp, min(999.0_wp, order))
   end function order_text

   !> A number with two digits in a column
   pure function column(value, width) result(text)
      real(wp), intent(in) :: value
      integer, intent(in) :: width
      character(len=width) :: text

      text = right('nan', width)
      if (ieee_is_finite(value)) text = right(short(value), width)
   end function column

end module vcor_app_verify
