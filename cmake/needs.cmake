# Dependencies of the library, each in one line of CMakeLists.txt:
#
#   vcor_needs(<target> <package> [COMPONENTS <component> ...] TARGETS <imported target> ...
#              [DEBIAN <package> ...])
#
# finds the package, links the target with it, and records what builds with an installed library
# need: the line for vcorConfig.cmake in <target>_find_dependencies, the libraries for pkg-config
# in <target>_needed_libraries, Debian's packages in vcor_debian_packages.
#
# A macro, so that the variables set by find_package are visible to the caller.

macro(vcor_needs target package)
  cmake_parse_arguments(need "" "" "COMPONENTS;TARGETS;DEBIAN" ${ARGN})
  if(need_COMPONENTS)
    find_package(${package} REQUIRED COMPONENTS ${need_COMPONENTS})
    string(JOIN " " need_line ${package} COMPONENTS ${need_COMPONENTS})
  else()
    find_package(${package} REQUIRED)
    set(need_line ${package})
  endif()
  target_link_libraries(${target} PRIVATE ${need_TARGETS})

  string(APPEND ${target}_find_dependencies "  find_dependency(${need_line})\n")
  list(APPEND vcor_debian_packages ${need_DEBIAN})
  foreach(need_target IN LISTS need_TARGETS)
    vcor_library_words(need_words ${need_target})
    list(APPEND ${target}_needed_libraries ${need_words})
  endforeach()
endmacro()

# Arguments of the linker for a target or a library: -L/folder -lname for a file (without -L for a
# folder that the linker searches by default), -lname, or an option
function(vcor_library_words result library)
  set(words)
  if(TARGET ${library})
    # an imported target stands for its file and its dependencies
    foreach(property IN ITEMS
        IMPORTED_LOCATION IMPORTED_LOCATION_RELEASE IMPORTED_LOCATION_NONE INTERFACE_LINK_LIBRARIES)
      get_target_property(values ${library} ${property})
      if(values)
        foreach(value IN LISTS values)
          vcor_library_words(more "${value}")
          list(APPEND words ${more})
        endforeach()
      endif()
    endforeach()
    get_target_property(values ${library} INTERFACE_LINK_OPTIONS)
    if(values)
      list(APPEND words ${values})
    endif()
    if(library STREQUAL "OpenMP::OpenMP_Fortran")
      # the compiler's option links the library, too
      set(words ${OpenMP_Fortran_FLAGS})
    endif()
  elseif(IS_ABSOLUTE "${library}")
    cmake_path(GET library PARENT_PATH folder)
    cmake_path(GET library STEM name)
    string(REGEX REPLACE "^lib" "-l" name "${name}")
    if(NOT folder IN_LIST CMAKE_Fortran_IMPLICIT_LINK_DIRECTORIES)
      list(APPEND words "-L${folder}")
    endif()
    list(APPEND words "${name}")
  elseif(library MATCHES "^-")
    list(APPEND words "${library}")
  elseif(NOT library MATCHES "[$<>]")
    list(APPEND words "-l${library}")
  endif()
  list(REMOVE_DUPLICATES words)
  set(${result} ${words} PARENT_SCOPE)
endfunction()
