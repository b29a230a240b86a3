#!/usr/bin/env bash
# Plays the office log to assembler and extractor, then what they sent to one matcher with all models,
# and once more to three shards and the fuser, in a private network: hypotheses and detections must be
# the same, to the bit. Exit code 77: cannot run here.
#   shards_test.sh BIN LOG_DIGEST MODELS LOG [NAME...]    with names: with these models only
set -u
bin=$1 digest=$2 log=$4

if [ "${IN_OWN_NETWORK:-}" != yes ]; then
  unshare -rn true 2>/dev/null || { echo "skipped: private networks are forbidden here"; exit 77; }
  IN_OWN_NETWORK=yes exec unshare -rn "$0" "$@"
fi

ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo || exit 1
unset LCM_DEFAULT_URL
models=$(realpath "$3")
shift 4
work=$(mktemp -d)
pids=()
cleanup() {
  kill -KILL "${pids[@]}" 2>/dev/null
  wait 2>/dev/null
  rm -rf "$work"
}
trap cleanup EXIT

fail() {
  echo "FAILED: $*"
  tail -n 5 "$work"/*.err
  exit 1
}

if [ $# -gt 0 ]; then
  mkdir "$work/models"
  for name in "$@"; do ln -s "$models/$name.rimod" "$work/models/"; done
  models=$work/models
fi

start() {  # NAME PROGRAM ARGUMENT...
  local name=$1 program=$2
  shift 2
  "$bin/$program" "$@" 2>"$work/$name.err" &
  pids+=($!)
}

# record LOG PLAYED EXPRESSION: plays to what runs until detections are there, then stops all.
record() {
  lcm-logger --quiet "$1" 2>"$work/lcm-logger.err" &
  pids+=($!)
  sleep 4  # the fuser listens for two seconds which shards there are
  lcm-logplayer --speed 2 --regexp "$3" "$2" >/dev/null || fail "lcm-logplayer"
  for _ in $(seq 240); do
    sleep 0.5
    "$digest" messages "$1" | grep -q "^$awaited " && break
  done
  sleep 1
  kill -TERM "${pids[@]}"
  wait "${pids[@]}" || fail "a process ended badly"
  pids=()
}

start assembler rimod-assembler
start extractor rimod-extractor
awaited=RIMOD_FEATURES record "$work/described" "$log" 'LASER|LASER_TO_LOCAL'

start matcher rimod-matcher --models "$models"
awaited=RIMOD_DETECTIONS record "$work/whole" "$work/described" 'RIMOD_RANGE_IMAGE|RIMOD_FEATURES'

for i in 1 2 3; do start "shard$i" rimod-matcher --models "$models" --shard "$i/3"; done
start fuser rimod-fuser
awaited=RIMOD_DETECTIONS record "$work/shared" "$work/described" 'RIMOD_RANGE_IMAGE|RIMOD_FEATURES'

for run in whole shared; do
  "$digest" messages "$work/$run" | grep -E '^RIMOD_(HYPOTHESES|DETECTIONS) ' | sort >"$work/$run.sums"
  "$digest" detections "$work/$run" office >"$work/$run.lines"
done
[ -s "$work/whole.lines" ] || fail "nothing was found: nothing to compare"
[ "$(wc -l <"$work/whole.sums")" = 2 ] || fail "not one message a channel"
diff "$work/whole.lines" "$work/shared.lines" || fail "other detections"
diff "$work/whole.sums" "$work/shared.sums" || fail "other bits"
echo "same: $(wc -l <"$work/whole.lines") detections, and all hypotheses"
