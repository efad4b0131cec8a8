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

# with_cmake PRESET [OPTION ...]: build and run CTest
with_cmake() {
   local preset=$1 report=$PWD/build/$1/ctest.xml code=0 tests bad
   shift
   begin "$preset build"
   cmake --preset "$preset" -DVCOR_WERROR=ON -DVCOR_PYTHON="$venv/bin/python" "$@"
   cmake --build --preset "$preset"
   begin "$preset tests"
   rm -f "$report"
   ctest --preset "$preset" --parallel "$jobs" --output-junit "$report" || code=$?
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

# Build with fpm. The same test programs have run in two builds by now: one of them is enough to see
# that fpm's are the same
with_fpm() {
   local fpm=$venv/bin/fpm report=build/fpm-test.txt code=0 tests bad
   # where HDF5 is installed for MPI as well, its pkg-config file may be the one named hdf5
   if serial=$(pkg-config --variable=pcfiledir hdf5-serial 2>/dev/null); then
      mkdir -p build/pkgconfig
      ln -sf "$serial/hdf5-serial.pc" build/pkgconfig/hdf5.pc
      export PKG_CONFIG_PATH="$PWD/build/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
   fi
   begin "fpm build"
   "$fpm" build
   begin "fpm tests"
   tests=1
   "$fpm" test test_library 2>&1 | tee "$report" || code=$?
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
   "$fpm" run from_case --directory build/consumer 2>&1 | tee "$report"
   grep -q '^COR  *0\.40729242 ' "$report"
   passed=$((passed + 1))
}

begin "set-up"
scripts/setup.sh --tests

begin "release build, and Python environments beside it"
make_venv "$venv" python3 -r tests/requirements.txt &
environments=$!
# The package is tested with Debian's Python, with this one, and with the newest one that is here
make_venv build/newest "$(newest_python)" -c tests/requirements.txt \
   numpy xarray h5py h5netcdf tqdm matplotlib scipy pytest &
cmake --preset release -DVCOR_WERROR=ON
cmake --build --preset release
wait $environments
wait $!

with_cmake release
with_cmake debug -DVCOR_BENCHMARKS=OFF
# What several ranks do is compared with what one does, and takes no time
with_cmake mpi -DVCOR_BENCHMARKS=OFF -DCMAKE_Fortran_FLAGS_RELEASE=-O1
with_fpm

begin "linters"
"$venv/bin/fortitude" check
"$venv/bin/ruff" check python
"$venv/bin/ruff" format --check python
(cd python && "$venv/bin/mypy")

begin "end"
