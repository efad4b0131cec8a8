!> The C interface: cases are made, copied, changed and written; include/vcor.h documents its
!> functions
!>
!> Texts are handled in the critical section `vcor_c_api`, see `vcor_c_api`.
module vcor_c_api_cases
   use, intrinsic :: iso_c_binding, only : c_associated, c_f_pointer, c_int, c_loc, c_null_ptr, &
      c_ptr
   use vcor_c_api_handle, only : find_place, follow, forget, handle_t, note, open_case, whole_folder
   use vcor_c_api_values, only : c_column_t, c_text, demand, new_column, put_column, put_copy, &
      put_pointer, refuse_long, report_error
   use vcor_case_address, only : resolve
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, groups, list_key
   use vcor_case_checks, only : validate
   use vcor_case_described, only : described_groups
   use vcor_case_entries, only : address_t, entry_t
   use vcor_case_printed, only : case_text, value_text
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_io_case_reader, only : add_materials, read_case, read_case_text, set_value
   use vcor_io_data_file, only : file_keys
   use vcor_io_dump, only : dump_case, load_case
   use vcor_io_file, only : write_file
   use vcor_io_path, only : folder_of, full_path, join_path
   use vcor_io_posix, only : fortran => fortran_text
   use vcor_json, only : array
   use vcor_number, only : real_text
   use vcor_text, only : integer_text, printable, shortened
   implicit none
   private

   public :: vcor_read, vcor_free, vcor_copy, vcor_dump, vcor_load, vcor_name, vcor_add_materials, &
      vcor_replace_material, vcor_remove_sweeps, vcor_set, vcor_unset, vcor_get, vcor_describe, &
      vcor_catalogue, vcor_case_text, vcor_save

contains

   !> Read a case from text or from a file
   function vcor_read(text, name, self, error) bind(c) result(code)
      type(c_ptr), value :: text, name, self, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble

      call put_pointer(self, c_null_ptr)
      call demand(name, 'name', trouble)
      call demand(self, 'self', trouble)
      if (.not. allocated(trouble)) then
!$omp critical (vcor_c_api)
         allocate (handle)
         if (c_associated(text)) then
            call read_case_text(handle%case, fortran(text), fortran(name), trouble)
         else
            call read_case(handle%case, fortran(name), trouble)
         end if
         handle%place = full_path('')
         if (allocated(trouble)) then
            deallocate (handle)
         else
            call put_pointer(self, c_loc(handle))
         end if
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_read

   !> Release a case
   subroutine vcor_free(self) bind(c)
      type(c_ptr), value :: self

      type(handle_t), pointer :: handle

      if (.not. c_associated(self)) return
      call c_f_pointer(self, handle)
      deallocate (handle)
   end subroutine vcor_free

   !> Make another case of the same values
   function vcor_copy(self, copy, error) bind(c) result(code)
      type(c_ptr), value :: self, copy, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle, other
      type(error_t), allocatable :: trouble

      call put_pointer(copy, c_null_ptr)
      call open_case(self, handle, trouble)
      call demand(copy, 'copy', trouble)
      if (.not. allocated(trouble)) then
!$omp critical (vcor_c_api)
         allocate (other)
         other%case = handle%case
         other%place = handle%place
         if (allocated(handle%tuned)) other%tuned = handle%tuned
         if (allocated(handle%reported)) other%reported = handle%reported
         if (allocated(handle%solver)) allocate (other%solver, source=handle%solver)
         call put_pointer(copy, c_loc(other))
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_copy

   !> Get a case as bytes
   function vcor_dump(self, text, error) bind(c) result(code)
      type(c_ptr), value :: self, text, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble

      call put_pointer(text, c_null_ptr)
      call open_case(self, handle, trouble)
      call demand(text, 'text', trouble)
      if (.not. allocated(trouble)) then
!$omp critical (vcor_c_api)
         call follow(handle)
         call put_copy(text, c_text(dump_case(handle%case, handle%place)), trouble)
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_dump

   !> Make a case from its bytes
   function vcor_load(text, self, error) bind(c) result(code)
      type(c_ptr), value :: text, self, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble

      call put_pointer(self, c_null_ptr)
      call demand(text, 'text', trouble)
      call demand(self, 'self', trouble)
      if (.not. allocated(trouble)) then
!$omp critical (vcor_c_api)
         allocate (handle)
         call load_case(fortran(text), handle%case, handle%place, trouble)
         if (allocated(trouble)) then
            deallocate (handle)
         else
            call put_pointer(self, c_loc(handle))
         end if
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_load

   !> Get the name of a case
   function vcor_name(self, name, error) bind(c) result(code)
      type(c_ptr), value :: self, name, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble

      call put_pointer(name, c_null_ptr)
      call open_case(self, handle, trouble)
      call demand(name, 'name', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) call put_copy(name, c_text(handle%case%source), trouble)
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_name

   !> Complete a case by materials
   function vcor_add_materials(self, materials, error) bind(c) result(code)
      type(c_ptr), value :: self, materials, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle, other
      type(error_t), allocatable :: trouble

      call open_case(self, handle, trouble)
      call demand(materials, 'materials', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) then
         call c_f_pointer(materials, other)
         call take_materials(handle, other, trouble)
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_add_materials

   !> Put a material in the place of one
   function vcor_replace_material(self, material, text, source, error) bind(c) result(code)
      type(c_ptr), value :: self, material, text, source, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(handle_t) :: other
      type(error_t), allocatable :: trouble
      type(address_t) :: place

      call open_case(self, handle, trouble)
      call demand(material, 'material', trouble)
      call demand(text, 'text', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) &
         call find_place(handle%case, fortran(material)//'.name', place, trouble)
      if (.not. allocated(trouble)) then
         other%place = handle%place
         if (c_associated(source)) then
            other%place = full_path('')
            call read_case_text(other%case, fortran(text), fortran(source), trouble)
         else
            call read_case_text(other%case, fortran(text), handle%case%source, trouble)
         end if
      end if
      if (.not. allocated(trouble)) then
         if (other%case%is_materials() .and. other%case%count('material') > 1) then
            call raise(trouble, error_input, printable(other%case%source)//': found ' &
               //integer_text(other%case%count('material'))//' &material groups, expected one')
         else
            call take_materials(handle, other, trouble, place%item)
         end if
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_replace_material

   !> Take the materials of another case
   subroutine take_materials(handle, other, error, place)
      type(handle_t), intent(inout) :: handle
      !> May be the same
      type(handle_t), intent(inout) :: other
      !> Error of code `error_input` if it has other groups, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Index of the material that is replaced; absent: none
      integer, intent(in), optional :: place

      type(case_t) :: added

      call follow(handle)
      call follow(other)
      added = other%case
      if (.not. added%is_materials()) then
         call raise(error, error_input, printable(added%source) &
            //': found other groups, expected &material groups alone')
         return
      end if
      ! names of folders are relative to where the process was
      if (allocated(handle%case%folder) .or. allocated(added%folder)) then
         handle%case%folder = whole_folder(handle)
         added%folder = whole_folder(other)
      end if
      call add_materials(handle%case, added, place)
      call forget(handle)
   end subroutine take_materials

   !> Remove the &sweep groups
   function vcor_remove_sweeps(self, error) bind(c) result(code)
      type(c_ptr), value :: self, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble

      call open_case(self, handle, trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) then
         call handle%case%clear(find_group('sweep'))
         call forget(handle)
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_remove_sweeps

   !> Set a value
   function vcor_set(self, address, value, error) bind(c) result(code)
      type(c_ptr), value :: self, address, value, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(address_t) :: place

      call open_case(self, handle, trouble)
      call demand(address, 'address', trouble)
      call demand(value, 'value', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) then
         call set_value(handle%case, fortran(address), fortran(value), trouble)
         if (.not. allocated(trouble)) then
            call find_place(handle%case, fortran(address), place, trouble)
            call note(handle, place)
         end if
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_set

   !> Remove a value or a group
   function vcor_unset(self, address, error) bind(c) result(code)
      type(c_ptr), value :: self, address, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(address_t) :: place

      call open_case(self, handle, trouble)
      call demand(address, 'address', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) then
         call find_removed(handle%case, trim(adjustl(fortran(address))), place, trouble)
      end if
      if (.not. allocated(trouble)) then
         if (place%row == 0) then
            call handle%case%remove(place%group, place%item)
         else
            call handle%case%withdraw(place)
         end if
         call forget(handle)
         ! its mesh may be that of another impact
         if (allocated(handle%solver)) deallocate (handle%solver)
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_unset

   !> Find what is to be removed: a value, a group that occurs once or a material
   subroutine find_removed(case, name, place, error)
      type(case_t), intent(in) :: case
      !> An address, or the name of a group or of a material, which may be quoted
      character(len=*), intent(in) :: name
      !> Its place; row 0 for a group or a material
      type(address_t), intent(out) :: place
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: message
      type(address_t) :: material
      logical :: is_group

      place%group = find_group(name)
      is_group = place%group > 0
      if (is_group) is_group = .not. groups(place%group)%repeated
      material%item = case%find_material(name)
      ! the quotes that tell a material from a group in an address
      if (material%item == 0 .and. scan(name, '''"') == 1) &
         call resolve(case, name//'.name', material, message)
      if (is_group .and. material%item > 0) then
         call raise(error, error_usage, shortened(name)//': found the name of a group and of a ' &
            //"material, expected '"//shortened(name)//"' in quotes for the material, or a key " &
            //'of the group')
      else if (is_group) then
         place%item = 1
         return
      else if (material%item > 0) then
         place%group = find_group('material')
         place%item = material%item
         return
      end if
      if (.not. allocated(error)) call find_place(case, name, place, error)
      if (.not. allocated(error) .and. place%element > 0) call raise(error, error_usage, &
         shortened(name)//': found one number of a list, expected the list')
   end subroutine find_removed

   !> Get the value at an address
   function vcor_get(self, address, value, error) bind(c) result(code)
      type(c_ptr), value :: self, address, value, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(address_t) :: place
      character(len=:), allocatable :: written
      type(entry_t) :: entry

      call put_pointer(value, c_null_ptr)
      call open_case(self, handle, trouble)
      call demand(address, 'address', trouble)
      call demand(value, 'value', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) &
         call find_place(handle%case, fortran(address), place, trouble)
      if (.not. allocated(trouble)) then
         entry = handle%case%entry(place)
         if (place%element > 0) then
            call put_copy(value, c_text(real_text(entry%number)), trouble)
         else if (entry%present) then
            written = value_text(catalogue(place%row), entry)
            ! a comma tells a list of one number from a number
            if (catalogue(place%row)%value_kind == list_key) then
               if (size(entry%list) == 1) written = written//','
            end if
            call put_copy(value, c_text(written), trouble)
         end if
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_get

   !> Get path, unit and meaning of an address
   function vcor_describe(self, address, column, error) bind(c) result(code)
      type(c_ptr), value :: self, address, column, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(address_t) :: place
      character(len=:), allocatable :: path

      call put_column(column, c_column_t())
      call open_case(self, handle, trouble)
      call demand(address, 'address', trouble)
      call demand(column, 'column', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) &
         call find_place(handle%case, fortran(address), place, trouble)
      if (.not. allocated(trouble)) then
         path = handle%case%path(place)
         associate (key => catalogue(max(place%row, handle%case%row(place))))
            call refuse_long(path, trouble)
            if (.not. allocated(trouble)) &
               call put_column(column, new_column(path, key%unit, key%meaning))
         end associate
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_describe

   !> Get the groups and keys of cases
   function vcor_catalogue(text, error) bind(c) result(code)
      type(c_ptr), value :: text, error
      integer(c_int) :: code

      type(error_t), allocatable :: trouble
      character(len=:), allocatable :: list

      call put_pointer(text, c_null_ptr)
      call demand(text, 'text', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) then
         list = array(described_groups())
         ! a comma and the end of the line follow the bracket
         call put_copy(text, c_text(list(:len(list) - 2)), trouble)
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_catalogue

   !> Get the case as namelists
   function vcor_case_text(self, complete, text, error) bind(c) result(code)
      type(c_ptr), value :: self
      integer(c_int), value :: complete
      type(c_ptr), value :: text, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble

      call put_pointer(text, c_null_ptr)
      call open_case(self, handle, trouble)
      call demand(text, 'text', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) call validate(handle%case, trouble)
      if (.not. allocated(trouble)) &
         call put_copy(text, c_text(case_text(handle%case, complete=complete /= 0)), trouble)
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_case_text

   !> Write the case to a file
   function vcor_save(self, path, complete, error) bind(c) result(code)
      type(c_ptr), value :: self, path
      integer(c_int), value :: complete
      type(c_ptr), value :: error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(case_t) :: case

      call open_case(self, handle, trouble)
      call demand(path, 'path', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) call validate(handle%case, trouble)
      if (.not. allocated(trouble)) then
         case = handle%case
         if (full_path(folder_of(fortran(path))) /= full_path(whole_folder(handle))) &
            call fix_files(case, whole_folder(handle))
         call write_file(fortran(path), case_text(case, complete=complete /= 0), trouble)
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_save

   !> Give the data files by their absolute paths
   subroutine fix_files(case, folder)
      type(case_t), intent(inout) :: case
      !> Where they are, absolute
      character(len=*), intent(in) :: folder

      character(len=:), allocatable :: file
      integer :: i, item

      do item = 1, case%count('material')
         do i = 1, size(file_keys)
            call case%get('material', trim(file_keys(i)), file, item)
            if (file /= '') call case%set(case%address('material', trim(file_keys(i)), item), &
               join_path(folder, file), given=.true.)
         end do
      end do
      call case%get('target', 'file', file)
      if (file /= '') call case%set(case%address('target', 'file'), join_path(folder, file), &
         given=.true.)
   end subroutine fix_files

end module vcor_c_api_cases
