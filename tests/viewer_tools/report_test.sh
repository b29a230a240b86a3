#!/usr/bin/env bash
# rimod-report on the recorded office: with the detector's own run, with given detections, and with
# all objects missed.
#   report_test.sh BIN MODELS LOGS
set -u
bin=$1 models=$2 logs=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# report NAME OPTION...: makes NAME.html and NAME/ with the cases.
report() {
  local name=$1
  shift
  "$bin/rimod-report" --models "$models" --recordings "$logs/recordings" \
    --labels "$logs/expected/office.labels.json" --cases "$work/$name" \
    --output "$work/$name.html" "$@" "$logs/office.lcm" >"$work/$name.out" 2>"$work/$name.err" ||
    { fail "$name: exit code $?"; cat "$work/$name.err"; }
  grep -qE '(src|href)="[^d#]|<script|<link|https?:' "$work/$name.html" && fail "$name: needs other files"
  tail -n 1 "$work/$name.html" | grep -q '</html>' || fail "$name: the page is cut"
}

report detector
report given --detections "$logs/expected/office.detections.jsonl"
[ "$(tail -n 1 "$work/detector.out")" = "$(tail -n 1 "$work/given.out")" ] ||
  fail "the detector's run counts otherwise than its expected detections"
grep -q '^4 objects: ' "$work/given.out" || fail "four objects are labelled"
grep -q '<svg class="plot"' "$work/detector.html" || fail "no plot of stage times"

# Nothing detected: every object is missed, and each has its case with a picture.
: >"$work/none.jsonl"
report missed --detections "$work/none.jsonl"
grep -q ' 0 right .* 4 missed, 0 false' "$work/missed.out" || fail "$(cat "$work/missed.out")"
[ "$(wc -l <"$work/missed/cases.jsonl")" -eq 4 ] || fail "not four cases"
[ "$(find "$work/missed" -name '*-missed-*.png' | wc -l)" -eq 4 ] || fail "not four pictures"
[ "$(grep -c '<article>' "$work/missed.html")" -eq 4 ] || fail "not four articles"

# A detection of something where nothing is.
echo '{"scan":"office","class":"box","pose":[1.5,0.2,1.2,1,0,0,0],"score":0.9}' >"$work/box.jsonl"
report invented --detections "$work/box.jsonl"
grep -q '1 false alarms' "$work/invented.out" || fail "$(cat "$work/invented.out")"
ls "$work"/invented/*false_alarm-box-office.png >/dev/null 2>&1 || fail "no picture of the false alarm"

# Poses at the end of the world and many of them are drawn or not, but end well.
for pose in 1e300,-1e300,1e300 1e9,0,0 0,0,0; do
  echo '{"scan":"office","class":"box","pose":['$pose',1,0,0,0],"score":0.9}'
done >"$work/far.jsonl"
for _ in $(seq 50); do head -n 1 "$work/box.jsonl"; done >>"$work/far.jsonl"
report far --detections "$work/far.jsonl" --max-cases 5
grep -q '53 false alarms' "$work/far.out" || fail "$(cat "$work/far.out")"
[ "$(find "$work/far" -name '*.png' | wc -l)" -eq 5 ] || fail "not five pictures"
[ "$(wc -l <"$work/far/cases.jsonl")" -eq 57 ] || fail "not a line a case"

# The same input gives the same page.
report again --detections "$work/box.jsonl" --threads 1
diff "$work/again/cases.jsonl" "$work/invented/cases.jsonl" ||
  fail "cases differ with another number of threads"

[ "$failures" -eq 0 ] && echo "all well"
exit "$((failures > 0))"
