#!/usr/bin/env bash
# Plays the office log to the real processes over LCM in a private network, recorded by lcm-logger at
# stock settings, and checks that
#   - every message was recorded: all lines and poses, all sections of all that was sent;
#   - the detections equal those of rimod-detect, to the bit;
#   - the recorded log, replayed into each stage alone, gives the same messages again, to the bit;
#   - the same by --replay, without a network;
#   - with growing scans objects are told before the sweep has ended, with ids that stay, and
#     everything else is as before, to the bit.
# Exit code 77: cannot run here.
#   pipeline_test.sh BIN LOG_DIGEST MODELS LOG
set -u
bin=$1 digest=$2 models=$3 log=$4

if [ "${IN_OWN_NETWORK:-}" != yes ]; then
  unshare -rn true 2>/dev/null || { echo "skipped: private networks are forbidden here"; exit 77; }
  IN_OWN_NETWORK=yes exec unshare -rn "$0" "$@"
fi

ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo || exit 1
unset LCM_DEFAULT_URL
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

# run RECORD PROCESS... -- PLAYER_ARGUMENT...: plays a log to the processes, records all channels
# and stops everything when a message of the channel in $awaited is there and nothing more comes.
run() {
  local record=$1 names=() awaits=()
  shift
  pids=()
  lcm-logger --quiet "$record" 2>"$work/lcm-logger.err" &
  pids+=($!)
  while [ "$1" != -- ]; do
    local name=$1 arguments=()
    [ "$name" = rimod-matcher ] && arguments=(--models "$models")
    [ "$name" = rimod-assembler ] && arguments=(${assembler_arguments:-})
    "$bin/$name" "${arguments[@]}" 2>"$work/$name.err" &
    pids+=($!)
    awaits+=(--await "$name")
    names+=("$name")
    shift
  done
  shift
  "$bin/rimod-show" live "${awaits[@]}" --timeout 120 || fail "${names[*]}: not all came up"
  lcm-logplayer "$@" >/dev/null || fail "lcm-logplayer"
  local last=0 now
  for _ in $(seq 300); do  # until the awaited message is there and nothing more comes
    sleep 0.5
    now=$("$digest" messages "$record" | wc -l)
    [ "$now" = "$last" ] && "$digest" messages "$record" | grep -q "^$awaited " && break
    last=$now
  done
  # The receivers of the results end first, so that everything that was sent is recorded.
  for ((i = ${#pids[@]} - 1; i >= 0; --i)); do
    kill -TERM "${pids[$i]}"
    wait "${pids[$i]}" || fail "process ${i} of (lcm-logger ${names[*]}) ended with exit code $?"
  done
  pids=()
}

# messages RECORD CHANNEL...: what was recorded of these channels, sorted.
messages() {
  local record=$1 pattern
  shift
  pattern=$(IFS='|'; echo "$*")
  "$digest" messages "$record" | grep -E "^($pattern) " | sort
}

same() {
  diff "$2" "$3" >"$work/difference" || { head -n 10 "$work/difference"; fail "$1"; }
  echo "same: $1 ($(wc -l <"$2") messages or lines)"
}

echo "== the whole pipeline"
awaited=RIMOD_DETECTIONS
run "$work/all" rimod-assembler rimod-extractor rimod-matcher -- --speed 5 "$log"

messages "$log" LASER LASER_TO_LOCAL >"$work/played"
messages "$work/all" LASER LASER_TO_LOCAL >"$work/recorded"
same "lines and poses played and recorded" "$work/played" "$work/recorded"

# complete RECORD NAMES: every section was recorded, and something on each channel.
complete() {
  "$digest" messages "$1" | awk -v names="$2" '
    /^RIMOD/ { split($3, part, "/"); key = $1 " " $2; total[key] = part[2]; ++seen[key]; ++channel[$1] }
    END {
      for (key in total) if (seen[key] != total[key]) { print key ": " seen[key] " of " total[key]; bad = 1 }
      split(names, name, " ")
      for (i in name) if (!channel["RIMOD_" name[i]]) { print "nothing on RIMOD_" name[i]; bad = 1 }
      exit bad
    }' || fail "the logger missed messages"
  echo "every section was recorded"
}
outputs="SCAN RANGE_IMAGE FEATURES HYPOTHESES DETECTIONS"
complete "$work/all" "$outputs SCAN_AHEAD SCAN_END"

"$bin/rimod-detect" --models "$models" "$log" >"$work/offline" 2>"$work/rimod-detect.err" ||
  fail "rimod-detect"
"$digest" detections "$work/all" "$(basename "$log" .lcm)" >"$work/live"
[ -s "$work/offline" ] || fail "nothing was found: nothing to compare"
same "detections live and offline" "$work/live" "$work/offline"

# The log replayed into one stage alone: INPUTS are played, OUTPUTS must come out as before.
replay() {
  local name=$1 inputs=$2 outputs=$3
  echo "== $name alone"
  awaited=${outputs##* }
  rm -f "$work/$name"
  run "$work/$name" "$name" -- --speed 2 --regexp "^($inputs)\$" "$work/all"
  messages "$work/all" $outputs >"$work/before"
  messages "$work/$name" $outputs >"$work/again"
  same "$outputs" "$work/before" "$work/again"
}
replay rimod-assembler 'LASER|LASER_TO_LOCAL' RIMOD_SCAN
replay rimod-extractor 'RIMOD_SCAN' 'RIMOD_RANGE_IMAGE RIMOD_FEATURES'
replay rimod-extractor 'RIMOD_SCAN_AHEAD|RIMOD_SCAN_END' 'RIMOD_RANGE_IMAGE RIMOD_FEATURES'
replay rimod-extractor 'RIMOD_SCAN.*' 'RIMOD_RANGE_IMAGE RIMOD_FEATURES'
replay rimod-matcher 'RIMOD_RANGE_IMAGE|RIMOD_FEATURES' 'RIMOD_HYPOTHESES RIMOD_DETECTIONS'

# The same without a network, at full speed.
replay_offline() {
  local name=$1 arguments=()
  shift
  [ "$name" = rimod-matcher ] && arguments=(--models "$models")
  "$bin/$name" "${arguments[@]}" --replay "$work/all" --out "$work/$name.replayed" 2>"$work/$name.err" ||
    fail "$name --replay"
  messages "$work/all" "$@" >"$work/before"
  messages "$work/$name.replayed" "$@" >"$work/again"
  same "$* by $name --replay" "$work/before" "$work/again"
}
replay_offline rimod-assembler RIMOD_SCAN
replay_offline rimod-extractor RIMOD_RANGE_IMAGE RIMOD_FEATURES
replay_offline rimod-matcher RIMOD_HYPOTHESES RIMOD_DETECTIONS

echo "== with growing scans"
awaited=RIMOD_DETECTIONS
assembler_arguments=--early run "$work/early" rimod-assembler rimod-extractor rimod-matcher -- "$log"
complete "$work/early" "$outputs SCAN_PARTIAL RANGE_IMAGE_PARTIAL FEATURES_PARTIAL"
for name in $outputs; do
  messages "$work/all" "RIMOD_$name" >"$work/before"
  messages "$work/early" "RIMOD_$name" >"$work/again"
  same "RIMOD_$name with and without growing scans" "$work/before" "$work/again"
done
"$digest" early "$work/early" "$(basename "$log" .lcm)" >"$work/final"
same "what is told in the end and offline" "$work/final" "$work/offline"
"$digest" told "$work/early" | awk '
  $2 == "look" { looked[$1] = 1; ++num }
  $2 == "final" { final[$1] = 1 }
  END {
    for (id in looked) if (!(id in final)) { print "object " id " is not in the final message"; bad = 1 }
    print num + 0 " objects told in looks"
    exit bad || !num
  }' || fail "what was told early"
