# Where `cmake --install` puts files: component program is for users, development is what others build
# with. All paths are relative to the prefix, so the tree can be moved as a whole.
include(CMakePackageConfigHelpers)

set(vcor_cmake_folder "${CMAKE_INSTALL_LIBDIR}/cmake/vcor")

# Program and library. A shared library (BUILD_SHARED_LIBS) belongs to the program; its version
# changes with every release, since the layout of Fortran types is part of the interface. The version
# of the C interface changes only with its functions
set(vcor_libraries_installed ${vcor_parts})
if(TARGET vcor_c)
  list(APPEND vcor_libraries_installed vcor_c)
endif()
set_target_properties(${vcor_libraries_installed} PROPERTIES
  VERSION "${PROJECT_VERSION}"
  SOVERSION "${PROJECT_VERSION}")
if(TARGET vcor_c)
  set_target_properties(vcor_c PROPERTIES SOVERSION "${PROJECT_VERSION_MAJOR}")
endif()
file(RELATIVE_PATH from_program "/${CMAKE_INSTALL_BINDIR}" "/${CMAKE_INSTALL_LIBDIR}")
if(BUILD_SHARED_LIBS)
  set_target_properties(vcor_program PROPERTIES INSTALL_RPATH "$ORIGIN/${from_program}")
  set_target_properties(${vcor_parts} PROPERTIES INSTALL_RPATH "$ORIGIN")
endif()
install(TARGETS vcor_program RUNTIME COMPONENT program)
install(TARGETS ${vcor_libraries_installed} EXPORT vcorTargets
  LIBRARY COMPONENT program NAMELINK_COMPONENT development
  ARCHIVE COMPONENT development)
install(FILES include/vcor.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development)
install(DIRECTORY "${PROJECT_BINARY_DIR}/include/${vcor_module_folder}/"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/${vcor_module_folder}" COMPONENT development
  FILES_MATCHING PATTERN "*.mod")

# For CMake
install(EXPORT vcorTargets NAMESPACE vcor:: DESTINATION "${vcor_cmake_folder}"
  COMPONENT development)
configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/vcorConfig.cmake.in" "${PROJECT_BINARY_DIR}/vcorConfig.cmake"
  INSTALL_DESTINATION "${vcor_cmake_folder}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/vcorConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_BINARY_DIR}/vcorConfig.cmake" "${PROJECT_BINARY_DIR}/vcorConfigVersion.cmake"
  DESTINATION "${vcor_cmake_folder}" COMPONENT development)

# For pkg-config. A static library needs its dependencies wherever it is linked, so they are not
# private then, and --static is not needed
file(RELATIVE_PATH vcor_up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
string(REGEX REPLACE "/$" "" vcor_up "${vcor_up}")
# vcor_pkg_config(<name> <part> ...): the file of some parts, each before those it depends on. Part vcor
# holds names without code and need not be linked
set(vcor_includes "${CMAKE_INSTALL_INCLUDEDIR}/${vcor_module_folder}")
function(vcor_pkg_config name)
  set(vcor_name "${name}")
  set(own)
  set(needed)
  foreach(part IN LISTS ARGN)
    list(APPEND own "-l${part}")
    list(APPEND needed ${${part}_needed_libraries})
  endforeach()
  list(REMOVE_DUPLICATES needed)
  string(JOIN " " own ${own})
  string(JOIN " " needed ${needed})
  if(BUILD_SHARED_LIBS)
    set(vcor_libraries "${own}\nLibs.private: ${needed}")
  else()
    set(vcor_libraries "${own} ${needed}")
  endif()
  configure_file("${PROJECT_SOURCE_DIR}/cmake/vcor.pc.in" "${PROJECT_BINARY_DIR}/${name}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${name}.pc"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT development)
endfunction()
vcor_pkg_config(vcor vcor_files vcor_core)
vcor_pkg_config(vcor-core vcor_core)
set(vcor_name vcor-c)
set(vcor_libraries -lvcor)
set(vcor_includes "${CMAKE_INSTALL_INCLUDEDIR}")
configure_file("${PROJECT_SOURCE_DIR}/cmake/vcor.pc.in" "${PROJECT_BINARY_DIR}/vcor-c.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/vcor-c.pc"
  DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT development)

# Pages of man, compressed where there is gzip (without a time stamp: the same bytes each time)
file(GLOB vcor_pages CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/man/*.[1-9]")
find_program(VCOR_GZIP gzip DOC "Compresses the pages of man")
mark_as_advanced(VCOR_GZIP)
set(compressed)
foreach(page IN LISTS vcor_pages)
  cmake_path(GET page EXTENSION LAST_ONLY section)
  string(REPLACE "." "" section "${section}")
  if(VCOR_GZIP)
    cmake_path(GET page FILENAME name)
    set(packed "${PROJECT_BINARY_DIR}/man/${name}.gz")
    add_custom_command(OUTPUT "${packed}" DEPENDS "${page}" VERBATIM
      COMMAND "${CMAKE_COMMAND}" -E make_directory "${PROJECT_BINARY_DIR}/man"
      COMMAND "${CMAKE_COMMAND}" -E copy "${page}" "${PROJECT_BINARY_DIR}/man/${name}"
      COMMAND "${VCOR_GZIP}" -9nf "${PROJECT_BINARY_DIR}/man/${name}")
    list(APPEND compressed "${packed}")
    set(page "${packed}")
  endif()
  install(FILES "${page}" DESTINATION "${CMAKE_INSTALL_MANDIR}/man${section}" COMPONENT program)
endforeach()
add_custom_target(vcor_man ALL DEPENDS ${compressed})
# The target of all files that are installed without a component of their own: scripts/run.sh builds it,
# so that its build can be installed
add_custom_target(vcor_installed)
add_dependencies(vcor_installed vcor_program vcor_man ${vcor_libraries_installed})

# Completion of the command line for shells
install(FILES completion/vcor.bash RENAME vcor
  DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT program)
install(FILES completion/_vcor
  DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions" COMPONENT program)
install(FILES completion/vcor.fish
  DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" COMPONENT program)

# The Python package in the folder of Debian's Python, for the Debian package only: others install it
# with pip. Its commands are those of python/pyproject.toml
if(TARGET vcor_python)
  set(python_folder lib/python3/dist-packages)
  install(TARGETS vcor_python LIBRARY DESTINATION "${python_folder}/vcor/lib" COMPONENT python
    EXCLUDE_FROM_ALL)
  install(DIRECTORY python/src/vcor DESTINATION "${python_folder}" COMPONENT python EXCLUDE_FROM_ALL
    PATTERN "__pycache__" EXCLUDE)
  install(DIRECTORY examples/materials DESTINATION "${python_folder}/vcor/lib" COMPONENT python
    EXCLUDE_FROM_ALL FILES_MATCHING PATTERN "*.nml")
  file(WRITE "${PROJECT_BINARY_DIR}/python/vcor-${PROJECT_VERSION}.dist-info/METADATA"
    "Metadata-Version: 2.1\nName: vcor\nVersion: ${PROJECT_VERSION}\n")
  install(DIRECTORY "${PROJECT_BINARY_DIR}/python/" DESTINATION "${python_folder}" COMPONENT python
    EXCLUDE_FROM_ALL)
  file(STRINGS python/pyproject.toml commands REGEX "^vcor-[a-z]+ = ")
  foreach(line IN LISTS commands)
    string(REGEX MATCH "^(vcor-[a-z]+) = \"([a-z._]+):([a-z_]+)\"$" line "${line}")
    file(WRITE "${PROJECT_BINARY_DIR}/bin/${CMAKE_MATCH_1}"
      "#!/usr/bin/python3\nfrom ${CMAKE_MATCH_2} import ${CMAKE_MATCH_3}\n${CMAKE_MATCH_3}()\n")
    install(PROGRAMS "${PROJECT_BINARY_DIR}/bin/${CMAKE_MATCH_1}"
      DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT python EXCLUDE_FROM_ALL)
  endforeach()
endif()

# Documents for users
install(FILES README.md LICENSE CHANGELOG.md CITATION.cff DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
install(DIRECTORY docs examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program
  USE_SOURCE_PERMISSIONS)
