#!/usr/bin/env bash
# Checks that all exports of shared libraries have THIMBLE_EXPORT (export_marks.py), without building the libraries. These
# are public functions and classes, and symbols that another library or the program uses. A removed mark must be reported.
# tests/shared.sh builds the shared libraries.
#   exports_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
look() { /usr/bin/python3 "$source/tests/program/export_marks.py" "$1" "$build"; }
said=$(look "$source") || fail "$said"
read -r public _ <<<"$said"
[ "$public" -gt 120 ] || fail "only $public public classes and functions were looked at"

(cd "$source" && find driver device_sim render app/scene app/bag app/session -name '*.h' -exec cp --parents -t "$work" {} +)
look "$work" >"$work/said" || fail "a copy is not read as the headers are: $(cat "$work/said")"
# remove_mark HEADER DECLARATION: removes the mark before the declaration.
remove_mark() {
  grep -q "THIMBLE_EXPORT $2" "$work/$1" || fail "$1 has no THIMBLE_EXPORT $2"
  sed -i "s/THIMBLE_EXPORT $2/$2/" "$work/$1"
}
remove_mark driver/include/thimble/driver/discovery.h 'Result<std::vector<FoundArm>> find_arms'
remove_mark driver/include/thimble/driver/safety_gate.h SafetyGate
remove_mark app/session/include/thimble/session/tick_observer.h TickObserver
remove_mark app/scene/src/arm/calibration.h 'std::filesystem::path calibration_file'
remove_mark app/bag/read_bag.h 'bool is_bag'
look "$work" >"$work/said" && fail "marks were removed, and none was missed"
for place in driver/include/thimble/driver/discovery.h driver/include/thimble/driver/safety_gate.h \
  app/session/include/thimble/session/tick_observer.h app/scene/src/arm/calibration.h app/bag/read_bag.h; do
  grep -q "^$place:[0-9]*: no THIMBLE_EXPORT: " "$work/said" || fail "the mark of $place was not missed: $(cat "$work/said")"
done
[ "$(grep -c 'no THIMBLE_EXPORT' "$work/said")" = 5 ] || fail "more was found than there is: $(cat "$work/said")"
echo "$said"
