#!/usr/bin/env bash
# Every stage alone, by --replay, without a network:
#   - one after the other they give the detections of rimod-detect, to the bit;
#   - the same log gives the same log, at any number of threads, also of growing scans;
#   - a long log takes no more memory than a short one, and each of its scans is found;
#   - so are pinhole images of a depth camera that looks down; a sweep is too wide for them, which is told once;
#   - damaged, foreign and missing logs and outputs that cannot be written are told and end with 1.
#   replay_test.sh BIN LOG_DIGEST MODELS LOG SCENE
set -u
bin=$1 digest=$2 models=$3 log=$4 scene=$5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export MALLOC_ARENA_MAX=1  # memory is compared below

fail() {
  echo "FAILED: $*"
  tail -n 5 "$work"/*.err
  exit 1
}
same() {
  cmp "$2" "$3" || fail "$1"
  echo "same: $1"
}
# chain LOG NAME [ASSEMBLER OPTION]: NAME.assembled, NAME.extracted, NAME.matched of a log.
chain() {
  "$bin/rimod-assembler" --replay "$1" --out "$2.assembled" ${3:-} 2>"$2.assembler.err" &&
    "$bin/rimod-extractor" --threads "${threads:-0}" --replay "$2.assembled" --out "$2.extracted" \
      --timing "$2.json" 2>"$2.extractor.err" &&
    "$bin/rimod-matcher" --threads "${threads:-0}" --models "$models" --replay "$2.extracted" \
      --out "$2.matched" 2>"$2.matcher.err" || fail "replay of $1"
}

chain "$log" "$work/once"
"$bin/rimod-detect" --models "$models" "$log" >"$work/offline" 2>"$work/detect.err" || fail "rimod-detect"
[ -s "$work/offline" ] || fail "nothing was found: nothing to compare"
"$digest" detections "$work/once.matched" "$(basename "$log" .lcm)" >"$work/replayed"
same "detections replayed and offline" "$work/replayed" "$work/offline"
grep -q '"range_image": [0-9]' "$work/once.json" || fail "no stage times in $work/once.json"
grep -q 'range_image  *1  *[0-9.]*' "$work/once.extractor.err" || fail "no stage times on stderr"

for threads in 1 3; do chain "$log" "$work/early$threads" --early; done
unset threads
same "sections of growing scans" "$work/early1.assembled" "$work/early3.assembled"
same "descriptions of growing scans" "$work/early1.extracted" "$work/early3.extracted"
for number in 1 3; do
  "$digest" messages "$work/early$number.matched" >"$work/messages$number"
  "$digest" early "$work/early$number.matched" office >"$work/told$number"
  "$digest" told "$work/early$number.matched" >>"$work/told$number"
done
[ -s "$work/told1" ] || fail "nothing was told early"
same "detections and hypotheses with growing scans" "$work/messages1" "$work/messages3"
same "what is told early" "$work/told1" "$work/told3"

"$bin/rimod-simulator" "$scene" --repeat 6 --log "$work/long" 2>"$work/simulator.err" || fail "rimod-simulator"
chain "$work/long" "$work/long_out"
"$digest" detections "$work/long_out.matched" long | sed 's/"scan":"[^"]*",//' >"$work/replayed"
"$bin/rimod-detect" --models "$models" "$work/long" 2>"$work/detect.err" | sed 's/"scan":"[^"]*",//' \
  >"$work/expected"
same "detections of a log of 6 scans" "$work/replayed" "$work/expected"
[ "$(grep -c '"scan":' "$work/long_out.json")" = 6 ] || fail "not the times of 6 scans"
# A sanitizer keeps freed memory for a while: its builds say nothing about memory.
stages="assembler extractor matcher"
if grep -q __asan_init "$bin/rimod-assembler"; then echo "not compared: peak memory, with a sanitizer"; stages=; fi
kilobytes() { sed -n 's/.*peak memory \([0-9]*\) kB/\1/p' "$1"; }
for stage in $stages; do
  once=$(kilobytes "$work/once.$stage.err") many=$(kilobytes "$work/long_out.$stage.err")
  echo "rimod-$stage: peak memory $once kB for one scan, $many kB for 6"
  [ "$many" -le $((once + once / 4 + 10000)) ] || fail "rimod-$stage keeps what it has done"
done

# Pinhole images.
printf 'range_image:\n  projection: pinhole\n' >"$work/pinhole.yaml"
"$bin/rimod-detect" --config "$work/pinhole.yaml" --models "$models" "$log" "$log" >"$work/wide" 2>"$work/wide.err" || fail "rimod-detect"
cat "$work/offline" "$work/offline" | cmp - "$work/wide" || fail "detections of sweeps that are too wide for a pinhole image"
[ "$(grep -c 'too wide' "$work/wide.err")" = 1 ] || fail "too wide for a pinhole image, and not told once"
"$bin/rimod-extractor" --config "$work/pinhole.yaml" --replay "$work/long_out.assembled" --out "$work/wide.extracted" \
  2>"$work/wide.err" || fail "rimod-extractor"
[ "$(grep -c 'too wide' "$work/wide.err")" = 1 ] || fail "too wide for pinhole images, and not told once"
printf 'choice:\n  min_probability: 0.05\n' >>"$work/pinhole.yaml"
"$bin/rimod-sensor-clouds" "$scene" --sensor camera --pitch 40 --yaw -60 -20 20 60 --log "$work/camera" --truth "$work/camera.json" |
  sed -n '/^cloud:/,$p' >>"$work/pinhole.yaml"
camera=(--config "$work/pinhole.yaml" --cloud-channel CLOUD --cloud-pose-channel CARRIER_TO_LOCAL)
"$bin/rimod-detect" "${camera[@]}" --models "$models" "$work/camera" 2>"$work/camera.err" |
  sed 's/"scan":"[^"]*",//' >"$work/expected"
! grep -q 'too wide' "$work/camera.err" || fail "a camera is not too wide for a pinhole image"
[ -s "$work/expected" ] || fail "nothing was found in a camera's clouds: nothing to compare"
"$bin/rimod-extractor" "${camera[@]}" --replay "$work/camera" --out "$work/camera.extracted" 2>"$work/extractor.err" &&
  "$bin/rimod-matcher" --config "$work/pinhole.yaml" --models "$models" --replay "$work/camera.extracted" \
    --out "$work/camera.matched" 2>"$work/matcher.err" || fail "replay of a camera's clouds"
"$digest" detections "$work/camera.matched" camera | sed 's/"scan":"[^"]*",//' >"$work/replayed"
same "detections in pinhole images replayed and offline" "$work/replayed" "$work/expected"

# expect_failure WORDS COMMAND...: ends with 1 and says so.
expect_failure() {
  local words=$1
  shift
  "$@" 2>"$work/failure.err" >/dev/null
  local code=$?
  [ "$code" = 1 ] || fail "exit code $code, not 1: $*"
  grep -q -- "$words" "$work/failure.err" || fail "does not say '$words': $*"
}
assembler=$bin/rimod-assembler
head -c $(($(stat -c %s "$work/long") * 6 / 10)) "$work/long" >"$work/truncated"
expect_failure "truncated or damaged" "$assembler" --replay "$work/truncated" --out "$work/most"
cmp -n $(($(stat -c %s "$work/long_out.assembled") * 45 / 100)) "$work/most" "$work/long_out.assembled" ||
  fail "the whole scans of a truncated log"
{ head -c 10000 "$log"; head -c 5000 /dev/zero; tail -c +10001 "$log"; } >"$work/damaged"
expect_failure "left out" "$assembler" --replay "$work/damaged" --out "$work/most"
head -c 100000 /dev/urandom >"$work/garbage"
expect_failure "is not an LCM log" "$assembler" --replay "$work/garbage" --out "$work/none"
expect_failure "missing: cannot be read" "$assembler" --replay "$work/missing" --out "$work/none"
expect_failure "nothing that this process listens to" "$bin/rimod-extractor" --replay "$log"
expect_failure "cannot be written" "$assembler" --replay "$log" --out "$work/no/folder"
cp "$log" "$work/kept"
expect_failure "is the log that is replayed" "$assembler" --replay "$work/kept" --out "$work/kept"
same "the log that was to be overwritten" "$work/kept" "$log"
for options in "--out x" "--timing x" "--replay x -l udpm://"; do
  "$assembler" $options 2>"$work/failure.err" >/dev/null
  [ $? = 2 ] || fail "bad usage is not exit code 2: $options"
done
echo "damage and bad usage are told"
