#!/usr/bin/env bash
# Long tests that scripts/test.sh leaves out, to be run by hand before a release, after
# scripts/test.sh: the wheel with other Pythons, input for other programs run in them, standard errors of a
# thousand fits; a build for MPI; all tests in the debug build; the test programs with fpm; damaged input
# at length.
#
#   scripts/test_long.sh [COUNT]     damaged inputs and results, default: 20000; an hour or two
#
# The seeds go on where those of the last run ended, so that each run sees others.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
count=${1:-20000}
venv=$PWD/build/venv
[ -x "$venv/bin/python" ] || { echo "test_long: error: run scripts/test.sh first" >&2; exit 1; }
begin() { printf '\ntest_long: %s\n' "$*"; }

# The newest Python of PATH or of pyenv
newest_python() {
   local python
   for python in python3 $(compgen -c python3.) "${PYENV_ROOT:-$HOME/.pyenv}"/versions/*/bin/python3; do
      "$python" -c 'import sys; print("%d.%03d" % sys.version_info[:2], sys.executable)' \
         2>/dev/null || true
   done | grep '^3\.' | sort | tail -n 1 | cut -d ' ' -f 2
}

# all_tests PRESET [OPTION ...]: build and test
all_tests() {
   local preset=$1
   shift
   begin "$preset build, all tests"
   cmake --preset "$preset" -DVCOR_ALL_TESTS=ON -DVCOR_PYTHON="$venv/bin/python" "$@"
   cmake --build --preset "$preset"
   ctest --preset "$preset" --parallel "$(nproc 2>/dev/null || echo 2)"
}

begin "programs and Pythons"
pip=(-m pip install --quiet --disable-pip-version-check --no-input)
"$venv/bin/python" "${pip[@]}" -r tests/requirements_long.txt
"$(newest_python)" -m venv --clear build/newest
build/newest/bin/python "${pip[@]}" -c tests/requirements.txt \
   numpy xarray h5py h5netcdf tqdm matplotlib scipy pytest

all_tests release
all_tests mpi
all_tests debug

begin "the test programs with fpm"
[ ! -d build/pkgconfig ] \
   || export PKG_CONFIG_PATH="$PWD/build/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
"$venv/bin/fpm" test

first=$(cat build/test_long.seed 2>/dev/null || echo 1000)
for preset in debug release; do
   begin "damaged cases and data files from seed $first, $preset build"
   VCOR=$PWD/build/$preset/vcor "$venv/bin/python" tests/cli/fuzz.py "$first" "$count"
done
begin "damaged input of the package, seed $first"
VCOR=$PWD/build/release/vcor VCOR_LIBRARY=$PWD/build/release/libvcor_python.so \
   PYTHONPATH=$PWD/python/src "$venv/bin/python" python/tests/fuzz_package.py "$first" "$count"
echo $((first + count)) >build/test_long.seed

begin "end"
