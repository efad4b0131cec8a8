# Run by cpack before it makes the packages: the licence gets the place and name of Debian's policy, and
# completion for zsh the folder that Debian's packages use
file(GLOB folders "${CPACK_TEMPORARY_DIRECTORY}/*")
foreach(folder IN LISTS folders)
  cmake_path(GET folder FILENAME component)
  set(package vcor)
  if(component STREQUAL "development")
    set(package libvcor-dev)
  elseif(component STREQUAL "python")
    set(package python3-vcor)
  endif()
  file(MAKE_DIRECTORY "${folder}/usr/share/doc/${package}")
  file(REMOVE "${folder}/usr/share/doc/${package}/LICENSE")
  configure_file("${CMAKE_CURRENT_LIST_DIR}/../LICENSE"
    "${folder}/usr/share/doc/${package}/copyright" COPYONLY)
  if(component STREQUAL "program")
    file(RENAME "${folder}/usr/share/zsh/site-functions" "${folder}/usr/share/zsh/vendor-completions")
  endif()
endforeach()
