#!/usr/bin/env bash
# rimod-view's window on a screen of its own (Xvfb): it opens, keys switch layers, save a picture and end
# it. Exit code 77: cannot run here.
#   view_window_test.sh BIN LOG
set -u
bin=$1 log=$2
for tool in Xvfb xdotool; do
  command -v "$tool" >/dev/null || { echo "skipped: no $tool; ./setup.sh installs it"; exit 77; }
done
work=$(mktemp -d)
pids=()
cleanup() {
  kill "${pids[@]}" 2>/dev/null
  wait 2>/dev/null
  rm -rf "$work"
}
trap cleanup EXIT
fail() {
  echo "FAILED: $*"
  cat "$work/view.log"
  exit 1
}

Xvfb -displayfd 3 -screen 0 1700x900x24 3>"$work/display" >"$work/xvfb.log" 2>&1 &
pids+=($!)
for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || { echo "Xvfb did not start:"; cat "$work/xvfb.log"; exit 1; }
# With a sanitizer: libdbus, which Qt loads, keeps what it has allocated.
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0"
DISPLAY=:$(cat "$work/display")
export DISPLAY

"$bin/rimod-view" --save "$work/saved" "$log" >"$work/view.log" 2>&1 &
view=$!
pids+=($view)

# press KEY UNTIL...: presses the key, at first every two seconds anew, until the command holds.
press() {
  local key=$1
  shift
  for _ in $(seq 30); do
    xdotool search --name '^rimod-view$' windowfocus key --clearmodifiers "$key" 2>/dev/null
    for _ in 1 2 3 4; do
      "$@" && return
      sleep 0.5
    done
  done
  fail "nothing happens on $key"
}
saved() { [ -s "$work/saved/office.png" ]; }
ended() { ! kill -0 $view 2>/dev/null; }

press s saved
"$bin/rimod-view" --output "$work/written" "$log" >/dev/null 2>&1 || fail "--output"
cmp -s "$work/saved/office.png" "$work/written/office.png" || fail "saved and written pictures differ"
rm "$work/saved/office.png"
xdotool search --name '^rimod-view$' windowfocus key --clearmodifiers t
press s saved
cmp -s "$work/saved/office.png" "$work/written/office.png" && fail "t does not take the view from above away"
press q ended
wait $view || fail "exit code $?"
echo "the window opens, saves and ends"
