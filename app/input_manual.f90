!> Page of the manual on the input, from the catalogue of groups and keys
module vcor_app_input_manual
   use vcor_app_argument, only : has_word
   use vcor_app_markup, only : markup_t, new_page
   use vcor_case_catalogue, only : catalogue, groups, key_t, kind_name, range_text, text_key
   use vcor_version, only : version
   implicit none
   private

   public :: input_manual

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Longest text of a cell of a table [characters]
   integer, parameter :: cell = 400
   !> A short complete case
   character(len=*), parameter :: example = &
      "&impact"//nl//"   velocity = 10.0"//nl//"/"//nl &
      //"&sphere"//nl//"   radius = 0.01"//nl//"   material = 'steel'"//nl//"/"//nl &
      //"&plate"//nl//"   half_thickness = 0.02      ! 40 mm thick"//nl &
      //"   material = 'rubber'"//nl//"/"//nl &
      //"&material"//nl//"   name = 'steel'"//nl//"   model = 'rigid'"//nl &
      //"   density = 7800.0"//nl//"/"//nl &
      //"&material"//nl//"   name = 'rubber'"//nl//"   model = 'prony'"//nl &
      //"   density = 1100.0"//nl//"   poisson_ratio = 0.5"//nl &
      //"   equilibrium_modulus = 10.4e6"//nl//"   moduli = 20.2e6, 38.2e6, 87.3e6"//nl &
      //"   times = 1.0e-3, 1.6e-4, 2.9e-5"//nl//"/"//nl

contains

   !> Case files: every group and every key, from the catalogue
   subroutine input_manual(page, man)
      !> The page
      type(markup_t), intent(out) :: page
      !> Whether it is for man
      logical, intent(in) :: man

      integer :: i

      call new_page(page, man, 'vcor-input', '5', 'Input reference', 'case files of vcor', version)
      call page%heading(1, 'Description')
      call page%paragraph('A case file holds Fortran namelists: groups from `&name` to `/`, with ' &
         //'`key = value` in between, a line for each or separated by commas. `!` begins a ' &
         //'comment. Upper and lower case are the same, the order of groups and keys is free. ' &
         //'Texts stand in quotes, single or double; the numbers of a list are separated by ' &
         //'commas or blanks, and `3*2.0` is 2.0 three times. All numbers are in SI units.')
      call page%paragraph('What is wrong is said with file and line before anything is computed: ' &
         //'an unknown name, a value out of range, a key twice, a key that is missing or does ' &
         //'not belong to the model. `vcor check` prints a case with every default filled in.')
      call page%paragraph('`--set GROUP.KEY=VALUE` replaces a value from the command line. A ' &
         //'material is addressed by its name instead of the group, with `_` for a blank or in ' &
         //'quotes: `--set rubber.beta=600`. A key that the impact does not read is refused, in ' &
         //'`--set` and in `&sweep`, with the reason.')
      call page%aside('What stands behind the keys: [materials](materials.md), ' &
         //'[plate and contact](impact.md), [solver and accuracy](accuracy.md), ' &
         //'[sweeps](sweeps.md), [output](output.md).')

      do i = 1, size(groups)
         call page%heading(1, '&'//trim(groups(i)%name))
         call put_group(page, i)
      end do

      call page%heading(1, 'Example')
      call page%block('fortran', example)
      if (man) then
         call page%heading(1, 'See also')
         call page%paragraph('`vcor`(1), `vcor-output`(5)')
      end if
   end subroutine input_manual

   !> One group and its keys
   subroutine put_group(page, group)
      !> The page
      type(markup_t), intent(inout) :: page
      !> Index of the group
      integer, intent(in) :: group

      character(len=:), allocatable :: words
      character(len=cell) :: cells(6)
      integer :: j, columns
      logical :: by_model

      words = trim(groups(group)%meaning)//'. '
      if (groups(group)%required .and. groups(group)%repeated) then
         words = words//'Required, and may be repeated.'
      else if (groups(group)%required) then
         words = words//'Required.'
      else if (groups(group)%repeated) then
         words = words//'Optional, and may be repeated.'
      else
         words = words//'Optional.'
      end if
      call page%paragraph(words)

      by_model = any(catalogue%group == groups(group)%name .and. catalogue%models /= '')
      columns = merge(6, 5, by_model)
      cells = [character(len=cell) :: 'key', 'meaning', 'unit', 'value', 'default', 'models']
      call page%table(cells(:columns))
      do j = 1, size(catalogue)
         associate (key => catalogue(j))
            if (key%group /= groups(group)%name) cycle
            if (page%man) then
               call page%item(trim(key%name), sentences(key))
               cycle
            end if
            cells(1) = '`'//trim(key%name)//'`'
            cells(2) = key%meaning
            cells(3) = key%unit
            cells(4) = value_words(key)
            cells(5) = default_words(key)
            if (cells(5) == '') cells(5) = '-'
            cells(6) = 'all'
            if (key%models /= '') cells(6) = coded(key%models)
            call page%row(cells(:columns))
         end associate
      end do
      if (by_model) call put_models(page, group)
   end subroutine put_group

   !> The keys of each model
   subroutine put_models(page, group)
      !> The page
      type(markup_t), intent(inout) :: page
      !> Index of the group, which has a selector
      integer, intent(in) :: group

      character(len=:), allocatable :: models, names
      integer :: first, last, j

      models = ''
      do j = 1, size(catalogue)
         if (catalogue(j)%group == groups(group)%name .and. &
            catalogue(j)%name == groups(group)%selector) models = trim(catalogue(j)%choices)
      end do
      call page%paragraph('What belongs to each `'//trim(groups(group)%selector)//'` beside the ' &
         //'keys of all:')
      first = 1
      do while (first <= len(models))
         last = first - 2 + index(models(first:)//' ', ' ')
         names = ''
         do j = 1, size(catalogue)
            if (catalogue(j)%group /= groups(group)%name) cycle
            if (has_word(trim(catalogue(j)%models), models(first:last))) &
               names = trim(names//' '//catalogue(j)%name)
         end do
         call page%item(models(first:last), coded(adjustl(names)))
         first = last + 2
      end do
   end subroutine put_models

   !> A key in a few sentences
   function sentences(key) result(words)
      !> The key
      type(key_t), intent(in) :: key
      !> What it means, what it takes, what it is by default
      character(len=:), allocatable :: words

      integer :: mark

      words = trim(key%meaning)
      mark = index(words//';', ';')
      if (key%unit /= '') words = words(:mark - 1)//' ['//trim(key%unit)//']'//words(mark:)
      words = words//'; '//value_words(key)
      if (key%required) then
         words = words//'; required'
      else if (default_words(key) /= '') then
         words = words//'; default '//default_words(key)
      end if
      words = words//'.'
      if (key%models /= '') words = words//' Models: '//coded(key%models)//'.'
   end function sentences

   !> What a key takes
   function value_words(key) result(words)
      !> The key
      type(key_t), intent(in) :: key
      !> Kind and range, or the words to choose from
      character(len=:), allocatable :: words

      if (key%choices /= '') then
         words = coded(key%choices)
         if (index(trim(key%choices), ' ') > 0) words = 'one of '//words
      else
         words = trim(kind_name(key%value_kind)//' '//range_text(key))
      end if
   end function value_words

   !> Default of a key
   function default_words(key) result(words)
      !> The key
      type(key_t), intent(in) :: key
      !> Its default as it is written in a case; empty where there is none
      character(len=:), allocatable :: words

      words = ''
      if (key%required) then
         words = 'required'
      else if (key%default == "''") then
         words = "`''`"
      else if (key%default /= '' .and. key%value_kind == text_key) then
         words = "`'"//trim(key%default)//"'`"
      else if (key%default /= '') then
         words = '`'//trim(key%default)//'`'
      end if
   end function default_words

   !> Names, each to be typed as it is
   pure function coded(names) result(words)
      !> Names separated by blanks
      character(len=*), intent(in) :: names
      !> The same with marks, and commas between them
      character(len=:), allocatable :: words

      integer :: i

      words = ''
      if (names == '') return
      words = '`'
      do i = 1, len_trim(names)
         if (names(i:i) == ' ') then
            words = words//'`, `'
         else
            words = words//names(i:i)
         end if
      end do
      words = words//'`'
   end function coded

end module vcor_app_input_manual
