!> Numbers as values of options
module vcor_app_option_value
   use vcor_case_real, only : read_real
   use vcor_error, only : error_t, error_usage, raise
   use vcor_text, only : integer_text, printable
   use vcor_kinds, only : wp
   implicit none
   private

   public :: read_whole, read_number, read_positive

contains

   !> Read a whole number
   subroutine read_whole(option, value, least, most, number, error)
      character(len=*), intent(in) :: option
      !> The number as it is written
      character(len=*), intent(in) :: value
      !> Smallest number
      integer, intent(in) :: least
      !> Largest number
      integer, intent(in) :: most
      integer, intent(out) :: number
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: digits
      integer, parameter :: most_digits = 9
      integer :: status

      number = least - 1
      digits = trim(adjustl(value))
      status = 0
      if (len(digits) <= most_digits .and. verify(digits, '0123456789') == 0) &
         read (digits, *, iostat=status) number
      if (status /= 0 .or. number < least .or. number > most) call raise(error, error_usage, &
         option//": found '"//printable(digits)//"', expected a whole number from " &
         //integer_text(least)//' to '//integer_text(most))
   end subroutine read_whole

   !> Read a number > 0
   subroutine read_positive(option, value, number, error)
      character(len=*), intent(in) :: option
      !> The number as it is written
      character(len=*), intent(in) :: value
      real(wp), intent(out) :: number
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp), parameter :: smallest = 1.0e-30_wp, largest = 1.0e30_wp
      character(len=*), parameter :: expected = 'a number from 1e-30 to 1e30'

      call read_number(option, value, expected, number, error)
      if (allocated(error)) return
      if (.not. (number >= smallest .and. number <= largest)) call raise(error, error_usage, &
         option//': found '//printable(trim(adjustl(value)))//', expected '//expected)
   end subroutine read_positive

   !> Read a number
   subroutine read_number(option, value, expected, number, error)
      character(len=*), intent(in) :: option
      !> The number as it is written
      character(len=*), intent(in) :: value
      !> What is expected, for the message
      character(len=*), intent(in) :: expected
      real(wp), intent(out) :: number
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: message

      call read_real(trim(adjustl(value)), expected, number, message)
      if (allocated(message)) call raise(error, error_usage, option//': '//message)
   end subroutine read_number

end module vcor_app_option_value
