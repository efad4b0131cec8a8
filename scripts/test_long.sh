#!/usr/bin/env bash
# What scripts/test.sh leaves out because it takes long, to be run by hand before a release, after
# scripts/test.sh: all tests in the debug build, the test programs with fpm, damaged input at length.
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

begin "debug build, all tests"
cmake --preset debug -DVCOR_ALL_TESTS=ON -DVCOR_PYTHON="$venv/bin/python"
cmake --build --preset debug
ctest --preset debug --parallel "$(nproc 2>/dev/null || echo 2)"

begin "the test programs with fpm"
[ ! -d build/pkgconfig ] \
   || export PKG_CONFIG_PATH="$PWD/build/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
"$venv/bin/fpm" test

first=$(cat build/test_long.seed 2>/dev/null || echo 1000)
for preset in debug release; do
   begin "damaged cases and data files from seed $first, $preset build"
   VCOR=$PWD/build/$preset/vcor "$venv/bin/python" tests/cli/fuzz.py "$first" "$count"
done
begin "damaged results, seed $first"
VCOR=$PWD/build/release/vcor "$venv/bin/python" tests/cli/damage.py --count "$count" --seed "$first"
echo $((first + count)) >build/test_long.seed

begin "end"
