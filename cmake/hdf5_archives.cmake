# Link a program with the static libraries of HDF5 instead of the shared ones, where they exist and a
# test program links with them. Debian's shared libraries load thirty others, for files in a network,
# which takes two thirds of the time of a single impact.

function(vcor_link_hdf5_archives program)
  set(archives)
  # each depends on those after it
  foreach(target IN ITEMS hdf5::hdf5_hl_fortran hdf5::hdf5_hl hdf5::hdf5_fortran hdf5::hdf5)
    if(NOT TARGET ${target})
      return()
    endif()
    get_target_property(file ${target} IMPORTED_LOCATION)
    string(REGEX REPLACE "\\.so$" ".a" archive "${file}")
    if(NOT archive MATCHES "\\.a$" OR NOT EXISTS "${archive}")
      return()
    endif()
    list(APPEND archives "${archive}")
  endforeach()
  # libraries for compression
  list(APPEND archives z sz)

  # the shared libraries stand on the same line, from vcor's library: this option omits them, provided
  # that vcor::files, which uses HDF5, precedes the static libraries
  set(option -Wl,--as-needed)
  get_target_property(folders hdf5::hdf5_fortran INTERFACE_INCLUDE_DIRECTORIES)
  try_compile(vcor_has_hdf5_archives
    SOURCE_FROM_CONTENT hdf5_archives.f90
"program hdf5_archives
   use h5ds, only : h5dsset_scale_f
   use hdf5, only : h5open_f, hid_t
   implicit none
   integer :: status
   call h5open_f(status)
   call h5dsset_scale_f(0_hid_t, status)
end program hdf5_archives
"
    CMAKE_FLAGS "-DINCLUDE_DIRECTORIES=${folders}"
    LINK_OPTIONS ${option}
    LINK_LIBRARIES ${archives})
  if(vcor_has_hdf5_archives)
    target_link_libraries(${program} PRIVATE ${archives})
    target_link_options(${program} PRIVATE ${option})
    message(STATUS "HDF5: the program is linked with its archives")
  endif()
endfunction()
