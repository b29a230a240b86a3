#!/usr/bin/env bash
# What rimod-detect finds in the office log is what logs/expected says.
#   expected_detections_test.sh BIN COMPARE MODELS LOG EXPECTED
set -euo pipefail
bin=$1 compare=$2 models=$3 log=$4 expected=$5
found=$(mktemp)
trap 'rm -f "$found"' EXIT
"$bin/rimod-detect" --models "$models" "$log" >"$found"
"$compare" "$expected" "$found" || { echo "found:"; cat "$found"; exit 1; }
