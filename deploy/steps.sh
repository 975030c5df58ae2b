# Steps that the first-run scripts share; sourced by them, never run by itself. POSIX sh.
# Each step is one line on the screen; what a step prints goes to a log that is shown only when the step fails.

FRACFARM_ROOT=$(cd "$(dirname "$0")/.." && pwd)
FRACFARM_BUILD=${FRACFARM_BUILD:-$FRACFARM_ROOT/build/release}
FRACFARM_LOG=$FRACFARM_BUILD/log
cd "$FRACFARM_ROOT" || exit 1
mkdir -p "$FRACFARM_LOG" || exit 1

say() { printf '%s\n' "$*"; }

# packages_of SECTION...: the names in those sections of packages.txt.
packages_of() {
  for section in "$@"; do
    awk -v want="[$section]" '/^#/ || /^$/ {next} /^\[/ {on = ($0 == want); next} on {print $1}' deploy/packages.txt
  done
}

# how_far LOG SECONDS: "51 of 155, about 70 s left", by the last [n/m] (ninja) or n/m Test (ctest) in the log; nothing where it has none.
how_far() {
  tail -c 4000 "$1" | tr '\r' '\n' | grep -aoE '\[ *[0-9]+/[0-9]+\]|[0-9]+/[0-9]+ Test' | tail -n 1 | tr -dc '0-9/' |
    awk -F/ -v s="$2" '$1 > 0 && $2 >= $1 {printf "%d of %d, about %d s left", $1, $2, s * ($2 - $1) / $1}'
}

# step NAME COMMAND...: runs it with its output in a log, shows how far it is and how long it took. Without a terminal: a line a minute.
step() {
  name=$1
  shift
  log=$FRACFARM_LOG/$(printf '%s' "$name" | tr -c 'a-z0-9\n' '-').log
  start=$(date +%s)
  "$@" >"$log" 2>&1 </dev/null &
  pid=$!
  trap 'kill $pid 2>/dev/null; exit 3' INT TERM
  ticks=0
  while kill -0 $pid 2>/dev/null; do
    sleep 0.5
    ticks=$((ticks + 1))
    took=$(($(date +%s) - start))
    if [ -t 1 ]; then
      printf '\r\033[K  %s … %s s  %s' "$name" "$took" "$(how_far "$log" "$took")"
    elif [ $((ticks % 120)) -eq 0 ]; then
      say "  $name … $took s  $(how_far "$log" "$took")"
    fi
  done
  wait $pid
  status=$?
  trap - INT TERM
  [ -t 1 ] && printf '\r\033[K'
  took=$(($(date +%s) - start))
  if [ $status -ne 0 ]; then
    say "  $name: failed after $took s (status $status); the end of $log:"
    tail -n "${FRACFARM_LOG_LINES:-40}" "$log"
    exit 1
  fi
  say "  $name: done in $took s"
}

# install_packages SECTION...: installs what is missing, through root or sudo; without either, prints the command and stops.
install_packages() {
  missing=""
  for package in $(packages_of "$@"); do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing="$missing $package"
  done
  if [ -z "$missing" ]; then
    say "  packages: all there"
    return
  fi
  command="apt-get install -y --no-install-recommends$missing"
  if [ "$(id -u)" -eq 0 ]; then
    as_root=""
  elif sudo -n true 2>/dev/null; then
    as_root="sudo"
  else
    say "These packages are missing, and installing them needs root. Run this, then start again:"
    say "  sudo sh -c 'apt-get update && $command'"
    exit 1
  fi
  step "package lists" $as_root apt-get update
  step "packages ($(printf '%s' "$missing" | wc -w) missing)" $as_root env DEBIAN_FRONTEND=noninteractive $command
}

# build_all TESTS(ON|OFF): configures and builds into build/release.
build_all() {
  step "configure" cmake -S . -B "$FRACFARM_BUILD" -G Ninja -DCMAKE_BUILD_TYPE=Release -DFRACFARM_TESTS="$1"
  step "build" cmake --build "$FRACFARM_BUILD"
}
