#!/bin/sh
# One scene solved by fracfarm and by a FEniCSx script: seconds, ratio, errors. Installs python3-dolfinx (360 MB) where it is missing; takes about
# a minute on a quiet machine. Options go to tests/comparison/compare.py: --json, --steps N, --explicit-only.
set -u
. "$(dirname "$0")/steps.sh"

{
  say "fracfarm against FEniCSx"
  install_packages build compare
  build_all OFF
} >&2
exec /usr/bin/python3 tests/comparison/compare.py --programs "$FRACFARM_BUILD/bin" "$@"
