#!/usr/bin/env bash
# Installs what is missing, builds vcor and runs cases; without arguments the SLS case of the paper.
#
#   scripts/run.sh [CASE.nml ...] [OPTION ...]     cases and options of 'vcor run'
#
# What it does goes to stderr, so that stdout holds what vcor prints and nothing else.
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
say() { printf 'run: %s\n' "$*" >&2; }

say "set-up"
"$top/scripts/setup.sh" >&2

say "release build in $top/build/release"
(cd "$top" && cmake --preset release && cmake --build --preset release --target vcor_program) >&2

[ $# -gt 0 ] || set -- "$top/examples/paper/sls.nml"
say "vcor run $*"
exec "$top/build/release/vcor" run "$@"
