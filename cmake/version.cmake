# fpm.toml is the only place of the project's version.
#
#   vcor_read_version(<manifest> <variable>)
#
# sets the variable to the version that the manifest states, such as 1.2.3

function(vcor_read_version manifest variable)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${manifest}")
  file(STRINGS "${manifest}" line REGEX "^version *=" LIMIT_COUNT 1)
  if(NOT line MATCHES "^version *= *\"([0-9]+\\.[0-9]+\\.[0-9]+)\"")
    message(FATAL_ERROR "${manifest}: no line of the form: version = \"1.2.3\"")
  endif()
  set(${variable} "${CMAKE_MATCH_1}" PARENT_SCOPE)
endfunction()
