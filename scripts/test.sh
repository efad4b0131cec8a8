#!/usr/bin/env bash
# Installs what is missing and runs every test: CMake release, debug and MPI, fpm, the linter. What
# takes long, such as damaged input at length, is in scripts/test_long.sh.
# Stops at the first step that fails. The last line is the sum of all tests: N passed, N failed
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

passed=0
failed=0
step="start"

begin() {
   step=$*
   printf '\ntest: %s\n' "$step"
}

# Runs on every way out. A step that fails without a failed test (a build, say) counts as one
finish() {
   local code=$?
   jobs -p | xargs -r kill 2>/dev/null || true
   if [ $code -ne 0 ]; then
      printf '\ntest: error: stopped at: %s\n' "$step"
      if [ $failed -eq 0 ]; then failed=1; fi
   fi
   printf '%d passed, %d failed\n' "$passed" "$failed"
}
trap finish EXIT
trap 'exit 130' INT TERM

jobs=$(nproc 2>/dev/null || echo 2)
venv=$PWD/build/venv

# make_venv FOLDER PYTHON ARGUMENT ...: environment of Python with what `pip install ARGUMENT ...` installs,
# made anew only when Python or the list of packages has changed
make_venv() {
   local folder=$1 python=$2 made_of
   shift 2
   made_of=$("$python" --version; cat tests/requirements.txt; echo "$@")
   if [ "$made_of" = "$(cat "$folder/made_of" 2>/dev/null)" ] && "$folder/bin/python" -c '' 2>/dev/null; then
      echo "$folder is up to date"
      return
   fi
   "$python" -m venv --clear "$folder"
   "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --no-input "$@"
   # Last: an installation that was interrupted is done again
   printf '%s' "$made_of" >"$folder/made_of"
}

# The newest Python of PATH or of pyenv
newest_python() {
   local python
   for python in python3 $(compgen -c python3.) "${PYENV_ROOT:-$HOME/.pyenv}"/versions/*/bin/python3; do
      "$python" -c 'import sys; print("%d.%03d" % sys.version_info[:2], sys.executable)' \
         2>/dev/null || true
   done | grep '^3\.' | sort | tail -n 1 | cut -d ' ' -f 2
}

# attribute NAME FILE: number in the first such attribute of an XML file
attribute() { sed -n "s/.*[^a-z]$1=\"\([0-9]*\)\".*/\1/p" "$2" | head -n 1; }

# build PRESET [OPTION ...]: configure and build
build() {
   local preset=$1
   shift
   begin "$preset build"
   cmake --preset "$preset" -DVCOR_WERROR=ON -DVCOR_PYTHON="$venv/bin/python" "$@"
   cmake --build --preset "$preset"
}

# run_tests PRESET: run CTest
run_tests() {
   local preset=$1 report=$PWD/build/$1/ctest.xml code=0 tests bad
   begin "$preset tests"
   rm -f "$report"
   # One more than there are cores: tests of signals, files in use and ranks wait now and then
   ctest --preset "$preset" --parallel $((jobs + 1)) --output-junit "$report" || code=$?
   if [ -f "$report" ]; then
      tests=$(attribute tests "$report")
      bad=$(attribute failures "$report")
      # A test that CTest did not run has not passed
      bad=$((bad + $(attribute skipped "$report") + $(attribute disabled "$report")))
      passed=$((passed + tests - bad))
      failed=$((failed + bad))
   fi
   [ $code -eq 0 ] && [ "${bad:-1}" -eq 0 ]
}

# Where HDF5 is installed for MPI as well, its pkg-config file may be the one named hdf5
find_hdf5() {
   if serial=$(pkg-config --variable=pcfiledir hdf5-serial 2>/dev/null); then
      mkdir -p build/pkgconfig
      ln -sf "$serial/hdf5-serial.pc" build/pkgconfig/hdf5.pc
      export PKG_CONFIG_PATH="$PWD/build/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
   fi
}

# What fpm has built. The same test programs have run in two builds by now: one of them is enough to see
# that fpm's are the same
fpm_tests() {
   local report=build/fpm-test.txt code=0 tests bad
   begin "fpm tests"
   tests=1
   "$venv/bin/fpm" test test_library --flag -O0 2>&1 | tee "$report" || code=$?
   bad=$(grep -c 'Execution for object' "$report" || true)
   # Without a failed program it was the build that failed: none was run
   if [ $code -eq 0 ] || [ "$bad" -gt 0 ]; then
      passed=$((passed + tests - bad))
      failed=$((failed + bad))
   fi
   [ $code -eq 0 ] || return $code
   begin "a project that depends on vcor, with fpm"
   rm -rf build/consumer
   cp -r tests/consumer build/consumer
   cp examples/paper/sls.nml build/consumer
   "$venv/bin/fpm" run from_case --directory build/consumer 2>&1 | tee "$report"
   grep -q '^COR  *0\.40729242 ' "$report"
   passed=$((passed + 1))
}

begin "set-up"
scripts/setup.sh --tests

begin "Python environments, beside the release build"
make_venv "$venv" python3 -r tests/requirements.txt &
environments=$!
# The package is tested with Debian's Python, with this one, and with the newest one that is here, of
# which one test imports a part: nothing is compiled ahead
make_venv build/newest "$(newest_python)" --no-compile -c tests/requirements.txt \
   numpy xarray h5py h5netcdf tqdm matplotlib scipy pytest &
build release
wait $environments
wait $!
# Once more: the tests in Python are there where CMake finds their environment
build release
run_tests release

build debug -DVCOR_BENCHMARKS=OFF
run_tests debug
# What several ranks do is compared with what one does, and takes no time
build mpi -DVCOR_BENCHMARKS=OFF -DCMAKE_Fortran_FLAGS_RELEASE=-O1
# Ranks wait more than they compute: beside them fpm builds, without its own flags, which take a third
# longer; the project that depends on vcor has them
find_hdf5
"$venv/bin/fpm" build --flag -O0 &>build/fpm-build.txt &
fpm_build=$!
run_tests mpi
begin "fpm build"
wait $fpm_build || { cat build/fpm-build.txt; exit 1; }
fpm_tests

begin "linters"
"$venv/bin/fortitude" check
"$venv/bin/ruff" check python
"$venv/bin/ruff" format --check python
(cd python && "$venv/bin/mypy")

begin "end"
