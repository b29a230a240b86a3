#!/usr/bin/env bash
# The launcher's command line: help, version, exit codes, clear words when something is missing.
#   launcher_test.sh RIMOD_SPY
set -u
spy=$1
failures=0

# check WHAT EXPECTED_CODE PATTERN COMMAND...: exit code and output (both streams) of a command.
check() {
  local what=$1 code=$2 pattern=$3 output actual
  shift 3
  output=$("$@" 2>&1)
  actual=$?
  if [ "$actual" -ne "$code" ] || ! grep -q -- "$pattern" <<<"$output"; then
    echo "FAILED: $what: exit code $actual, not $code, or no '$pattern' in: $output"
    failures=$((failures + 1))
  fi
}

check "help" 0 "lcm-url" "$spy" --help
check "short help" 0 "double click" "$spy" -h
check "version" 0 "^rimod-spy [0-9]" "$spy" --version
check "unknown option" 2 "unknown argument '--nonsense'" "$spy" --nonsense
check "missing value" 2 "needs a value" "$spy" -l
check "no screen" 1 "DISPLAY is not set" env -u DISPLAY "$spy" -l udpm://239.255.76.67:7667
copy=$(mktemp -d)
cp "$spy" "$copy/rimod-spy"
check "jar not beside it" 1 "lcmtypes_rimod.jar is missing" env DISPLAY=:99 "$copy/rimod-spy"
rm -rf "$copy"
ln -s "$(readlink -f "$spy")" "$copy-link"
check "started through a link" 1 "DISPLAY is not set" env -u DISPLAY "$copy-link"
rm -f "$copy-link"
[ "$failures" -eq 0 ] && echo "all well"
exit "$((failures > 0))"
