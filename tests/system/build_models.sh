#!/usr/bin/env bash
# Builds the models for the system tests from the recordings in the repository.
#   build_models.sh BIN RECORDINGS OUT
set -euo pipefail
bin=$1 recordings=$2 out=$3
rm -rf "$out"
mkdir -p "$out"
for recording in "$recordings"/*/; do
  "$bin/rimod-modeler" --recording "$recording" --out "$out/$(basename "$recording").rimod"
done
