#!/usr/bin/env bash
# Installs what is missing, builds and runs all tests. Ends with ctest's own summary.
set -euo pipefail
cd -- "$(dirname -- "$0")"

usage() {
  cat <<'END'
usage: ./test.sh [--sanitize] [CTEST OPTIONS]
  --sanitize  build with address and undefined-behaviour sanitizers (preset asan-ubsan, not dev)
Further options go to ctest: ./test.sh -R RangeImage
END
}

preset=dev
ctest_options=()
for argument in "$@"; do
  case "$argument" in
    --sanitize) preset=asan-ubsan ;;
    --help) usage; exit 0 ;;
    *) ctest_options+=("$argument") ;;
  esac
done

./setup.sh
if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset "$preset"
cmake --build --preset "$preset" --parallel "$(nproc)"
ctest --preset "$preset" --parallel 2 --output-on-failure ${ctest_options+"${ctest_options[@]}"}
