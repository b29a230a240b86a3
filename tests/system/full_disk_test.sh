#!/usr/bin/env bash
# Everything that writes a file, on a disk that is full or becomes so: a clear message, an exit code that is not 0, and nothing left
# that could be taken for a whole file. Exit code 77: cannot run here.
#   full_disk_test.sh BIN MODELS LOGS SCENES
set -u
bin=$1 models=$2 logs=$3 scenes=$4

if [ "${IN_OWN_MOUNTS:-}" != yes ]; then
  unshare -rm true 2>/dev/null || { echo "skipped: private mounts are forbidden here"; exit 77; }
  IN_OWN_MOUNTS=yes exec unshare -rm "$0" "$@"
fi
disk=$(mktemp -d) work=$(mktemp -d)
trap 'umount "$disk" 2>/dev/null; rmdir "$disk"; rm -rf "$work"' EXIT
mount -t tmpfs -o size=256k,nr_inodes=40 tmpfs "$disk" || { echo "skipped: no tmpfs"; exit 77; }

failed=0
# expect_failure WORDS COMMAND...: with so many kilobytes free as $free says, ends with 1, names the cause, leaves nothing.
expect_failure() {
  local words=$1 code left
  shift
  rm -rf "${disk:?}"/*
  head -c "$(((256 - free) * 1024))" /dev/zero >"$disk/filler"
  timeout 120 "$@" >"$work/out" 2>"$work/err"
  code=$?
  left=$(ls "$disk" | grep -v -x -e filler ${expected_left:+-e "$expected_left"})
  if [ "$code" = 1 ] && grep -q -i -- "$words" "$work/err" && [ -z "$left" ]; then
    echo "good: $(basename "$1") ${*: -2}, $free kB free"
  else
    echo "FAILED: exit code $code, left '$left': $*"
    tail -n 3 "$work/err"
    failed=1
  fi
}
full="no space left"
office=$logs/office.lcm
"$bin/rimod-assembler" --replay "$office" --out "$work/scans" 2>/dev/null
mkdir "$work/one" && cp "$models/box.rimod" "$work/one"
"$bin/rimod-extractor" --replay "$work/scans" --out "$work/described" 2>/dev/null
"$bin/rimod-matcher" --models "$work/one" --replay "$work/described" --out "$work/detected" 2>/dev/null
cat "$work/described" "$work/detected" >"$work/pictured"

for free in 0 100; do
  expect_failure "$full" "$bin/rimod-modeler" --recording "$logs/recordings/fan" --out "$disk/fan.rimod"
  expect_failure "$full" "$bin/rimod-simulator" "$scenes/office.yaml" --log "$disk/log"
  expect_failure "$full" "$bin/rimod-simulator" "$scenes/office.yaml" --pcd "$disk/cloud.pcd"
  expect_failure "$full" "$bin/rimod-assembler" --replay "$office" --out "$disk/scans"
  expect_failure "$full" "$bin/rimod-extractor" --replay "$work/scans" --out "$disk/described"
  expect_failure "$full" "$bin/rimod-report" --models "$work/one" --output "$disk/report.html" "$office"
done
free=0
expect_failure "$full" "$bin/rimod-modeler" --inspect "$models/fan.rimod" --output "$disk/fan.png"
expect_failure "$full" "$bin/rimod-simulator" "$scenes/office.yaml" --truth "$disk/truth.json"
expect_failure "$full" "$bin/rimod-detect" --models "$work/one" --timing "$disk/times.json" "$office"
expect_failure "$full" "$bin/rimod-assembler" --replay "$office" --timing "$disk/times.json"
expected_left=pictures
expect_failure "$full" "$bin/rimod-snapshot" --models "$work/one" "$work/pictured" --output "$disk/pictures"
expected_left=recording
expect_failure "$full" "$bin/rimod-simulator" "$scenes/record_carton.yaml" --views 2 --recording "$disk/recording"
[ -z "$(ls "$disk/recording" 2>/dev/null)" ] || { echo "FAILED: half a recording"; failed=1; }
expected_left=
# What goes to stdout.
export bin models work office
for command in 'rimod-detect --models "$models" "$office"' 'rimod-show "$work/detected"' 'rimod-top --json "$work/scans"' \
  'rimod-detect --print-config default'; do
  bash -c "\"\$bin\"/$command" >/dev/full 2>"$work/err"
  code=$?
  if [ "$code" = 1 ] && [ -s "$work/err" ]; then
    echo "good: $command >/dev/full"
  else
    echo "FAILED: exit code $code: $command >/dev/full"
    tail -n 2 "$work/err"
    failed=1
  fi
done
exit $failed
