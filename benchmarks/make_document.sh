#!/usr/bin/env bash
# Renews the tables and the figure of docs/measured.md: builds, measures (about six minutes on a
# quiet machine) and writes. The lines behind the tables are in build/release/benchmarks/*.csv.
#
#   benchmarks/make_document.sh [--write-only]      with the measurements that are there
#   benchmarks/make_document.sh --sweeps            whole sweeps alone, the other tables stay
#
# Environment: PYTHON, one with numpy and scipy (default python3); without them, and without
# SUNDIALS, the document has fewer rows.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export BUILD=build/release PYTHON=${PYTHON:-python3}
results=$BUILD/benchmarks

case "${1-}" in
   --write-only) ;;
   "" | --sweeps)
      cmake --preset release
      cmake --build --preset release
      if [ "${1-}" = --sweeps ]; then
         results=$BUILD/benchmarks/sweeps
         mkdir -p "$results"
      else
         "$results/accuracy" "$results"
         benchmarks/compare.sh --csv "$results/comparison.csv"
      fi
      # whole sweeps; by ranks too where there is MPI
      ranks=()
      if command -v mpirun >/dev/null; then
         cmake --preset mpi
         cmake --build --preset mpi --target vcor_program
         ranks=(build/mpi/vcor)
      fi
      "$PYTHON" benchmarks/sweeps.py "$BUILD/vcor" "$results" "${ranks[@]}"
      ;;
   *) printf 'make_document: unknown argument %s\n' "$1" >&2; exit 1 ;;
esac
"$PYTHON" benchmarks/make_document.py "$results"
