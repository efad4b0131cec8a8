!> Units in which others give data, in those of the SI
module vcor_io_units
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   implicit none
   private

   public :: unit_size, time_units, frequency_units, angular_units, modulus_units

   !> Units of time
   character(len=*), parameter :: time_units = "ns us ms s min h"
   !> Units of angular frequency
   character(len=*), parameter :: angular_units = "rad/s krad/s"
   !> Units of frequency, angular or not
   character(len=*), parameter :: frequency_units = "mHz Hz kHz MHz GHz "//angular_units
   !> Units of modulus
   character(len=*), parameter :: modulus_units = "Pa kPa MPa GPa N/m2 N/mm2"

contains

   !> A unit in that of the SI: s, rad/s or Pa
   pure function unit_size(unit) result(scale)
      !> One of the units
      character(len=*), intent(in) :: unit
      !> In seconds, rad/s or Pa
      real(wp) :: scale

      select case (unit)
      case ("ns")
         scale = 1.0e-9_wp
      case ("us")
         scale = 1.0e-6_wp
      case ("ms")
         scale = 1.0e-3_wp
      case ("min")
         scale = 60.0_wp
      case ("h")
         scale = 3600.0_wp
      case ("kPa", "krad/s")
         scale = 1.0e3_wp
      case ("MPa", "N/mm2")
         scale = 1.0e6_wp
      case ("GPa")
         scale = 1.0e9_wp
      case ("mHz")
         scale = 2.0e-3_wp*pi
      case ("Hz")
         scale = 2.0_wp*pi
      case ("kHz")
         scale = 2.0e3_wp*pi
      case ("MHz")
         scale = 2.0e6_wp*pi
      case ("GHz")
         scale = 2.0e9_wp*pi
      case default
         scale = 1.0_wp
      end select
   end function unit_size

end module vcor_io_units
