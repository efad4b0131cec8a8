!> Help on the output, made from the tables of quantities and statuses
module vcor_app_output_help
   use vcor_app_input_help, only : indented
   use vcor_sweep_quantity, only : history_quantities, quantities, quantity_t, statuses
   implicit none
   private

   public :: output_page, output_words

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Letters before the meaning of a word
   integer, parameter :: margin = 31
   !> What the screen of a run shows and no column holds: its words, between blanks, and what it is
   character(len=*), parameter :: screen_words(*) = [character(len=40) :: &
      ' KE_1 ', ' exponentials kernel ', ' +- ']
   character(len=*), parameter :: screen_meanings(size(screen_words)) = [character(len=480) :: &
      'left to the sphere: its kinetic energy after the impact, KE_0 cor_sphere^2 [J]', &
      "'kernel as a sum of 98 exponentials, to 1.0E-10': method ive writes a relaxation modulus " &
      //'with a continuous spectrum (power law, CERF, Mittag-Leffler, tables, some pairs) as a ' &
      //'sum of exponentials. Their number follows from solver.accuracy. The second number is ' &
      //'the largest relative error of the sum over the time of the contact; cor_error allows ' &
      //'for it. A Prony series is such a sum already, and nothing is said.', &
      'the estimated numerical error of the number before it, cor_error or cor_sphere_error. It ' &
      //'says nothing about the model or the material data.']

contains

   !> The columns of the summary and what the last one may say, all or the one of a word
   function output_page(word) result(text)
      !> Name or symbol of a column, name of a status, or a word of the screen; absent: all columns
      !> of the summary and statuses
      character(len=*), intent(in), optional :: word
      !> The page; empty if the word is unknown
      character(len=:), allocatable :: text

      character(len=:), allocatable :: columns, states, others
      integer :: i

      columns = lines_of(quantities)
      if (is_wanted('steps')) columns = columns//line('steps', 'number of time steps')
      if (is_wanted('status')) columns = columns//line('status', 'how the contact ended')
      states = ''
      do i = 1, size(statuses)
         if (.not. (is_wanted(statuses(i)%name) .or. is_wanted('status'))) cycle
         states = states//line(statuses(i)%name, statuses(i)%meaning)
         if (statuses(i)%advice /= '') &
            states = states//indented('what to do: '//trim(statuses(i)%advice))
      end do
      others = ''
      if (present(word)) then
         others = lines_of(history_quantities)
         if (others /= '') others = 'Columns of STEM.csv, the time history:'//nl//others
         do i = 1, size(screen_words)
            if (word == '' .or. index(screen_words(i), ' '//word//' ') == 0) cycle
            others = others//'On the screen of a run:'//nl//indented(trim(screen_meanings(i)))
         end do
      end if

      text = ''
      if (columns /= '') text = 'Columns of STEM_summary.csv and names for --print:'//nl//columns
      if (columns /= '' .and. states /= '') text = text//nl
      if (states /= '') text = text//'What status says; all but separated have nan for numbers:' &
         //nl//states
      if (text /= '' .and. others /= '') text = text//nl
      text = text//others

   contains

      !> Lines of the columns that are wanted
      function lines_of(list) result(lines)
         !> Columns of a file
         type(quantity_t), intent(in) :: list(:)
         !> A line for each
         character(len=:), allocatable :: lines

         integer :: k

         lines = ''
         do k = 1, size(list)
            if (is_wanted(list(k)%name) .or. is_wanted(list(k)%symbol)) lines = lines &
               //line(list(k)%name, trim(list(k)%meaning)//' ['//trim(list(k)%unit) &
               //'], symbol '//trim(list(k)%symbol))
         end do
      end function lines_of

      !> Whether a name is the word, or all are wanted
      pure function is_wanted(name) result(yes)
         !> The name
         character(len=*), intent(in) :: name
         !> Whether it is wanted
         logical :: yes

         yes = .true.
         if (present(word)) yes = name == word
      end function is_wanted
   end function output_page

   !> Line of a word
   pure function line(name, meaning) result(text)
      !> The word
      character(len=*), intent(in) :: name
      !> Its meaning
      character(len=*), intent(in) :: meaning
      !> The line
      character(len=:), allocatable :: text

      character(len=margin) :: start

      start = '   '//name
      text = start//trim(meaning)//nl
   end function line

   !> All words that `output_page` knows, a blank before each
   function output_words() result(words)
      !> The words
      character(len=:), allocatable :: words

      integer :: i

      words = ' steps status'
      do i = 1, size(quantities)
         words = words//' '//trim(quantities(i)%name)
      end do
      do i = 1, size(statuses)
         words = words//' '//trim(statuses(i)%name)
      end do
   end function output_words

end module vcor_app_output_help
