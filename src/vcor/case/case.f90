!> A case: the user's description of an impact, of its solution and of the output
!>
!> Its entries, and what some of them say about others: defaults that depend on other keys, keys
!> that exclude each other, the materials of the bodies. `vcor_case_reader` reads the inputs of an
!> impact there.
module vcor_case_case
   use vcor_case_catalogue, only : catalogue, find_group, first_row, groups, last_row
   use vcor_case_entries, only : address_t, entries_t, entry_t, operator(==)
   use vcor_kinds, only : wp
   use vcor_text, only : canonical_name
   implicit none
   private

   public :: case_t

   !> A case
   type, extends(entries_t) :: case_t
   contains
      procedure :: start => start_case
      procedure :: remove => remove_item
      procedure :: set_entry => set_and_choose
      procedure :: withdraw, drop_alternative, is_materials, find_material, material_of
      procedure :: has_thickness, has_second_sphere
   end type case_t

contains

   !> Reset the case: no groups, and defaults for all keys
   pure subroutine start_case(self, source)
      class(case_t), intent(inout) :: self
      !> Name of the case file, from which `output.stem` gets its default
      character(len=*), intent(in) :: source

      call self%entries_t%start(source)
      call choose_stem(self)
   end subroutine start_case

   !> Remove an item of a group; a group that occurs once is then as if it were not in the case
   pure subroutine remove_item(self, group, item)
      class(case_t), intent(inout) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Index of the item
      integer, intent(in) :: item

      call self%entries_t%remove(group, item)
      call choose_mechanics(self)
      if (group == find_group('output')) call choose_stem(self)
   end subroutine remove_item

   !> Set an entry without checks; for a number in a list, only that number
   pure subroutine set_and_choose(self, address, entry)
      class(case_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      type(entry_t), intent(in) :: entry

      call self%entries_t%set_entry(address, entry)
      if (decides(self, address)) call choose_mechanics(self)
   end subroutine set_and_choose

   !> Take back a value that was given: its default holds, or what the mechanics choose
   pure subroutine withdraw(self, address)
      class(case_t), intent(inout) :: self
      type(address_t), intent(in) :: address

      call self%unset(address)
      if (decides(self, address)) call choose_mechanics(self)
      if (address == self%address('output', 'stem')) call choose_stem(self)
   end subroutine withdraw

   !> Reset the key that excludes a given one, as drop_height does velocity, and vice versa
   pure subroutine drop_alternative(self, address, always)
      class(case_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      !> Whether to reset it also if it was set, instead of read from the case file
      logical, intent(in) :: always

      type(entry_t) :: entry
      type(address_t) :: other
      integer :: row

      do row = first_row(address%group), last_row(address%group)
         if (catalogue(row)%instead /= catalogue(address%row)%name &
             .and. catalogue(address%row)%instead /= catalogue(row)%name) cycle
         other = self%address(trim(groups(address%group)%name), trim(catalogue(row)%name), &
            address%item)
         entry = self%entry(other)
         if (entry%given .and. (always .or. .not. allocated(entry%origin))) call self%unset(other)
      end do
   end subroutine drop_alternative

   !> Name the files of results after the case file
   pure subroutine choose_stem(self)
      type(case_t), intent(inout) :: self

      character(len=*), parameter :: extension = '.nml'
      character(len=:), allocatable :: stem
      integer :: mark

      associate (source => self%source)
         stem = trim(source(index(source, '/', back=.true.) + 1:))
         mark = index(stem, extension, back=.true.)
         if (mark > 1 .and. mark == len(stem) - len(extension) + 1) stem = stem(:mark - 1)
         if (len(stem) == 0) stem = 'case'
         call self%set(self%address('output', 'stem'), stem, given=.false.)
      end associate
   end subroutine choose_stem

   !> Whether what the mechanics choose depends on an entry
   pure function decides(self, address)
      class(case_t), intent(in) :: self
      type(address_t), intent(in) :: address
      logical :: decides

      decides = address%group == find_group('target') &
         .or. address == self%address('contact', 'mechanics') &
         .or. address == self%address('plate', 'base') &
         .or. address == self%address('plate', 'surface_radius') &
         .or. address == self%address('plate', 'waves') &
         .or. address == self%address('solver', 'method') &
         .or. address == self%address('contact', 'law') &
         .or. address == self%address('contact', 'pair')
   end function decides

   !> Set the keys of the mechanics that the user has not given. By `mechanics` waves, law and
   !> pair; without it a plate on a base has no waves, and with it a second sphere has none either.
   !> The surface of a structure has no other waves than those of its modes. Law and pair are also
   !> those of the coupled contact where that is solved
   pure subroutine choose_mechanics(self)
      type(case_t), intent(inout) :: self

      character(len=:), allocatable :: mechanics, base, waves, method
      logical :: is_exact, has_waves

      call self%get('contact', 'mechanics', mechanics)
      call self%get('plate', 'base', base)
      call self%get('solver', 'method', method)
      is_exact = mechanics == 'exact'
      has_waves = is_exact .and. .not. (self%has_second_sphere() .or. self%count('target') > 0)
      call choose(self, 'plate', 'waves', trim(merge('body', 'none', has_waves)), &
         is_exact .or. base /= 'free' .or. self%count('target') > 0)
      call self%get('plate', 'waves', waves)
      is_exact = is_exact .or. waves == 'body' .or. method == 'coupled'
      call choose(self, 'contact', 'law', 'receding', is_exact)
      call choose(self, 'contact', 'pair', 'series', is_exact)
   end subroutine choose_mechanics

   !> Set a key that is not given, to its default or another text
   pure subroutine choose(self, group, key, text, is_chosen)
      type(case_t), intent(inout) :: self
      character(len=*), intent(in) :: group, key
      !> The other text
      character(len=*), intent(in) :: text
      !> Whether to set this text instead of the default
      logical, intent(in) :: is_chosen

      if (self%given(group, key)) return
      call self%unset(self%address(group, key))
      if (is_chosen) call self%set(self%address(group, key), text, given=.false.)
   end subroutine choose

   !> Whether the case has materials only
   pure function is_materials(self) result(yes)
      class(case_t), intent(in) :: self
      logical :: yes

      integer :: i

      yes = self%count('material') > 0 .and. all([(self%count(groups(i)%name) == 0 &
         .or. groups(i)%name == 'material', i=1, size(groups))])
   end function is_materials

   !> Item of the material with a given name; case is ignored, and blanks are equal to underscores
   pure function find_material(self, name) result(item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: name
      !> Index of the first item of this name; 0 if there is none
      integer :: item

      character(len=:), allocatable :: other

      do item = 1, self%count('material')
         call self%get('material', 'name', other, item)
         if (canonical_name(name) == canonical_name(other)) return
      end do
      item = 0
   end function find_material

   !> Item of the material of a body. A target that has no own material is of that of the plate
   pure recursive function material_of(self, body) result(item)
      class(case_t), intent(in) :: self
      !> sphere, plate or target
      character(len=*), intent(in) :: body
      !> Index of the material; 0 if there is none of this name, and for a target without material
      integer :: item

      character(len=:), allocatable :: name

      item = 0
      if (body == 'target') then
         if (self%count(body) == 0) return
         if (self%row(self%address(body, 'material')) == 0) return
         if (.not. self%given(body, 'material')) then
            item = self%material_of('plate')
            return
         end if
      end if
      call self%get(body, 'material', name)
      item = self%find_material(name)
   end function material_of

   !> Whether the plate has a thickness, under either of its names
   pure function has_thickness(self) result(has)
      class(case_t), intent(in) :: self
      logical :: has

      has = self%given('plate', 'half_thickness') .or. self%given('plate', 'thickness')
   end function has_thickness

   !> Whether the struck surface is that of a second sphere, which is no half space for waves
   pure function has_second_sphere(self) result(has)
      class(case_t), intent(in) :: self
      logical :: has

      has = self%number(self%address('plate', 'surface_radius')) > 0.0_wp
   end function has_second_sphere

end module vcor_case_case
