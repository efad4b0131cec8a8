!> Text in HDF5 files: of fixed or variable length, in datasets and in attributes
module vcor_io_hdf5_text
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_f_pointer, c_loc, c_null_char, &
      & c_null_ptr, c_ptr
   use hdf5, only : h5aclose_f, h5aexists_f, h5aget_space_f, h5aget_type_f, h5aopen_f, h5aread_f, &
      & h5dread_f, h5dvlen_reclaim_f, h5p_default_f, h5sclose_f, h5sget_simple_extent_dims_f, &
      & h5sget_simple_extent_ndims_f, h5t_string, h5t_string_f, h5tclose_f, h5tcopy_f, &
      & h5tget_class_f, h5tget_cset_f, h5tget_size_f, h5tis_variable_str_f, h5tset_cset_f, hid_t, &
      & hsize_t, size_t
   use vcor_io_column, only : column_t
   implicit none
   private

   public :: read_texts, read_lengths, attribute_of

contains

   !> Lengths of the dimensions of a space
   subroutine read_lengths(space, lengths, status)
      !> The space
      integer(hid_t), intent(in) :: space
      !> Lengths, the slowest first
      integer, allocatable, intent(out) :: lengths(:)
      !> Negative on failure
      integer, intent(out) :: status
      integer(hsize_t), allocatable :: backwards(:), largest(:)
      integer :: rank

      allocate(lengths(0))
      call h5sget_simple_extent_ndims_f(space, rank, status)
      if (status < 0 .or. rank < 1) return
      allocate(backwards(rank), largest(rank))
      call h5sget_simple_extent_dims_f(space, backwards, largest, status)
      if (product(real(backwards)) > real(huge(1))) status = -1
      if (status >= 0) lengths = int(backwards(rank:1:-1))
   end subroutine read_lengths

   !> Read text, of a dataset or an attribute
   subroutine read_texts(object, is_attribute, space, type_id, column, status)
      !> The dataset or the attribute
      integer(hid_t), intent(in) :: object
      !> Whether it is an attribute
      logical, intent(in) :: is_attribute
      !> Its space
      integer(hid_t), intent(in) :: space
      !> Its type in the file
      integer(hid_t), intent(in) :: type_id
      !> Column whose length is set; its texts are afterwards
      type(column_t), intent(inout) :: column
      !> Negative on failure
      integer, intent(out) :: status
      character(len=1, kind=c_char), allocatable, target :: letters(:)
      type(c_ptr), allocatable, target :: places(:)
      type(c_ptr) :: buffer
      integer(hid_t) :: memory_type
      integer(size_t) :: width
      integer :: character_set, i, ignored, j
      logical :: varies

      call h5tis_variable_str_f(type_id, varies, status)
      if (status >= 0) call h5tcopy_f(h5t_string, memory_type, status)
      if (status < 0) return
      call h5tget_cset_f(type_id, character_set, status)
      call h5tset_cset_f(memory_type, character_set, status)
      if (varies) then
         allocate(places(max(1, column%length)))
         places = c_null_ptr
         if (column%length > 0) call read_raw(c_loc(places))
         column%width = 0
         if (status >= 0) then
            do i = 1, column%length
               column%width = max(column%width, length_at(places(i)))
            end do
            allocate(character(len=column%width*column%length) :: column%texts)
            do i = 1, column%length
               column%texts((i-1)*column%width+1:i*column%width) = text_at(places(i))
            end do
            buffer = c_loc(places)
            call h5dvlen_reclaim_f(memory_type, space, h5p_default_f, buffer, ignored)
         end if
      else
         call h5tget_size_f(type_id, width, status)
         call h5tclose_f(memory_type, ignored)
         ! The type of the file itself: with its length and its padding
         memory_type = type_id
         column%width = int(width)
         allocate(letters(max(1, column%width*column%length)))
         letters = " "
         if (column%length > 0) call read_raw(c_loc(letters))
         allocate(character(len=column%width*column%length) :: column%texts)
         do i = 1, column%length
            column%texts((i-1)*column%width+1:i*column%width) = " "
            do j = (i - 1)*column%width + 1, i*column%width
               if (letters(j) == c_null_char) exit
               column%texts(j:j) = letters(j)
            end do
         end do
      end if
      if (memory_type /= type_id) call h5tclose_f(memory_type, ignored)

   contains

      !> Read as it is
      subroutine read_raw(place)
         !> Where it goes
         type(c_ptr), intent(in) :: place

         buffer = place
         if (is_attribute) then
            call h5aread_f(object, memory_type, buffer, status)
         else
            call h5dread_f(object, memory_type, buffer, status)
         end if
      end subroutine read_raw
   end subroutine read_texts

   !> Length of a text of C
   function length_at(place) result(length)
      !> Where it begins, or null
      type(c_ptr), intent(in) :: place
      !> Bytes before its NUL
      integer :: length
      character(kind=c_char), pointer :: letters(:)

      length = 0
      if (.not. c_associated(place)) return
      call c_f_pointer(place, letters, [huge(1)])
      do while (letters(length+1) /= c_null_char)
         length = length + 1
      end do
   end function length_at

   !> A text of C
   function text_at(place) result(text)
      !> Where it begins, or null
      type(c_ptr), intent(in) :: place
      !> The text
      character(len=:), allocatable :: text
      character(kind=c_char), pointer :: letters(:)
      integer :: i

      allocate(character(len=length_at(place)) :: text)
      if (len(text) == 0) return
      call c_f_pointer(place, letters, [len(text)])
      do i = 1, len(text)
         text(i:i) = letters(i)
      end do
   end function text_at

   !> A text attribute of an open object
   function attribute_of(object, name) result(text)
      !> The object
      integer(hid_t), intent(in) :: object
      !> Name of the attribute
      character(len=*), intent(in) :: name
      !> Its value; empty if there is none or it is no single text
      character(len=:), allocatable :: text
      type(column_t) :: column
      integer(hid_t) :: attribute, space, type_id
      integer, allocatable :: lengths(:)
      integer :: class, ignored, status
      logical :: exists

      text = ""
      call h5aexists_f(object, name, exists, status)
      if (status < 0 .or. .not. exists) return
      call h5aopen_f(object, name, attribute, status)
      if (status < 0) return
      call h5aget_type_f(attribute, type_id, status)
      call h5tget_class_f(type_id, class, status)
      call h5aget_space_f(attribute, space, status)
      call read_lengths(space, lengths, status)
      column%length = product(lengths)
      if (status >= 0 .and. class == h5t_string_f .and. column%length == 1) then
         call read_texts(attribute, .true., space, type_id, column, status)
         if (status >= 0) text = trim(column%texts)
      end if
      call h5sclose_f(space, ignored)
      call h5tclose_f(type_id, ignored)
      call h5aclose_f(attribute, ignored)
   end function attribute_of

end module vcor_io_hdf5_text
