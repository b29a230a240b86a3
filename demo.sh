#!/usr/bin/env bash
# Shows rimod at work: builds it and models of the recorded objects, then plays the recorded office
# scan to the real processes over LCM and shows what they find.
set -euo pipefail
cd -- "$(dirname -- "$0")"

usage() {
  cat <<'END'
usage: ./demo.sh [--this-network] [--speed N]
  --this-network  use this machine's own LCM network, not a private one made for the demo; rimod-spy
                  or your own processes can then watch
  --speed N       play the log N times faster than it was recorded (default 5)
END
}

out=demo_out
bin=build/release/bin
log=logs/office.lcm
record=$out/office.lcm
speed=5
network=private
arguments=("$@")
while [ $# -gt 0 ]; do
  case "$1" in
    --this-network) network=this; shift ;;
    --speed) speed=${2:?--speed needs a number}; shift 2 ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
done

say() { printf '\n== %s\n' "$*"; }

build() {
  say "Packages"
  ./setup.sh
  say "Building (preset release)"
  if command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi
  cmake --preset release >"$out/build.log"
  local targets=(rimod-assembler rimod-extractor rimod-matcher rimod-modeler rimod-detect
                 rimod-show rimod-snapshot rimod_lcmtypes_jar)
  cmake --build --preset release --parallel "$(nproc)" --target "${targets[@]}" >>"$out/build.log" 2>&1 &
  local compiler=$!
  while kill -0 $compiler 2>/dev/null; do
    printf '\r%s ' "$(grep -oE '^\[ *[0-9]+%\]' "$out/build.log" | tail -n 1)"
    sleep 1
  done
  echo
  wait $compiler || { tail -n 30 "$out/build.log"; echo "demo.sh: the build failed" >&2; exit 1; }
}

build_models() {
  say "Building the models from their recordings in logs/recordings"
  mkdir -p "$out/models"
  local recording
  for recording in logs/recordings/*/; do
    $bin/rimod-modeler --recording "$recording" --out "$out/models/$(basename "$recording").rimod"
  done
}

without_a_network() {
  cat >&2 <<'END'

demo.sh: a private network cannot be made here (unshare -rn is forbidden, as in some containers).
Two ways to go on:
  ./demo.sh --this-network     the same over this machine's own network; needs a multicast route:
                               ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo
  without any network, the same stages in one process:
    build/release/bin/rimod-detect --models demo_out/models logs/office.lcm > demo_out/office.jsonl
    build/release/bin/rimod-snapshot --models demo_out/models --output demo_out \
      --scan logs/office.lcm --detections demo_out/office.jsonl
END
  exit 1
}

# Processes by name, each stopped on the way out, whatever happens.
declare -A pids=()
start() {
  local name=$1
  shift
  "$@" >"$out/$name.log" 2>&1 &
  pids[$name]=$!
}
stop_all() {
  local name failed=0
  for name in "$@"; do
    kill -TERM "${pids[$name]}" 2>/dev/null || true
    for _ in $(seq 100); do  # 10 s
      kill -0 "${pids[$name]}" 2>/dev/null || break
      sleep 0.1
    done
    kill -KILL "${pids[$name]}" 2>/dev/null || true
    if wait "${pids[$name]}"; then
      echo "$name stopped"
    else
      echo "$name did not stop cleanly, see $out/$name.log" >&2
      failed=1
    fi
    unset "pids[$name]"
  done
  return $failed
}
kill_rest() {
  for pid in "${pids[@]}"; do kill -KILL "$pid" 2>/dev/null || true; done
}

detect() {
  trap kill_rest EXIT
  if [ $network = private ]; then
    unset LCM_DEFAULT_URL
    ip link set lo up
    ip link set lo multicast on
    ip route add 224.0.0.0/4 dev lo
  fi
  say "Starting rimod-assembler, rimod-extractor, rimod-matcher and lcm-logger"
  start lcm-logger lcm-logger --force --quiet "$record"
  start rimod-assembler $bin/rimod-assembler
  start rimod-extractor $bin/rimod-extractor
  start rimod-matcher $bin/rimod-matcher --models "$out/models"
  $bin/rimod-show live --await rimod-assembler --await rimod-extractor --await rimod-matcher \
    --timeout 60 || { echo "demo.sh: not all processes came up, see $out/*.log" >&2; exit 1; }
  echo "all processes tell their status"

  say "Playing $log with lcm-logplayer, $speed times faster than recorded"
  start rimod-show $bin/rimod-show live --count 1 --timeout 120
  lcm-logplayer --speed "$speed" "$log" >/dev/null
  echo "waiting for the detections"
  if ! wait "${pids[rimod-show]}"; then
    echo "demo.sh: no detections within two minutes, see $out/*.log" >&2
    exit 1
  fi
  unset 'pids[rimod-show]'
  sleep 1.2  # until each process has told its last stage times

  say "Stopping"
  stop_all rimod-assembler rimod-extractor rimod-matcher lcm-logger
  say "What was found (from the recording of all channels, $record)"
  $bin/rimod-show "$record"
  say "Pictures"
  $bin/rimod-snapshot --models "$out/models" --output "$out" "$record"
}

if [ "${RIMOD_DEMO_IN_NETWORK:-}" = yes ]; then
  detect
  exit
fi
mkdir -p "$out"
build
build_models
if [ $network = this ]; then
  detect
elif unshare -rn true 2>/dev/null; then
  RIMOD_DEMO_IN_NETWORK=yes exec unshare -rn "./$(basename -- "$0")" ${arguments+"${arguments[@]}"}
else
  without_a_network
fi
