#!/bin/sh
# Builds what is missing, runs every verification case, writes VERIFICATION.md with its pictures, and copies the summary into README.md.
# With ids (sh deploy/verify.sh FD-11 FD-12) only those cases, whose parts of the page are replaced.
# Ends with status 1 where a row misses; the page is written all the same.
set -u
. "$(dirname "$0")/steps.sh"

say "fracfarm verification"
install_packages build test
step "configure" cmake -S . -B "$FRACFARM_BUILD" -G Ninja -DCMAKE_BUILD_TYPE=Release -DFRACFARM_TESTS=ON
step "build" cmake --build "$FRACFARM_BUILD" --target fracfarm-verify

# Progress goes to the screen: it is minutes.
"$FRACFARM_BUILD/bin/fracfarm-verify" ${*:---long} --markdown --pictures deploy/pictures/verification >"$FRACFARM_LOG/verification.md"
status=$?
if [ $status -gt 1 ] || ! grep -q '^<!-- end of summary -->$' "$FRACFARM_LOG/verification.md"; then
  say "  the cases did not run to their end (status $status)"
  exit 3
fi
if [ $# -gt 0 ]; then
  awk 'function row_of(line) {return match(line, /^\| [A-Z]+-[0-9]+ \|[^|]*\|/) ? substr(line, 1, RLENGTH) : ""}
       /^## / {name = $0; fresh = 1}
       NR == FNR {if (name == "") {if (row_of($0) != "") row[row_of($0)] = $0}
                  else if ($0 == "") gap = "\n"
                  else {part[name] = part[name] (fresh ? "" : gap) $0 "\n"; gap = ""; fresh = 0}
                  next}
       FNR == 1 {name = ""}
       /^## / {if (replaced) print ""; replaced = $0 in part; if (replaced) printf "%s", part[$0]}
       replaced {next}
       row_of($0) in row {print row[row_of($0)]; next}
       {print}' "$FRACFARM_LOG/verification.md" VERIFICATION.md >"$FRACFARM_LOG/page.md" && mv "$FRACFARM_LOG/page.md" VERIFICATION.md
else
  mv "$FRACFARM_LOG/verification.md" VERIFICATION.md
fi

# What stands between the two marks in the README is the page's summary.
if grep -q '^<!-- summary -->$' README.md; then
  awk 'NR == FNR {if (/^<!-- summary -->$/) on = 1; if (on) table = table $0 "\n"; if (/^<!-- end of summary -->$/) on = 0; next}
       /^<!-- summary -->$/ {printf "%s", table; skip = 1}
       !skip {print}
       /^<!-- end of summary -->$/ {skip = 0}' VERIFICATION.md README.md >"$FRACFARM_LOG/readme.md" && mv "$FRACFARM_LOG/readme.md" README.md
fi
say "  VERIFICATION.md: $(grep -c '| pass |' VERIFICATION.md) rows met, $(grep -c '| \*\*MISS\*\* |' VERIFICATION.md) missed"
exit $status
