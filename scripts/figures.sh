#!/usr/bin/env bash
# Makes the figures of docs/figures.md: runs the commands of its gallery and copies what they draw.
#
#   scripts/figures.sh [DIRECTORY]       default: docs/gallery
#
# Takes the program of $VCOR, of the release build, or of the PATH; and vcor-plot and vcor-fit of the PATH, or the
# package as its sources are, with $PYTHON (default: that of build/venv) and the library of the build.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
fail() { printf 'figures: error: %s\n' "$*" >&2; exit 1; }

[ $# -le 1 ] || fail "found $# arguments, expected one directory or nothing"
mkdir -p "${1:-$top/docs/gallery}"
target=$(cd "${1:-$top/docs/gallery}" && pwd)

vcor=${VCOR:-$top/build/release/vcor}
if [ ! -x "$vcor" ]; then
   vcor=$(command -v vcor) || fail "no vcor: build it (scripts/run.sh) or name it by VCOR"
fi
vcor=$(realpath "$vcor")

# In a folder of its own, where vcor is the program and examples are where the commands look for them
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
ln -s "$vcor" "$scratch/bin/vcor"
ln -s "$top/examples" "$scratch/examples"
if ! command -v vcor-plot >"$scratch/found"; then
   export PYTHON=${PYTHON:-$top/build/venv/bin/python}
   export PYTHONPATH=$top/python/src${PYTHONPATH:+:$PYTHONPATH}
   export VCOR_LIBRARY=${VCOR_LIBRARY:-$(dirname "$vcor")/libvcor_python.so}
   "$PYTHON" -c 'import sys, importlib.util as u; sys.exit(not all(map(u.find_spec, ["vcor", "matplotlib", "xarray"])))' \
      || fail "no vcor-plot: pip install './python[plot]'"
   # they note what is to be done, for one Python to do it all
   for name in plot fit; do
      printf '#!/bin/sh\nprintf "%%s\\0" %s "$@" "" >>"%s/later"\n' $name "$scratch" >"$scratch/bin/vcor-$name"
      chmod +x "$scratch/bin/vcor-$name"
   done
fi
awk '/^## / { there = /Gallery/ } /^```sh$/ { on = there; next } /^```$/ { on = 0 } on' "$top/docs/figures.md" >"$scratch/commands.sh"

cd "$scratch"
PATH="$scratch/bin:$PATH" bash -euo pipefail commands.sh >"$scratch/screen" \
   || fail "a command of docs/figures.md failed"
[ ! -e later ] || "$PYTHON" -c '
from vcor._command import call
for one in open("later").read().split("\0\0")[:-1]: name, *words = one.split("\0"); call(name, words)
' >"$scratch/screen" || fail "a figure of docs/figures.md failed"
figures=("$scratch"/*.svg)
cp "${figures[@]}" "$target"
printf 'figures: %d figures in %s\n' "${#figures[@]}" "$target"
