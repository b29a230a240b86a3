#!/usr/bin/env bash
# The command lines of rimod-show, rimod-top, rimod-snapshot, rimod-view, rimod-meldis and rimod-report: exit codes, clear words, nothing on stdout but
# results.
#   commands_test.sh BIN LOG
set -u
bin=$1 log=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

# check WHAT EXPECTED_CODE PATTERN COMMAND...: exit code, and what it says on stderr.
check() {
  local what=$1 code=$2 pattern=$3 actual
  shift 3
  timeout 60 "$@" >"$work/stdout" 2>"$work/stderr"
  actual=$?
  if [ "$actual" -ne "$code" ] || { [ -n "$pattern" ] && ! grep -q -- "$pattern" "$work/stderr"; }; then
    echo "FAILED: $what: exit code $actual, not $code, or no '$pattern' in:"
    cat "$work/stderr"
    failures=$((failures + 1))
  fi
}

head -c 5000 "$log" >"$work/truncated.lcm"
: >"$work/empty.lcm"
head -c 100000 /dev/zero >"$work/zeros.lcm"
mkdir "$work/models"
echo nonsense >"$work/models/broken.rimod"
mkdir "$work/none"
printf '%s\n' '{"scan":"x"}' >"$work/bad.jsonl"
: >"$work/nothing.jsonl"
printf 'VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 0 0\n2 1 0\n' >"$work/x.pcd"

show=$bin/rimod-show
check "show: no source" 2 "required" "$show"
check "show: unknown option" 2 "nonsense" "$show" --nonsense "$log"
check "show: missing log" 1 "$work/missing" "$show" "$work/missing"
check "show: log without detections" 1 "nothing on RIMOD_DETECTIONS" "$show" "$log"
check "show: truncated log" 1 "truncated.lcm" "$show" "$work/truncated.lcm"
check "show: empty log" 1 "empty.lcm" "$show" "$work/empty.lcm"
check "show: no log at all" 1 "zeros.lcm" "$show" "$work/zeros.lcm"
check "show: a folder" 1 "models" "$show" "$work/models"
check "show: unknown channel" 2 "NONSENSE" "$show" "$log" --channel NONSENSE=OTHER
check "show: missing configuration" 2 "none.yaml" "$show" "$log" --config "$work/none.yaml"

top=$bin/rimod-top
check "top: unknown option" 2 "nonsense" "$top" --nonsense
check "top: missing log" 1 "$work/missing" "$top" "$work/missing"
check "top: truncated log" 1 "truncated.lcm" "$top" "$work/truncated.lcm"
check "top: empty log" 1 "empty.lcm" "$top" "$work/empty.lcm"
check "top: no log at all" 1 "zeros.lcm" "$top" "$work/zeros.lcm"
check "top: log of other channels" 1 "nothing of the pipeline" "$top" "$log" \
  --channel LASER=A --channel LASER_TO_LOCAL=B
check "top: unknown channel" 2 "NONSENSE" "$top" "$log" --channel NONSENSE=OTHER
check "top: missing configuration" 2 "none.yaml" "$top" "$log" --config "$work/none.yaml"
check "top: a log" 0 "" "$top" "$log"
grep -q "^  LASER  *361 " "$work/stdout" || { echo "FAILED: top: lines:"; cat "$work/stdout"; failures=$((failures + 1)); }
check "top: a log as JSON" 0 "" "$top" --json "$log"
grep -q '{"channel":"LASER","messages":361,' "$work/stdout" || { echo "FAILED: top: JSON:"; cat "$work/stdout"; failures=$((failures + 1)); }

snapshot=$bin/rimod-snapshot
check "snapshot: nothing to draw" 2 "LOG or --scan" "$snapshot" --models "$work/none" --output "$work/out"
check "snapshot: scan without detections" 2 "detections" "$snapshot" --models "$work/none" \
  --output "$work/out" --scan "$work/x.pcd"
check "snapshot: log without detections" 1 "nothing on RIMOD_DETECTIONS" "$snapshot" \
  --models "$work/none" --output "$work/out" "$log"
check "snapshot: missing models" 1 "$work/missing" "$snapshot" --models "$work/missing" \
  --output "$work/out" "$log"
check "snapshot: broken model" 1 "broken.rimod" "$snapshot" --models "$work/models" \
  --output "$work/out" --scan "$work/x.pcd" --detections "$work/nothing.jsonl"
check "snapshot: bad detections" 1 "bad.jsonl: line 1" "$snapshot" --models "$work/none" \
  --output "$work/out" --scan "$work/x.pcd" --detections "$work/bad.jsonl"
check "snapshot: missing scan" 1 "$work/y.pcd" "$snapshot" --models "$work/none" \
  --output "$work/out" --scan "$work/y.pcd" --detections "$work/nothing.jsonl"
check "snapshot: output is a file" 1 "x.pcd" "$snapshot" --models "$work/none" \
  --output "$work/x.pcd" --scan "$work/x.pcd" --detections "$work/nothing.jsonl"

view=$bin/rimod-view
check "view: unknown option" 2 "nonsense" "$view" --nonsense
check "view: unknown layer" 2 "nonsense" "$view" --layers points,nonsense --output "$work/out" "$log"
check "view: no screen" 1 "DISPLAY is not set" env -u DISPLAY -u WAYLAND_DISPLAY "$view" "$log"
check "view: a screen that is not there" 1 "no window" env DISPLAY=:4711 QT_QPA_PLATFORM=xcb "$view" "$log"
check "view: missing log" 1 "$work/missing" "$view" --output "$work/out" "$work/missing"
check "view: truncated log" 1 "truncated.lcm" "$view" --output "$work/out" "$work/truncated.lcm"
check "view: no log at all" 1 "zeros.lcm" "$view" --output "$work/out" "$work/zeros.lcm"
check "view: missing models" 1 "$work/missing" "$view" --models "$work/missing" --output "$work/out" "$log"
check "view: broken model" 1 "broken.rimod" "$view" --models "$work/models" --output "$work/out" "$work/x.pcd"
check "view: output is a file" 1 "x.pcd" "$view" --output "$work/x.pcd" "$log"
check "view: pictures of a log" 0 "" "$view" --output "$work/view" "$log"
[ "$(cat "$work/stdout")" = "$work/view/$(basename "$log" .lcm).png" ] && [ -s "$(cat "$work/stdout")" ] ||
  { echo "FAILED: view: printed"; cat "$work/stdout"; failures=$((failures + 1)); }
check "meldis: unknown option" 2 "nonsense" "$bin/rimod-meldis" --nonsense

report=$bin/rimod-report
mkdir "$work/recordings"
echo '{"scans": [{"scan": "x", "objects": [{"class": "fan", "pose": [1, 0, 0, 1, 0, 0, 0]}]}]}' >"$work/labels.json"
echo '[{"scan": "x", "ms": {"matching": -1}}]' >"$work/times.json"
check "report: no source" 2 "source" "$report" --models "$work/none" --output "$work/r.html"
check "report: no output" 2 "output" "$report" --models "$work/none" "$work/x.pcd"
check "report: missing models" 1 "$work/missing" "$report" --models "$work/missing" \
  --output "$work/r.html" "$work/x.pcd"
check "report: broken model" 1 "broken.rimod" "$report" --models "$work/models" \
  --output "$work/r.html" "$work/x.pcd"
check "report: missing scan" 1 "$work/y.pcd" "$report" --models "$work/none" \
  --output "$work/r.html" "$work/y.pcd"
check "report: truncated log" 1 "truncated.lcm" "$report" --models "$work/none" \
  --output "$work/r.html" "$work/truncated.lcm"
check "report: no log at all" 1 "zeros.lcm" "$report" --models "$work/none" \
  --output "$work/r.html" "$work/zeros.lcm"
check "report: missing labels" 1 "$work/no.json" "$report" --models "$work/none" \
  --labels "$work/no.json" --output "$work/r.html" "$work/x.pcd"
check "report: labels that are none" 1 "bad.jsonl" "$report" --models "$work/none" \
  --labels "$work/bad.jsonl" --output "$work/r.html" "$work/x.pcd"
check "report: label without a model" 1 "no model of class fan" "$report" --models "$work/none" \
  --labels "$work/labels.json" --output "$work/r.html" "$work/x.pcd"
check "report: bad detections" 1 "bad.jsonl: line 1" "$report" --models "$work/none" \
  --detections "$work/bad.jsonl" --output "$work/r.html" "$work/x.pcd"
check "report: bad times" 1 "times.json" "$report" --models "$work/none" \
  --timing "$work/times.json" --output "$work/r.html" "$work/x.pcd"
check "report: output is a folder" 1 "recordings" "$report" --models "$work/none" \
  --output "$work/recordings" "$work/x.pcd"
check "report: cases are a file" 1 "x.pcd" "$report" --models "$work/none" \
  --cases "$work/x.pcd" --output "$work/r.html" "$work/x.pcd"
check "report: a scan without anything known" 0 "" "$report" --models "$work/none" \
  --output "$work/r.html" "$work/x.pcd"
grep -q "</html>" "$work/r.html" || { echo "FAILED: no whole page"; failures=$((failures + 1)); }

check "modeler: nothing to do" 2 "" "$bin/rimod-modeler"
check "modeler: nowhere to write" 2 "--out is required" "$bin/rimod-modeler" --mesh "$work/x.obj"
check "modeler: inspected without output" 2 "--output is required" "$bin/rimod-modeler" \
  --inspect "$work/models/broken.rimod"
check "modeler: broken model inspected" 1 "broken.rimod" "$bin/rimod-modeler" \
  --inspect "$work/models/broken.rimod" --output "$work/sheet.png"

check "snapshot: a scan in which nothing was found" 0 "" "$snapshot" --models "$work/none" \
  --output "$work/out/new" --scan "$work/x.pcd" --detections "$work/nothing.jsonl"
printf '%s\n' "$work/out/new/x_range_image.png" "$work/out/new/x_from_above.png" >"$work/expected"
diff "$work/expected" "$work/stdout" || failures=$((failures + 1))
while IFS= read -r picture; do
  [ "$(head -c 4 "$picture" | tail -c 3)" = PNG ] || { echo "FAILED: $picture"; failures=$((failures + 1)); }
done <"$work/stdout"

[ "$failures" -eq 0 ] && echo "all well"
exit "$((failures > 0))"
