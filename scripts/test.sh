#!/usr/bin/env bash
# Installs what is missing and runs the tests: CMake release with the ranks of MPI, CMake debug, fpm,
# the linters. Long tests, such as damaged input at length, is in scripts/test_long.sh.
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

# Environment of Python with tests/requirements.txt, made anew only when Python or that list has changed.
# Nothing is compiled ahead: the tests import a third of it
make_venv() {
   local made_of
   made_of=$(python3 --version; cat tests/requirements.txt)
   if [ "$made_of" = "$(cat "$venv/made_of" 2>/dev/null)" ] && "$venv/bin/python" -c '' 2>/dev/null; then
      echo "$venv is up to date"
      return
   fi
   python3 -m venv --clear "$venv"
   "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-input --no-compile \
      -r tests/requirements.txt
   # Last: an installation that was interrupted is done again
   printf '%s' "$made_of" >"$venv/made_of"
}

# attribute NAME FILE: number in the first such attribute of an XML file
attribute() { sed -n "s/.*[^a-z]$1=\"\([0-9]*\)\".*/\1/p" "$2" | head -n 1; }

# build PRESET [OPTION ...]: configure and build
build() {
   local preset=$1
   shift
   begin "$preset build"
   cmake --preset "$preset" -DVCOR_WERROR=ON -DVCOR_ALL_TESTS=OFF -DVCOR_PYTHON="$venv/bin/python" "$@"
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

# The builds of fpm, without its own flags, which take a third longer: the program, and a project that
# depends on vcor. The test programs with fpm are in scripts/test_long.sh
fpm_builds() {
   find_hdf5
   "$venv/bin/fpm" build --flag -O0
   rm -rf build/consumer
   cp -r tests/consumer build/consumer
   cp examples/paper/sls.nml build/consumer
   "$venv/bin/fpm" run from_case --flag -O0 --directory build/consumer
}

run_linters() {
   "$venv/bin/fortitude" check
   "$venv/bin/ruff" check python
   "$venv/bin/ruff" format --check python
   (cd python && "$venv/bin/mypy")
}

# wait_for PROCESS FILE: wait for a process in the background and show its output
wait_for() {
   local code=0
   wait "$1" || code=$?
   cat "$2"
   [ $code -eq 0 ]
}

begin "set-up"
scripts/setup.sh --tests

begin "environment of Python, during the release build"
make_venv &
environment=$!
build release -DVCOR_TEST_RANKS=ON
wait $environment
# Once more: the tests in Python are there where CMake finds their environment
build release
run_tests release

# fpm compiles one file after the other at times, and a linter takes one core: they run during the debug build
fpm_builds &>build/fpm.txt &
fpm=$!
run_linters &>build/linters.txt &
linters=$!
build debug -DVCOR_BENCHMARKS=OFF
run_tests debug
begin "fpm: the program, and a project that depends on vcor"
wait_for $fpm build/fpm.txt
grep -q '^COR  *0\.40729242 ' build/fpm.txt
passed=$((passed + 1))

begin "linters"
wait_for $linters build/linters.txt

begin "end"
