#!/usr/bin/env bash
# Installs what is missing, builds vcor and runs cases; without arguments the SLS case of the paper.
#
#   scripts/run.sh [CASE.nml ...] [OPTION ...]     cases and options of 'vcor run'
#
# A line for each step that there is something to do in goes to stderr, and all of its output where
# it fails, so that stdout holds what vcor prints and nothing else.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$top/build/release
program=$build/vcor
# as old as the sources that the program was built from
stamp=$build/run.stamp

# step WHAT COMMAND [ARGUMENT ...]: say what is done; the output only where it fails
step() {
   printf 'run: %s\n' "$1" >&2
   shift
   "$@" >"$build/run.log" 2>&1 || { cat "$build/run.log" >&2; exit 1; }
}

# Whether nothing that the program is made of has changed since
is_built() {
   [ -x "$program" ] && [ -e "$stamp" ] || return 1
   [ "$(cat "$stamp")" = "$top" ] || return 1
   [ -z "$(cd "$top" && find CMakeLists.txt CMakePresets.json fpm.toml cmake src app man \
      -newer "$stamp" -print -quit)" ]
}

if ! is_built; then
   mkdir -p "$build"
   printf '%s' "$top" >"$stamp.new"
   step "set-up" "$top/scripts/setup.sh"
   cd "$top"
   step "release build in $build (a minute or two the first time)" sh -c \
      "cmake --preset release && cmake --build --preset release --target vcor_installed"
   cd "$OLDPWD"
   mv "$stamp.new" "$stamp"
fi

[ $# -gt 0 ] || set -- "$top/examples/paper/sls.nml"
exec "$program" run "$@"
