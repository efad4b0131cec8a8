#!/usr/bin/env bash
# Renews the tables and the figure of docs/performance.md: builds, measures (about two minutes on a
# quiet machine) and writes. The lines behind the tables are in build/release/benchmarks/*.csv.
#
#   benchmarks/make_document.sh [--write-only]      with the measurements that are there
#
# Environment: PYTHON, one with numpy and scipy (default python3); without them, and without
# SUNDIALS, the document has fewer rows.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export BUILD=build/release PYTHON=${PYTHON:-python3}
results=$BUILD/benchmarks

case "${1-}" in
   --write-only) ;;
   "")
      cmake --preset release
      cmake --build --preset release
      "$results/accuracy" "$results"
      benchmarks/compare.sh --csv "$results/comparison.csv"
      ;;
   *) printf 'make_document: unknown argument %s\n' "$1" >&2; exit 1 ;;
esac
"$PYTHON" benchmarks/make_document.py "$results"
