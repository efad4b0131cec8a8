#!/usr/bin/env bash
# vcor compared with other ODE solvers, on the same impacts at the same error of cor (below
# 1e-8): a table on the screen, or with --csv FILE the lines behind it in a file.
#
#   benchmarks/compare.sh [--csv FILE]
#
# The general-purpose solvers are CVODE of SUNDIALS and those of SciPy; runge_kutta is an explicit
# method written for the impact, which does for materials with long relaxation times only.
#
# Environment: BUILD, the build folder (default build/release); PYTHON, one with numpy and scipy
# (default python3). Needs the programs of the build folder. CVODE and SciPy are left out where they
# are missing, with a line that says so.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
here=benchmarks
build=${BUILD:-build/release}
python=${PYTHON:-python3}
programs=$build/benchmarks

note() { printf 'compare: %s\n' "$*" >&2; }
fail() { note "error: $*"; exit 1; }

csv=
case "$#:${1-}" in
   0:) ;;
   2:--csv) csv=$2 ;;
   *) fail "usage: compare.sh [--csv FILE]" ;;
esac
[ -x "$programs/same_error" ] || fail "no $programs/same_error: build it first," \
   "cmake --preset release && cmake --build --preset release"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
lines=$scratch/lines
echo problem,solver,settings,error,microseconds,spread,steps >"$lines"

# take WHAT COMMAND ...: the lines of a program, or a note with its last words
take() {
   local what=$1
   shift
   "$@" >>"$lines" 2>"$scratch/stderr" && return
   note "$what is left out: $(grep -E '^(benchmark|solve_ivp):' "$scratch/stderr" \
      || tail -n 1 "$scratch/stderr")"
}

have_scipy=no
if "$python" -c 'import numpy, scipy' 2>/dev/null; then have_scipy=yes; fi
have_problems=no
if "$python" "$here/problems.py" "$scratch" 2>/dev/null; then have_problems=yes; fi
[ $have_problems = yes ] || note "no python3: problems.py cannot run, so only vcor does"
[ -x "$programs/cvode" ] || note "no CVODE: install libsundials-dev and configure anew"
[ $have_scipy = yes ] || note "no SciPy in $python"

for name in sls butyl_prony butyl_cerf butyl_power_law; do
   for method in ive direct; do
      take "vcor $method for $name" \
         "$programs/same_error" examples/paper/$name.nml ${name}_v10 $method
   done
   # the sum of exponentials that the others get, as a Prony series
   if [ -e "$scratch/${name}_modes.nml" ]; then
      take "vcor ive for the modes of $name" \
         "$programs/same_error" "$scratch/${name}_modes.nml" ${name}_v10 ive
   fi
   if [ $have_problems = yes ] && [ -x "$programs/cvode" ]; then
      take "CVODE for $name" "$programs/cvode" "$scratch/$name.txt"
      take "Runge-Kutta for $name" "$programs/runge_kutta" "$scratch/$name.txt"
   fi
   if [ $have_scipy = yes ]; then
      take "SciPy for $name" "$python" "$here/solve_ivp.py" $name
   fi
done
sed -i 's/^\([a-z_]*\)_modes,vcor ive,/\1,vcor ive as prony,/' "$lines"

if [ -n "$csv" ]; then
   mkdir -p "$(dirname "$csv")"
   cp "$lines" "$csv"
fi
# The ratio is to vcor's ive, as a Prony series where the kernel itself cannot be had that way
awk -F, 'NR == 1 { next }
   { line[NR] = $0
     if ($2 == "vcor ive" || ($2 == "vcor ive as prony" && !($1 in base))) base[$1] = $5 }
   END {
      form = "%-16s %-18s %10s %14s %8s %8s   %s\n"
      printf form, "problem", "solver", "error", "us per impact", "+- %", "ratio", "settings"
      for (i = 2; i <= NR; i++) {
         split(line[i], f, ",")
         ratio = f[1] in base ? sprintf("%.1f", f[5]/base[f[1]]) : "-"
         printf form, f[1], f[2], f[4], f[5], sprintf("%.1f", 100*f[6]), ratio, f[3]
      } }' "$lines"
