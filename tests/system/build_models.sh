#!/usr/bin/env bash
# Builds the models for the system tests from the recordings in the repository.
#   build_models.sh BIN RECORDINGS OUT CLASS...
set -euo pipefail
bin=$1 recordings=$2 out=$3
shift 3
rm -rf "$out"
mkdir -p "$out"
for class in "$@"; do
  "$bin/rimod-modeler" --recording "$recordings/$class" --out "$out/$class.rimod"
done
