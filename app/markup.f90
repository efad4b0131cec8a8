!> Headings, paragraphs, items and tables, as Markdown or as a page of man
!>
!> Texts have one mark, that of `vcor_app_inline`: backquotes.
module vcor_app_markup
   use vcor_app_inline, only : guarded, inline, replaced, roff, upper, wrapped
   implicit none
   private

   public :: markup_t, new_page

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Longest line of Markdown outside tables [characters]
   integer, parameter :: markdown_width = 100
   !> Longest line of roff; mandoc complains about more than 80
   integer, parameter :: roff_width = 78

   !> A page that is being written
   type :: markup_t
      !> Whether it is for man; Markdown otherwise
      logical :: man = .false.
      !> What has been written
      character(len=:), allocatable :: text
   contains
      procedure :: heading
      procedure :: paragraph
      procedure :: line
      procedure :: item
      procedure :: block
      procedure :: table
      procedure :: row
      procedure :: aside
   end type markup_t

contains

   !> Begin a page
   subroutine new_page(page, man, name, section, title, about, version)
      !> The page
      type(markup_t), intent(out) :: page
      !> Whether it is for man
      logical, intent(in) :: man
      !> Name of the page of man, such as vcor-input
      character(len=*), intent(in) :: name
      !> Its section, one digit
      character(len=*), intent(in) :: section
      !> Title of the page of Markdown
      character(len=*), intent(in) :: title
      !> What the page of man is about, half a line
      character(len=*), intent(in) :: about
      !> Version of the program
      character(len=*), intent(in) :: version

      page%man = man
      if (man) then
         page%text = '.\" Written by vcor help --man: change the program' &
            //nl//'.TH '//upper(name)//' '//section//' "" "vcor '//version//'" "vcor manual"'//nl
         call page%heading(1, 'Name')
         page%text = page%text//roff(name)//' \- '//roff(about)//nl
      else
         page%text = '<!-- Written by vcor help --markdown: change the program -->'//nl//nl &
            //'# '//title//nl
      end if
   end subroutine new_page

   !> A heading
   subroutine heading(self, level, title)
      !> The page
      class(markup_t), intent(inout) :: self
      !> 1 for a section, 2 for a part of one
      integer, intent(in) :: level
      !> Its words, with marks
      character(len=*), intent(in) :: title

      if (.not. self%man) then
         self%text = self%text//nl//repeat('#', level + 1)//' '//inline(title, .false.)//nl
      else if (level == 1) then
         self%text = self%text//'.SH '//inline(upper(title), .true.)//nl
      else
         self%text = self%text//'.SS '//inline(title, .true.)//nl
      end if
   end subroutine heading

   !> A paragraph
   subroutine paragraph(self, words)
      !> The page
      class(markup_t), intent(inout) :: self
      !> The text, with marks
      character(len=*), intent(in) :: words

      if (self%man) then
         ! right after a heading there is one already
         if (.not. after_heading(self%text)) self%text = self%text//'.PP'//nl
         self%text = self%text//wrapped(inline(words, .true.), roff_width, '', .true.)
      else
         self%text = self%text//nl//wrapped(inline(words, .false.), markdown_width, '', .false.)
      end if
   end subroutine paragraph

   !> A line for itself, such as how a command is called
   subroutine line(self, words)
      !> The page
      class(markup_t), intent(inout) :: self
      !> The text, with marks
      character(len=*), intent(in) :: words

      if (self%man) then
         if (.not. after_heading(self%text)) self%text = self%text//'.br'//nl
         self%text = self%text//inline(words, .true.)//nl
      else
         self%text = self%text//nl//inline(words, .false.)//nl
      end if
   end subroutine line

   !> A term and what it means
   subroutine item(self, term, words)
      !> The page
      class(markup_t), intent(inout) :: self
      !> The term, to be typed or read as it is
      character(len=*), intent(in) :: term
      !> What it means, with marks
      character(len=*), intent(in) :: words

      if (self%man) then
         self%text = self%text//'.TP'//nl//'\fB'//roff(term)//'\fR'//nl &
            //wrapped(inline(words, .true.), roff_width, '', .true.)
      else
         if (.not. after_item(self%text)) self%text = self%text//nl
         self%text = self%text//wrapped('- `'//term//'`: '//inline(words, .false.), &
            markdown_width, '  ', .false.)
      end if
   end subroutine item

   !> Lines to be typed or read as they are
   subroutine block(self, language, words)
      !> The page
      class(markup_t), intent(inout) :: self
      !> Their language, for colours
      character(len=*), intent(in) :: language
      !> The lines, the last one ended too
      character(len=*), intent(in) :: words

      integer :: first, last

      if (.not. self%man) then
         self%text = self%text//nl//'```'//language//nl//words//'```'//nl
         return
      end if
      if (.not. after_heading(self%text)) self%text = self%text//'.PP'//nl
      self%text = self%text//'.nf'//nl//'.RS 4'//nl
      first = 1
      do while (first <= len(words))
         last = first + index(words(first:), nl) - 2
         if (last < first) then
            self%text = self%text//'\&'//nl
         else
            self%text = self%text//guarded(roff(words(first:last)))//nl
         end if
         first = last + 2
      end do
      self%text = self%text//'.RE'//nl//'.fi'//nl
   end subroutine block

   !> Begin a table, in Markdown only
   subroutine table(self, names)
      !> The page
      class(markup_t), intent(inout) :: self
      !> Names of the columns, shape (n)
      character(len=*), intent(in) :: names(:)

      if (self%man) return
      self%text = self%text//nl
      call self%row(names)
      self%text = self%text//'|'//repeat(' --- |', size(names))//nl
   end subroutine table

   !> A row of a table, in Markdown only
   subroutine row(self, cells)
      !> The page
      class(markup_t), intent(inout) :: self
      !> The cells, with marks, shape (n)
      character(len=*), intent(in) :: cells(:)

      integer :: i

      if (self%man) return
      self%text = self%text//'|'
      do i = 1, size(cells)
         self%text = self%text//' '//replaced(inline(trim(cells(i)), .false.), '|', '\|')//' |'
      end do
      self%text = self%text//nl
   end subroutine row

   !> A paragraph of Markdown as it stands, with links; pages of man have none
   subroutine aside(self, words)
      !> The page
      class(markup_t), intent(inout) :: self
      !> The paragraph
      character(len=*), intent(in) :: words

      if (.not. self%man) self%text = self%text//nl//wrapped(words, markdown_width, '', .false.)
   end subroutine aside

   !> Whether the last line of a page of man is a heading
   pure function after_heading(text) result(yes)
      !> The page
      character(len=*), intent(in) :: text
      !> True if it is
      logical :: yes

      integer :: start

      start = index(text(:len(text) - 1), nl, back=.true.) + 1
      yes = index(text(start:), '.SH ') == 1 .or. index(text(start:), '.SS ') == 1
   end function after_heading

   !> Whether the last line of a page of Markdown belongs to an item
   pure function after_item(text) result(yes)
      !> The page
      character(len=*), intent(in) :: text
      !> True if it does
      logical :: yes

      integer :: start

      start = index(text(:len(text) - 1), nl, back=.true.) + 1
      yes = index(text(start:), '- ') == 1 .or. index(text(start:), '  ') == 1
   end function after_item

end module vcor_app_markup
