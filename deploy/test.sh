#!/bin/sh
# Installs what is missing, builds everything, and runs all tests. Run it again: only what changed is built.
set -u
. "$(dirname "$0")/steps.sh"

say "fracfarm tests"
sections="build test"
[ -n "${FRACFARM_PARAVIEW:-}" ] && sections="$sections paraview"
install_packages $sections
build_all ON

# A failed test's own output stands in the log before the list of the failed ones.
FRACFARM_LOG_LINES=400
step "tests" ctest --test-dir "$FRACFARM_BUILD" --output-on-failure --timeout 300 -j "$(nproc)"
grep -a "tests passed" "$FRACFARM_LOG/tests.log"
say ""
say "Look at:"
say "  $FRACFARM_BUILD/bin/fracfarm-verify                 the verification table: target, ours, error"
