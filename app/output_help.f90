!> Help on the output, made from the tables of quantities and statuses
module vcor_app_output_help
   use vcor_app_input_help, only : indented
   use vcor, only : quantities, statuses
   implicit none
   private

   public :: output_page, output_words

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Letters before the meaning of a word
   integer, parameter :: margin = 31

contains

   !> The columns of the summary and what the last one may say, all or the one of a name
   function output_page(word) result(text)
      !> Name of a column or of a status; absent: all
      character(len=*), intent(in), optional :: word
      !> The page; empty if the word is unknown
      character(len=:), allocatable :: text

      character(len=:), allocatable :: columns, states
      integer :: i

      columns = ''
      do i = 1, size(quantities)
         if (is_wanted(quantities(i)%name)) columns = columns//line(quantities(i)%name, &
            trim(quantities(i)%meaning)//' ['//trim(quantities(i)%unit)//']')
      end do
      if (is_wanted('steps')) columns = columns//line('steps', 'number of time steps')
      if (is_wanted('status')) columns = columns//line('status', 'how the contact ended')
      states = ''
      do i = 1, size(statuses)
         if (.not. (is_wanted(statuses(i)%name) .or. is_wanted('status'))) cycle
         states = states//line(statuses(i)%name, statuses(i)%meaning)
         if (statuses(i)%advice /= '') &
            states = states//indented('what to do: '//trim(statuses(i)%advice))
      end do

      text = ''
      if (columns /= '') text = 'Columns of STEM_summary.csv and names for --print:'//nl//columns
      if (columns /= '' .and. states /= '') text = text//nl
      if (states /= '') text = text//'What status says; all but separated have nan for numbers:' &
         //nl//states

   contains

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
