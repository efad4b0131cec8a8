# MINPACK of netlib, which brings no CMake package (Debian: minpack-dev). Sets MINPACK_FOUND and the
# target MINPACK::MINPACK
include(FindPackageHandleStandardArgs)

find_library(MINPACK_LIBRARY NAMES minpack)
mark_as_advanced(MINPACK_LIBRARY)
find_package_handle_standard_args(MINPACK REQUIRED_VARS MINPACK_LIBRARY)

if(MINPACK_FOUND AND NOT TARGET MINPACK::MINPACK)
  add_library(MINPACK::MINPACK UNKNOWN IMPORTED)
  set_target_properties(MINPACK::MINPACK PROPERTIES IMPORTED_LOCATION "${MINPACK_LIBRARY}")
endif()
