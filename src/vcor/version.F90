!> Version of the library and the program
module vcor_version
   implicit none
   private

   public :: version

#ifndef VCOR_VERSION
#error "VCOR_VERSION is not defined, expected the version of fpm.toml, as in -DVCOR_VERSION=1.2.3"
#endif

   ! The macro is a bare token (fpm passes no other form of the version), and the preprocessor of
   ! gfortran makes no string of a token. It works line by line, so it replaces a token that has a
   ! line of the string for itself.
   !> Version as in fpm.toml, such as `1.2.3`
   character(len=*), parameter :: version = "&
      &VCOR_VERSION&
      &"

end module vcor_version
