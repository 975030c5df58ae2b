#!/bin/sh
# Installs what is missing, builds everything, and runs all tests. Run it again: only what changed is built.
set -u
. "$(dirname "$0")/steps.sh"

say "fracfarm tests"
sections="build test"
[ -n "${FRACFARM_PARAVIEW:-}" ] && sections="$sections paraview"
install_packages $sections
build_all ON

results=$FRACFARM_LOG/tests.log
start=$(date +%s)
ctest --test-dir "$FRACFARM_BUILD" --output-on-failure --timeout 300 -j "$(nproc)" --output-log "$results" --progress
status=$?
say "  tests: $(($(date +%s) - start)) s; the whole output: $results"
[ $status -eq 0 ] || exit 1
say "Look at:"
say "  $FRACFARM_BUILD/bin/fracfarm-verify                 the verification table: target, ours, error"
exit 0
