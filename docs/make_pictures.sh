#!/usr/bin/env bash
# Makes the pictures of docs/viewing.md: plays the office log to the real processes in a private network,
# with rimod-view and rimod-spy on a screen of their own (Xvfb).
#   docs/make_pictures.sh [BUILD]     default: build/release, built with tests
set -euo pipefail
cd -- "$(dirname -- "$0")/.."
build=$(readlink -f "${1:-build/release}")
bin=$build/bin
plugin=$build/tests/viewer_tools/table_printer.jar
work=${RIMOD_PICTURES_WORK:-$(mktemp -d)}
export RIMOD_PICTURES_WORK=$work

for file in "$bin/rimod-view" "$bin/rimod-spy" "$plugin"; do
  [ -e "$file" ] || { echo "make_pictures.sh: $file is missing: build with tests" >&2; exit 1; }
done
if [ "${IN_OWN_NETWORK:-}" != yes ]; then
  mkdir "$work/models"
  for recording in logs/recordings/*/; do
    "$bin/rimod-modeler" --recording "$recording" --out "$work/models/$(basename "$recording").rimod"
  done
  IN_OWN_NETWORK=yes exec unshare -rn "$0" "$build"
fi
ip link set lo up
ip link set lo multicast on
ip route add 224.0.0.0/4 dev lo
unset LCM_DEFAULT_URL
pids=()
trap 'kill "${pids[@]}" 2>/dev/null; wait; rm -rf "$work"' EXIT

# start_screen SIZE: sets DISPLAY.
start_screen() {
  : >"$work/display"
  Xvfb -displayfd 3 -screen 0 "$1x24" 3>"$work/display" >/dev/null 2>&1 &
  pids+=($!)
  for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
  DISPLAY=:$(cat "$work/display")
  export DISPLAY
}

# What the window and the screen show, as PNG, with Java's own means.
cat >"$work/Shot.java" <<'END'
import java.awt.*;
import java.io.File;
import javax.imageio.ImageIO;

public class Shot {
  public static void main(String[] arguments) throws Exception {
    int width = Integer.parseInt(arguments[1]), height = Integer.parseInt(arguments[2]);
    Robot robot = new Robot();
    int x = Integer.parseInt(arguments[3]), y = Integer.parseInt(arguments[4]);
    robot.mouseMove(x - 5, y); // enters the window
    Thread.sleep(500);
    robot.mouseMove(x, y);
    Thread.sleep(2000);
    Rectangle part = new Rectangle(width, height);
    ImageIO.write(robot.createScreenCapture(part), "png", new File(arguments[0]));
  }
}
END

record=$work/recorded.lcm
lcm-logger --quiet "$record" & pids+=($!)
"$bin/rimod-assembler" --early & pids+=($!)
"$bin/rimod-extractor" & pids+=($!)
"$bin/rimod-matcher" --models "$work/models" & pids+=($!)
"$bin/rimod-show" live --await rimod-assembler --await rimod-extractor --await rimod-matcher --timeout 60
start_screen 1546x694
"$bin/rimod-view" --models "$work/models" 2>/dev/null & pids+=($!)
"$bin/rimod-show" live --count 1 --timeout 120 & show=$!
lcm-logplayer logs/office.lcm >/dev/null
wait $show
sleep 3  # until everything is drawn
java "$work/Shot.java" "$work/view_window.png" 1546 694 400 280
kill "${pids[@]}"
wait "${pids[@]}" || true
pids=()

# A window opens on the first pass and hears the second.
start_screen 1900x1200
SPY_OPEN=RIMOD_RANGE_IMAGE,RIMOD_DETECTIONS,RIMOD_STATUS SPY_SCREENSHOT=$work/spy.png \
  CLASSPATH=$plugin "$bin/rimod-spy" >/dev/null 2>&1 &
pids+=($!)
sleep 5
for _ in 1 2; do lcm-logplayer "$record" >/dev/null; done
sleep 4
"$bin/rimod-view" --models "$work/models" --output "$work" logs/office.lcm >/dev/null
mv "$work/office.png" docs/images/view.png
mv "$work/view_window.png" "$work/spy.png" docs/images/
echo "made docs/images/view.png, view_window.png, spy.png"
