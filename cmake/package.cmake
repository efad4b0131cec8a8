# Packages, by `cpack` in the build folder: vcor has the program, libvcor-dev the library for other
# programs, python3-vcor the Python package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "the vcor developers")
# Debian requires an address; publishers of packages set theirs here
set(VCOR_MAINTAINER "the vcor developers <vcor@vcor.invalid>" CACHE STRING
  "Maintainer of the packages, as in: Name <address>")
set(CPACK_PACKAGE_CONTACT "${VCOR_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
set(CPACK_STRIP_FILES TRUE)
# The licence under Debian's name, in a folder for each package
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/debian_layout.cmake")

set(CPACK_COMPONENTS_ALL program development)
if(TARGET vcor_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL TRUE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME vcor)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS TRUE)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "python3-vcor")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"vcor computes how a sphere rebounds from a plate, a half space or another
sphere when at least one of the bodies is viscoelastic: coefficient of
restitution, contact time, indentation, force and energies, with an estimate
of the numerical error. Cases are text files, results CSV and HDF5.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libvcor-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# The compiler that reads the module files, and gcc, with which CMake finds HDF5
string(JOIN ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "gfortran-${vcor_compiler_major}" gfortran ${vcor_debian_packages})
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"The library that the program vcor is made of: archive, module files, CMake
package and pkg-config file, to be used from Fortran.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vcor)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS TRUE)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3-numpy, python3-xarray, \
python3-h5netcdf, python3-h5py | python3-h5py-serial, python3-tqdm, python3-matplotlib, \
python3-scipy, python3-pandas, python3-openpyxl, python3-threadpoolctl")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"The Python package vcor: cases, sweeps, histories, moduli and fits as numpy and
xarray objects, with the same numbers as those of the program, and the commands
that it adds to the program: vcor plot, identify and master.")
include(CPack)
