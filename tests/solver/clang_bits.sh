#!/bin/sh
# clang_bits.sh SOURCE BUILD: builds the solver and its golden hashes with clang in a folder of their own and runs them.
# Exit status: 0 same bits, 77 no clang here, else they differ or clang could not build them.
set -eu
if ! command -v clang++ >/dev/null; then
  echo "no clang++ on this machine: not compared (Debian: apt-get install clang)"
  exit 77
fi
cmake -S "$1" -B "$2" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang >"$2.log" 2>&1 || { cat "$2.log"; exit 1; }
cmake --build "$2" --target test_golden >"$2.log" 2>&1 || { tail -50 "$2.log"; exit 1; }
"$2/bin/test_golden"
