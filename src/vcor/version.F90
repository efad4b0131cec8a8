!> Version of the library and the program
module vcor_version
   implicit none
   private

   public :: version

#ifndef VCOR_VERSION
#error "VCOR_VERSION is not defined, expected the version of fpm.toml, as in -DVCOR_VERSION=1.2.3"
#endif

   ! The macro is a bare token, since fpm passes the version in no other form, and gfortran's
   ! preprocessor cannot turn a token into a string. But it works line by line, and replaces a token
   ! that has a line of the string to itself.
   !> Version as in fpm.toml, such as `1.2.3`
   character(len=*), parameter :: version = "&
      &VCOR_VERSION&
      &"

end module vcor_version
