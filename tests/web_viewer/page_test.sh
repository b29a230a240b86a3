#!/usr/bin/env bash
# The page of rimod-web in headless Chromium, in a private network: that of the whole pipeline over LCM, or that of
# a log. Exit code 77: cannot run here.
#   page_test.sh pipeline|log BIN MODELS SOURCE LIBRARIES
set -u
part=$1 bin=$2 models=$3 source=$4 libraries=$5
log=$source/logs/office.lcm
url=http://127.0.0.1:8086/

if [ "${IN_OWN_NETWORK:-}" != yes ]; then
  chromium=$(command -v chromium) || { echo "skipped: no chromium; ./setup.sh --web installs it"; exit 77; }
  command -v node >/dev/null || { echo "skipped: no node; ./setup.sh --web installs it"; exit 77; }
  [ -r "$bin/../share/rimod-web/index.html" ] && [ -d "$libraries/node_modules/playwright-core" ] ||
    { echo "skipped: the page was not built, which needs npm (./setup.sh --web) and once the npm registry"; exit 77; }
  unshare -rn true 2>/dev/null || { echo "skipped: private networks are forbidden here"; exit 77; }
  CHROMIUM=$chromium IN_OWN_NETWORK=yes exec timeout --kill-after=5 380 unshare -rn "$0" "$@"
fi

ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo || exit 1
unset LCM_DEFAULT_URL
work=$(mktemp -d)
pids=()
cleanup() {
  kill "${pids[@]}" 2>/dev/null
  wait 2>/dev/null
  rm -rf "$work"
}
trap cleanup EXIT

# start NAME COMMAND...
start() {
  local name=$1
  shift
  "$@" >"$work/$name.log" 2>&1 &
  pids+=($!)
}
page() {
  node "$source/tests/web_viewer/page_test.mjs" "$source" "$libraries" "$CHROMIUM" "$url" "$@" && return
  tail -n 5 "$work"/*.log
  exit 1
}

if [ "$part" = log ]; then
  page log "$bin/rimod-web" --models "$models" --speed 20 "$log"
else
  start assembler "$bin/rimod-assembler"
  start extractor "$bin/rimod-extractor"
  start matcher "$bin/rimod-matcher" --models "$models"
  "$bin/rimod-show" live --await rimod-assembler --await rimod-extractor --await rimod-matcher \
    --timeout 120 || { echo "not all processes came up"; exit 1; }
  page pipeline "$bin/rimod-web" --models "$models" -- lcm-logplayer --speed 5 "$log"
fi
