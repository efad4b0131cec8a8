#!/usr/bin/env bash
# Makes the figures of docs/gallery.md: runs the commands that stand there and copies what they draw.
#
#   scripts/figures.sh [DIRECTORY]       default: docs/gallery
#
# Takes the program of $VCOR, of the release build, or of the PATH.
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
awk '/^```sh$/ { on = 1; next } /^```$/ { on = 0 } on' "$top/docs/gallery.md" >"$scratch/commands.sh"

cd "$scratch"
PATH="$scratch/bin:$PATH" bash -euo pipefail commands.sh >"$scratch/screen" \
   || fail "a command of docs/gallery.md failed"
figures=("$scratch"/*.svg)
cp "${figures[@]}" "$target"
printf 'figures: %d figures in %s\n' "${#figures[@]}" "$target"
