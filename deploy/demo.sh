#!/bin/sh
# Installs what is missing, builds, and runs the demo campaign: 5 materials x 2 loads x 2 crack patterns. Run it again: it goes on where it was.
set -u
. "$(dirname "$0")/steps.sh"

say "fracfarm demo"
install_packages build
build_all OFF

bin=$FRACFARM_BUILD/bin
farm=${1:-demo}
"$bin/fracfarm" run deploy/campaigns/demo.toml --farm "$farm" --workers 2 || exit $?
"$bin/fracfarm" verify --farm "$farm" || exit $?
"$bin/fracfarm" jobs --farm "$farm" || exit $?
"$bin/fracfarm" report --farm "$farm" -o "$farm/report.html" || exit $?

say ""
say "Look at:"
say "  $farm/report.html                                  every run in pictures (open it in a browser)"
say "  $bin/fracfarm status --farm $farm"
say "  $bin/fracfarm explain 1 --farm $farm        what happened to one job"
say "  $bin/fracfarm --help"
