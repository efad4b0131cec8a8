# Compiler flags, per target: nothing here touches CMAKE_Fortran_FLAGS, which belongs to the user.
#
#   vcor_set_flags(<target> [<level>])
#
# A release uses CMake's -O3 for code that computes impacts and writes sweeps. All other code uses
# <level>, by default -O1, which compiles in half of the time and still finds uninitialised variables. Not
# -ffast-math (it makes ieee_is_nan false) and not -march=native (the program runs elsewhere too).

function(vcor_set_flags target)
  # Only .F90 is preprocessed: CMake would do it to .f90 as well, and compile what comes out
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.f90$")
  set_source_files_properties(${sources} PROPERTIES Fortran_PREPROCESS OFF)

  if(NOT CMAKE_Fortran_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  set(level ${ARGN} -O1)
  list(GET level 0 level)
  list(FILTER sources EXCLUDE REGEX "/src/vcor/(numeric|material|impact|solver|io)/")
  set_source_files_properties(${sources} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:${level}>)
  target_compile_options(${target} PRIVATE
    # -fimplicit-none holds in interface bodies too, which do not inherit the statement
    -std=f2008 -fimplicit-none -Wall -Wextra -Wimplicit-interface
    $<$<BOOL:${VCOR_WERROR}>:-Werror>
    # Under -Og gfortran 12 takes the hidden length of every text of deferred length for
    # uninitialised; the release build keeps this warning, and has none
    $<$<CONFIG:Debug>:-Wno-maybe-uninitialized>
    # Traps are set by the main program, so tests and program get these flags as the library does
    $<$<CONFIG:Debug>:-Og -fbacktrace -fcheck=all -fcheck=no-array-temps>
    $<$<CONFIG:Debug>:-finit-real=snan -ffpe-trap=invalid,zero,overflow>)
endfunction()
