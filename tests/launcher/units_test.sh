#!/usr/bin/env bash
# The systemd units are valid and name executables that exist. Exit code 77: no systemd here.
#   units_test.sh UNITS BIN
set -u
units=$1 bin=$2
command -v systemd-analyze >/dev/null || { echo "skipped: no systemd-analyze"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$units/rimod.target" "$work"
sed "s|/usr/local/bin|$bin|" "$units/rimod@.service" >"$work/rimod@.service"
failures=0
for unit in rimod.target rimod@assembler.service rimod@extractor.service rimod@matcher.service; do
  said=$(SYSTEMD_UNIT_PATH="$work:" systemd-analyze verify "$work/$unit" 2>&1)
  [ -z "$said" ] || { echo "FAILED: $unit: $said"; failures=1; }
done
# A check that cannot fail is none.
sed -i 's/^Restart=always/Restart=sometimes/' "$work/rimod@.service"
[ -n "$(SYSTEMD_UNIT_PATH="$work:" systemd-analyze verify "$work/rimod@matcher.service" 2>&1)" ] ||
  { echo "FAILED: a broken unit was not noticed"; failures=1; }
exit $failures
