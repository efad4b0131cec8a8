!> What the screen shows of a fit
module vcor_app_fit_screen
   use vcor_app_screen, only : percent, short, significant
   use vcor_fit, only : fit_t, samples_t, state_bound, state_fixed, unseen_earlier, unseen_later
   use vcor_fit_json, only : parameter_name, shift_note
   use vcor_text, only : integer_text, printable
   use vcor_kinds, only : wp
   use vcor_version, only : version
   implicit none
   private

   public :: fit_report, fit_remarks

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> What is said of misfits that are no noise
   character(len=*), parameter :: no_noise = 'the model does not follow the data: its misfits ' &
      //'are no noise'

contains

   !> Report of a fit
   function fit_report(fit, source, note, samples, tail) result(text)
      type(fit_t), intent(in) :: fit
      character(len=*), intent(in) :: source
      character(len=*), intent(in) :: note
      type(samples_t), intent(in) :: samples
      !> Notes and files, one to a line
      character(len=*), intent(in) :: tail
      character(len=:), allocatable :: text

      integer :: i

      text = 'vcor '//version//'  '//printable(source)//nl//note//nl//nl//'  ' &
         //fit%data%model//terms_of(fit)//nl
      do i = 1, size(fit%parameters)
         text = text//line(fit, i)
      end do
      text = text//nl &
         //'  rms misfit          '//percent(fit%rms)//nl &
         //'  largest misfit      '//percent(fit%largest)//place_of(fit, samples)//nl &
         //'  band of the data    '//short(samples%first_time())//' to ' &
         //short(samples%last_time())//' s'
      if (samples%dynamic) text = text//', from '//short(samples%at(1))//' to ' &
         //short(samples%at(size(samples%at)))//' rad/s'
      text = text//nl
      if (fit%structured) text = text//'  note: '//no_noise//', its standard errors mean ' &
         //'little'//nl
      if (shift_note(samples) /= '') text = text//'  note: '//shift_note(samples)//nl
      if (is_open(fit)) text = text//'  note: the modulus still falls where the data end: ' &
         //'equilibrium_modulus holds all that relaxes later'//nl
      text = text//tail//nl
   end function fit_report

   !> Remarks before a group: what it was fitted to and how well
   function fit_remarks(fit, source, samples) result(text)
      type(fit_t), intent(in) :: fit
      character(len=*), intent(in) :: source
      type(samples_t), intent(in) :: samples
      character(len=:), allocatable :: text

      integer :: i

      text = '! vcor '//version//' fit of '//fit%data%model//terms_of(fit)//' to ' &
         //printable(source)//nl &
         //'! rms misfit '//percent(fit%rms)//', largest ' &
         //percent(fit%largest)//place_of(fit, samples)//nl
      if (fit%structured) text = text//'! '//no_noise//nl
      if (is_open(fit)) text = text//'! equilibrium_modulus is not seen: 0 to ' &
         //short(most_of(fit))//' Pa'//nl
      do i = 1, size(fit%parameters)
         associate (parameter => fit%parameters(i))
            if (parameter%state == state_bound) text = text//'! '//parameter_name(fit, i) &
               //' is at its bound: '//short(parameter%value)//' +- '//short(parameter%error) &
               //' '//trim(parameter%unit)//nl
         end associate
      end do
   end function fit_remarks

   !> Whether the equilibrium modulus of a series is only what has not relaxed when the data end,
   !> and the material may go on to relax all of it
   pure function is_open(fit) result(yes)
      type(fit_t), intent(in) :: fit
      logical :: yes

      associate (first => fit%parameters(1))
         yes = fit%data%model == 'prony' .and. first%unseen == unseen_later &
            .and. first%error < first%value
      end associate
   end function is_open

   !> Most that the first parameter can be, three standard errors above it
   pure function most_of(fit) result(value)
      type(fit_t), intent(in) :: fit
      real(wp) :: value

      value = fit%parameters(1)%value + 3.0_wp*fit%parameters(1)%error
   end function most_of

   !> Number of terms of a Prony series
   function terms_of(fit) result(text)
      type(fit_t), intent(in) :: fit
      !> In words; nothing for other models
      character(len=:), allocatable :: text

      text = ''
      if (fit%data%model /= 'prony') return
      text = ', '//integer_text(size(fit%data%list('moduli')))//' terms'
      if (size(fit%data%list('moduli')) == 1) text = ', 1 term'
   end function terms_of

   !> Where the largest misfit is
   pure function place_of(fit, samples) result(text)
      type(fit_t), intent(in) :: fit
      type(samples_t), intent(in) :: samples
      character(len=:), allocatable :: text

      if (.not. samples%dynamic) then
         text = ' at '//short(fit%largest_at)//' s'
      else if (fit%largest_in_loss) then
         text = ' of the loss modulus at '//short(fit%largest_at)//' rad/s'
      else
         text = ' of the storage modulus at '//short(fit%largest_at)//' rad/s'
      end if
   end function place_of

   !> Under what condition a standard error is one
   pure function condition(fit, i) result(text)
      type(fit_t), intent(in) :: fit
      integer, intent(in) :: i
      !> In words; nothing where the data show all that counts
      character(len=:), allocatable :: text

      text = ' if the model holds '
      if (fit%data%model == 'prony') text = ' if nothing relaxes '
      select case (fit%parameters(i)%unseen)
      case (unseen_earlier)
         text = text//'earlier'
      case (unseen_later)
         text = text//'later'
      case default
         text = ''
      end select
   end function condition

   !> Line of a parameter
   function line(fit, i) result(text)
      type(fit_t), intent(in) :: fit
      integer, intent(in) :: i
      character(len=:), allocatable :: text

      character(len=24) :: name
      character(len=8) :: unit

      associate (parameter => fit%parameters(i))
         name = parameter_name(fit, i)
         unit = parameter%unit
         if (unit == '1') unit = ''
         text = '    '//name//significant(parameter%value)//' '//unit
         if (parameter%state == state_fixed) then
            text = text//'given'
         else if (i == 1 .and. is_open(fit)) then
            text = text//'not seen: 0 to '//short(most_of(fit))
         else
            text = text//'+- '//short(parameter%error)
            if (parameter%state == state_bound) text = text//', at its bound'
            ! not even its order of magnitude; of what is 0 the error is a limit
            if (parameter%value > 0.0_wp .and. .not. parameter%error < parameter%value) then
               text = text//', the data do not determine it'
            else
               text = text//condition(fit, i)
            end if
         end if
      end associate
      text = text//nl
   end function line

end module vcor_app_fit_screen
