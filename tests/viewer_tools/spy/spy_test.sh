#!/usr/bin/env bash
# Starts rimod-spy on a screen of its own (Xvfb) and a live network of its own (unshare), publishes on
# every channel, and checks that lcm-spy names the type of each and decodes all, and that a double click on
# three of them opens a window that draws. Exit code 77: cannot run here.
#   spy_test.sh RIMOD_SPY PUBLISHER PLUGIN_JAR
set -u
spy=$1 publisher=$2 plugin=$3

if [ "${IN_OWN_NETWORK:-}" != yes ]; then
  for tool in Xvfb unshare ip java; do
    command -v "$tool" >/dev/null || { echo "skipped: no $tool; ./setup.sh installs it"; exit 77; }
  done
  unshare -rn true 2>/dev/null || { echo "skipped: private networks are forbidden here"; exit 77; }
  IN_OWN_NETWORK=yes exec timeout --kill-after=5 100 unshare -rn "$0" "$@"
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

Xvfb -displayfd 3 -screen 0 1024x768x24 3>"$work/display" >"$work/xvfb.log" 2>&1 &
pids+=($!)
for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || { echo "Xvfb did not start:"; cat "$work/xvfb.log"; exit 1; }

SPY_OPEN=RIMOD_RANGE_IMAGE,RIMOD_DETECTIONS,RIMOD_STATUS DISPLAY=:$(cat "$work/display") CLASSPATH=$plugin "$spy" >"$work/spy.log" 2>&1 &
pids+=($!)
"$publisher" >/dev/null 2>&1 &
pids+=($!)

expected='ROW LASER planar_lidar_t 0
ROW LASER_TO_LOCAL rigid_transform_t 0
ROW RIMOD_SCAN scan_t 0
ROW RIMOD_RANGE_IMAGE range_image_t 0
ROW RIMOD_FEATURES feature_set_t 0
ROW RIMOD_MODEL object_model_t 0
ROW RIMOD_HYPOTHESES pose_hypotheses_t 0
ROW RIMOD_DETECTIONS detections_t 0
ROW RIMOD_STATUS status_t 0
WINDOW RIMOD_RANGE_IMAGE: range image drawn
WINDOW RIMOD_DETECTIONS: detections drawn
WINDOW RIMOD_STATUS: status drawn'

missing() {
  while IFS= read -r row; do grep -qxF -- "$row" "$work/spy.log" || echo "$row"; done <<<"$expected"
}
for _ in $(seq 120); do
  [ -z "$(missing)" ] && break
  kill -0 "${pids[1]}" 2>/dev/null || { echo "rimod-spy ended:"; cat "$work/spy.log"; exit 1; }
  sleep 0.5
done
if [ -n "$(missing)" ]; then
  echo "lcm-spy does not show:"; missing
  echo "its output:"; sort -u "$work/spy.log"
  exit 1
fi
if grep -q "Exception" "$work/spy.log"; then
  echo "exceptions:"; grep -A 5 "Exception" "$work/spy.log"
  exit 1
fi
echo "lcm-spy decodes all channels, and draws three"
