!> The catalogue as JSON, for programs that make forms or manuals of it
module vcor_case_described
   use vcor_case_catalogue, only : described_keys, groups, key_t, kind_name
   use vcor_case_choices, only : choices
   use vcor_json, only : array, member, object, words
   use vcor_number, only : interval_text
   use vcor_words, only : contains_word
   implicit none
   private

   public :: described_groups

contains

   !> All groups with their keys, as a list for `array`
   function described_groups() result(list)
      character(len=:), allocatable :: list

      integer :: i

      list = ""
      do i = 1, size(groups)
         associate (group => groups(i))
            list = list//object(member("name", group%name)//member("meaning", group%meaning) &
               //member("required", group%required)//member("repeated", group%repeated) &
               //member("label", group%label)//member("selector", group%selector) &
               //array(keys_of(group%name), "keys"))
         end associate
      end do
   end function described_groups

   !> The keys of a group
   function keys_of(group) result(list)
      character(len=*), intent(in) :: group
      character(len=:), allocatable :: list

      type(key_t), allocatable :: rows(:)
      character(len=:), allocatable :: text
      integer :: i

      allocate (rows, source=described_keys())
      list = ""
      do i = 1, size(rows)
         associate (key => rows(i))
            if (key%group /= group) cycle
            text = member("name", key%name)//member("type", type_name(key%value_kind)) &
               //member("value", kind_name(key%value_kind))//member("meaning", key%meaning) &
               //member("unit", key%unit)//member("range", interval_text(key%range)) &
               //words("choices", key%choices)//array(meanings_of(key), "meanings") &
               //words("models", key%models) &
               //member("required", key%required)
            if (key%default == "''") then
               text = text//member("default", "")
            else if (key%default /= "") then
               text = text//member("default", key%default)
            end if
            if (key%instead /= "") text = text//member("instead", key%instead)
            list = list//object(text)
         end associate
      end do
   end function keys_of

   !> The words that a key can have, as JSON objects
   function meanings_of(key) result(list)
      type(key_t), intent(in) :: key
      character(len=:), allocatable :: list

      integer :: i

      list = ""
      do i = 1, size(choices)
         if (choices(i)%key == trim(key%group)//"."//key%name .and. contains_word(key%choices, &
            choices(i)%word)) list = list//object(member("word", choices(i)%word) &
            //member("meaning", choices(i)%meaning))
      end do
   end function meanings_of

   !> Name of the type of a key
   pure function type_name(value_kind) result(name)
      !> One of the `*_key` constants
      integer, intent(in) :: value_kind
      !> real, integer, logical, text, or list: one or more reals
      character(len=:), allocatable :: name

      character(len=*), parameter :: names(*) = [character(len=7) :: "real", "integer", "logical", &
         "text", "list"]

      name = trim(names(value_kind))
   end function type_name

end module vcor_case_described
