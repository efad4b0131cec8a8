#!/usr/bin/env bash
# Installs what vcor needs to be built, and with --tests what its tests need besides, with apt-get.
# Looks for commands and libraries, not for packages: what is there from elsewhere stays as it is.
#
#   scripts/setup.sh [--tests]
set -euo pipefail

say() { printf 'setup: %s\n' "$*"; }
fail() { printf 'setup: error: %s\n' "$*" >&2; exit 1; }

tests=no
case "$*" in
   "") ;;
   --tests) tests=yes ;;
   *) fail "unknown argument '$*', expected --tests or nothing" ;;
esac

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

have() { command -v "$1" >/dev/null 2>&1; }

# compiles COMPILER SOURCE [ARGUMENT ...]: the compiler makes a program of the source
compiles() {
   local compiler=$1 source=$2
   shift 2
   have "$compiler" || return 1
   printf '%s\n' "$source" >"$scratch/probe.f90"
   (cd "$scratch" && "$compiler" -o probe probe.f90 "$@") >/dev/null 2>&1
}

have_fortran() { compiles gfortran 'end'; }

have_cmake() {
   have cmake || return 1
   local found
   found=$(cmake --version | sed -n '1s/[^0-9]*\([0-9.]*[0-9]\).*/\1/p')
   [ "$(printf '%s\n' 3.25 "$found" | sort -V | head -n 1)" = 3.25 ]
}

have_hdf5() {
   compiles h5fc $'use hdf5, only : h5open_f\nuse h5ds, only : h5dsset_scale_f\nend'
}

have_mpi() {
   have mpirun && compiles mpifort $'use mpi_f08, only : mpi_init_thread\nend'
}

have_venv() { have python3 && python3 -c 'import ensurepip, venv' >/dev/null 2>&1; }

have_debian_packages() {
   /usr/bin/python3 -c 'import h5netcdf, h5py, matplotlib, numpy, openpyxl, pytest, scipy, threadpoolctl, tqdm, xarray' >/dev/null 2>&1
}

# need WHAT PACKAGES COMMAND [ARGUMENT ...]: if the command fails, the packages are missing
missing=()
absent=()
need() {
   local what=$1 packages=$2
   shift 2
   if "$@"; then return; fi
   absent+=("$what")
   # shellcheck disable=SC2206  # several packages in one word, none with blanks
   missing+=($packages)
}

look() {
   missing=()
   absent=()
   need "gfortran" "gfortran libc6-dev" have_fortran
   need "cmake 3.25 or later" "cmake" have_cmake
   need "ninja" "ninja-build" have ninja
   need "LAPACK" "liblapack-dev" compiles gfortran 'end' -llapack
   need "BLAS" "libblas-dev" compiles gfortran 'end' -lblas
   need "HDF5 with Fortran (h5fc)" "libhdf5-dev" have_hdf5
   if [ "$tests" = yes ]; then
      # fpm finds HDF5 with it
      need "pkg-config" "pkg-config" have pkg-config
      need "h5dump" "hdf5-tools" have h5dump
      need "OpenMPI with mpi_f08" "libopenmpi-dev openmpi-bin" have_mpi
      need "python3 with venv" "python3 python3-venv" have_venv
      # the Python package is tested with Debian's
      need "xarray and others of Debian" "python3-xarray python3-h5netcdf python3-tqdm \
         python3-matplotlib python3-scipy python3-openpyxl python3-threadpoolctl python3-pytest" have_debian_packages
      # words are completed in them
      need "zsh" "zsh" have zsh
      need "fish" "fish" have fish
      # the pages of man are shown, and packages are made
      need "man" "man-db" have man
      need "dpkg-shlibdeps" "dpkg-dev" have dpkg-shlibdeps
      need "file" "file" have file
      # pages are opened in it, with letters to write them
      need "chromium" "chromium fonts-dejavu-core" have chromium
   fi
}

join() { local IFS=,; printf '%s' "$*" | sed 's/,/, /g'; }

look
if [ ${#missing[@]} -eq 0 ]; then
   say "nothing to install"
   exit 0
fi
say "missing: $(join "${absent[@]}")"

have apt-get || fail "no apt-get here; please install $(join "${absent[@]}")" \
   "(the packages of Debian 12 are ${missing[*]})"

as_root=()
if [ "$(id -u)" -ne 0 ]; then
   have sudo || fail "neither root nor sudo; please install ${missing[*]}"
   as_root=(sudo)
   # Without a terminal there is no way to enter a password
   if [ ! -t 0 ]; then
      sudo -n true 2>/dev/null \
         || fail "sudo wants a password, and there is no terminal;" \
            "please install ${missing[*]}"
      as_root=(sudo -n)
   fi
fi

apt_get() {
   "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get -q -y -o DPkg::Lock::Timeout=120 "$@" </dev/null
}

say "apt-get update"
# A package list of a third party that cannot be loaded is not a reason to stop
apt_get update || say "apt-get update had errors, going on with the lists that are there"
say "apt-get install ${missing[*]}"
apt_get install --no-install-recommends "${missing[@]}" \
   || fail "apt-get could not install ${missing[*]}"

look
[ ${#missing[@]} -eq 0 ] || fail "installed, yet not found: $(join "${absent[@]}")"
say "done"
