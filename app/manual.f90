!> Pages of the manual: what `vcor help TOPIC --man` and `--markdown` print
!>
!> man/ and docs/ hold them as they come from here (scripts/manual.sh). The page of the program is
!> made from its help pages, so a new command is in it by itself.
module vcor_app_manual
   use vcor_app_cli, only : commands
   use vcor_app_help, only : help_text
   use vcor_app_inline, only : plain_words
   use vcor_app_input_manual, only : input_manual
   use vcor_app_markup, only : markup_t, new_page
   use vcor_app_output_manual, only : output_manual, put_exit_codes
   use vcor_error, only : error_t, error_usage, raise
   use vcor_version, only : version
   implicit none
   private

   public :: manual_text

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Blanks before a line that goes on with an item of a help page
   character(len=*), parameter :: deep = repeat(' ', 5)

contains

   !> A page of the manual
   subroutine manual_text(topic, man, text, error)
      !> input, output, or empty for the program
      character(len=*), intent(in) :: topic
      !> Whether it is for man; Markdown otherwise
      logical, intent(in) :: man
      !> The page
      character(len=:), allocatable, intent(out) :: text
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(markup_t) :: page

      select case (topic)
      case ('')
         call program_page(page, man, error)
         if (allocated(error)) return
      case ('input')
         call input_manual(page, man)
      case ('output')
         call output_manual(page, man)
      case default
         ! says what is wrong with an unknown one
         call help_text(topic, text, error)
         if (.not. allocated(error)) call raise(error, error_usage, 'no manual page on '//topic &
            //'; there is one of the program (no topic), of input and of output')
         return
      end select
      text = page%text
   end subroutine manual_text

   !> The program: its commands, each from its help page
   subroutine program_page(page, man, error)
      !> The page
      type(markup_t), intent(out) :: page
      !> Whether it is for man
      logical, intent(in) :: man
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: text
      integer :: first, last

      call new_page(page, man, 'vcor', '1', 'Commands', &
         'coefficient of restitution of viscoelastic spheres and plates', version)
      call help_text('', text, error)
      if (allocated(error)) return
      call page%heading(1, 'Synopsis')
      call put_usage(page, text)

      call page%heading(1, 'Description')
      call page%paragraph('Computes how a sphere rebounds from a plate, a half space or another ' &
         //'sphere when at least one of the bodies is viscoelastic: coefficient of ' &
         //'restitution, contact time, indentation, force and energies, with an estimate of the ' &
         //'numerical error. The impact is described in a case file, a Fortran namelist in SI ' &
         //'units.')
      call page%paragraph('`vcor help TOPIC` shows a page of this manual on the screen; a ' &
         //'word of the input or the output, as in `vcor help velocity`, `vcor help prony` or ' &
         //'`vcor help sticks`, the part of that page that is about it. With ' &
         //'`--markdown` or `--man` it prints the manual itself, of the program (without ' &
         //'TOPIC), of `input` or of `output`. `vcor --version` prints the version.')
      call page%paragraph('An option may have its value after a blank or after an equals sign. ' &
         //'`--` ends the options: what follows are files.')

      call page%heading(1, 'Commands')
      first = 1
      do while (first <= len(commands))
         last = first - 2 + index(commands(first:)//' ', ' ')
         if (commands(first:last) /= 'help') then
            call help_text(commands(first:last), text, error)
            if (allocated(error)) return
            call page%heading(2, '`vcor '//commands(first:last)//'`')
            call put_help(page, text)
         end if
         first = last + 2
      end do

      call put_exit_codes(page)
      call page%heading(1, 'Environment')
      call page%item('OMP_NUM_THREADS', 'Number of threads of a sweep where `--threads` does not ' &
         //'say it.')
      call page%heading(1, 'Examples')
      call page%paragraph('Validate a case, solve it, and solve it again for another velocity:')
      call page%block('sh', 'vcor check case.nml'//nl//'vcor run case.nml'//nl &
         //'vcor run case.nml --set impact.velocity=2.5 --print cor,cor_error'//nl)
      call page%aside('The keys of a case: [input](input.md). What is written: ' &
         //'[output](output.md). Step by step: [getting started](getting_started.md).')
      if (man) then
         call page%heading(1, 'See also')
         call page%paragraph('`vcor-input`(5), `vcor-output`(5)')
      end if
   end subroutine program_page

   !> How the commands are called, from the lines of a help page that say so
   subroutine put_usage(page, text)
      !> The page
      type(markup_t), intent(inout) :: page
      !> The help page
      character(len=*), intent(in) :: text

      character(len=*), parameter :: start = 'usage: '
      character(len=:), allocatable :: line
      integer :: first, last, gap

      first = 1
      do while (first <= len(text))
         last = first - 2 + index(text(first:), nl)
         if (last - first > len(start)) then
            if (text(first:first + len(start) - 1) == start .or. &
               text(first:first + len(start) + 3) == repeat(' ', len(start))//'vcor') then
               line = text(first + len(start):last)
               ! what the command does stands behind
               gap = index(line//'  ', '  ')
               call page%line('`'//line(:gap - 1)//'`')
            end if
         end if
         first = last + 2
      end do
   end subroutine put_usage

   !> A help page: how the command is called, paragraphs, and items, two blanks before the term and
   !> two or more behind
   subroutine put_help(page, text)
      !> The page
      type(markup_t), intent(inout) :: page
      !> The help page
      character(len=*), intent(in) :: text

      character(len=:), allocatable :: line, term, words
      integer :: first, last, gap
      logical :: begins

      call put_usage(page, text)
      term = ''
      words = ''
      ! after the first blank line
      first = index(text, nl//nl) + 2
      do while (first <= len(text))
         last = first - 2 + index(text(first:), nl)
         line = plain_words(text(first:last))
         begins = index(line, '  ') == 1 .and. index(line, deep) /= 1
         if (line == '' .or. begins .or. (term /= '' .and. index(line, '  ') /= 1)) call flush()
         if (begins) then
            line = trim(adjustl(line))
            gap = index(line//'  ', '  ')
            term = line(:gap - 1)
            line = line(min(gap, len(line) + 1):)
         end if
         line = trim(adjustl(line))
         if (words /= '' .and. line /= '') words = words//' '
         words = words//line
         first = last + 2
      end do
      call flush()

   contains

      !> Write what has been collected
      subroutine flush()
         if (term /= '') then
            call page%item(term, words)
         else if (words /= '') then
            call page%paragraph(words)
         end if
         term = ''
         words = ''
      end subroutine flush
   end subroutine put_help

end module vcor_app_manual
