#!/usr/bin/env bash
# Compiles the reference firmware for all boards, and prints the memory of each image and the duration of its loop on emulated
# processors. Needs the optional part `firmware` and the built tests.
#   tests/firmware.sh [FOLDER]    FOLDER: the build folder, by default build/release
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release}
driver/firmware/build.sh "$build/firmware_images"
for test in test_reference_firmware:EmulatedFirmware.Touches* test_avr_firmware:AvrFirmware.Reports1000*; do
  program=$build/tests/sim/${test%%:*}
  if [ ! -x "$program" ]; then
    echo "$program is missing. Build the target ${test%%:*}." >&2
    exit 1
  fi
  "$program" --gtest_brief=1 "--gtest_filter=${test#*:}" | grep -E '^Longest|FAILED'
done
