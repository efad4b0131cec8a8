!> Bounces on the screen: a row for each, and how they ended
module vcor_app_bounces
   use vcor_app_screen, only : digits_of_level, padded
   use vcor_impact_bounces, only : bounce_t, bounces_t, ends_contact, ends_count, ends_error, &
      ends_rest, ends_time
   use vcor_kinds, only : wp
   use vcor_rounded, only : significant
   use vcor_text, only : integer_text
   implicit none
   private

   public :: bounces_report

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

   !> Table of the bounces
   function bounces_report(bounces, validity) result(text)
      type(bounces_t), intent(in) :: bounces
      !> Level of validity of the first one
      integer, intent(in) :: validity
      !> Lines
      character(len=:), allocatable :: text

      ! rows at the beginning and at the end of a long table
      integer, parameter :: most = 24, at_end = 6
      integer :: n

      text = '  bounces'//nl//'    '//padded('n', 6)//padded('       time [s]', 17) &
         //padded('   speed [m/s]', 17)//padded('          cor', 17) &
         //padded('     height [m]', 17)//'contacts'//nl
      do n = 1, bounces%count
         if (bounces%count > most .and. n == most - at_end) text = text//'    ...   ' &
            //integer_text(bounces%count - most + 1)//' more in the file of the bounces'//nl
         if (bounces%count > most .and. n >= most - at_end &
             .and. n <= bounces%count - at_end) cycle
         text = text//row_of(n, bounces%list(n), validity)
      end do
      text = text//'    '//ending_of(bounces)//nl//nl
   end function bounces_report

   !> Row of a bounce
   function row_of(n, bounce, validity) result(text)
      !> Its number
      integer, intent(in) :: n
      type(bounce_t), intent(in) :: bounce
      !> Level of validity
      integer, intent(in) :: validity
      character(len=:), allocatable :: text

      text = '    '//padded(integer_text(n), 6)//padded(significant(bounce%time, 8), 17) &
         //padded(significant(bounce%velocity, 4), 17)//padded(significant(bounce%cor, &
         digits_of_level(validity, bounce%cor, bounce%cor_error)), 17) &
         //padded(significant(bounce%height, 4), 17)//integer_text(bounce%contacts)//nl
   end function row_of

   !> How the bounces ended, in words
   function ending_of(bounces) result(text)
      type(bounces_t), intent(in) :: bounces
      character(len=:), allocatable :: text

      text = integer_text(bounces%count)//trim(merge(' bounce ', ' bounces', bounces%count == 1)) &
         //' in '//trim(adjustl(significant(bounces%total_time, 6)))//' s'
      if (bounces%count == 0) text = 'none'
      select case (bounces%ending)
      case (ends_count)
         text = text//', as many as impact.bounces'
      case (ends_rest)
         text = text//'; then the weight keeps the sphere in contact'
      case (ends_time)
         text = text//', solver.end_time'
      case (ends_contact)
         text = text//'; the contact after them lasts'
      case (ends_error)
         text = text//'; later ones are not known to a hundred times the accuracy asked for'
      case default
         continue
      end select
   end function ending_of

end module vcor_app_bounces
