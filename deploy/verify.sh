#!/bin/sh
# Builds what is missing, runs every verification case, writes VERIFICATION.md with its pictures, and copies the summary into README.md.
# Ends with status 1 where a row misses; the page is written all the same.
set -u
. "$(dirname "$0")/steps.sh"

say "fracfarm verification"
install_packages build test
step "configure" cmake -S . -B "$FRACFARM_BUILD" -G Ninja -DCMAKE_BUILD_TYPE=Release -DFRACFARM_TESTS=ON
step "build" cmake --build "$FRACFARM_BUILD" --target fracfarm-verify

# Progress goes to the screen: it is minutes.
"$FRACFARM_BUILD/bin/fracfarm-verify" --long --markdown --pictures deploy/pictures/verification >"$FRACFARM_LOG/verification.md"
status=$?
if [ $status -gt 1 ] || ! grep -q '^<!-- end of summary -->$' "$FRACFARM_LOG/verification.md"; then
  say "  the cases did not run to their end (status $status)"
  exit 3
fi
mv "$FRACFARM_LOG/verification.md" VERIFICATION.md

# What stands between the two marks in the README is the page's summary.
if grep -q '^<!-- summary -->$' README.md; then
  awk 'NR == FNR {if (/^<!-- summary -->$/) on = 1; if (on) table = table $0 "\n"; if (/^<!-- end of summary -->$/) on = 0; next}
       /^<!-- summary -->$/ {printf "%s", table; skip = 1}
       !skip {print}
       /^<!-- end of summary -->$/ {skip = 0}' VERIFICATION.md README.md >"$FRACFARM_LOG/readme.md" && mv "$FRACFARM_LOG/readme.md" README.md
fi
say "  VERIFICATION.md: $(grep -c '| pass |' VERIFICATION.md) rows met, $(grep -c '| \*\*MISS\*\* |' VERIFICATION.md) missed"
exit $status
