#!/usr/bin/env bash
# Checks a real arm by `thimble hil`. See README.md.
#   tests/hardware/arm_test.sh THIMBLE SOURCE_DIR      with THIMBLE_ARM=app/arms/FILE.yaml
# Never let SIGKILL end the program: it may hold a force, which then remains until the arm's watchdog acts. Three
# limits follow each other: --timeout of the program, SIGTERM a minute later, and the TIMEOUT of CTest, which kills,
# far above both (CMakeLists.txt).
set -euo pipefail
if [ -z "${THIMBLE_ARM:-}" ]; then
  echo "HARDWARE TEST SKIPPED: plug in an arm and set its file, for example THIMBLE_ARM=app/arms/woodenhaptics.yaml"
  exit 77
fi
thimble=$1
cd "$2"
suite=${THIMBLE_SUITE:-quick}
# Seconds. The quick suite takes 150 s, the full one 70 minutes.
case $suite in
  quick) limit=600 ;;
  *) limit=9000 ;;
esac
limit=${THIMBLE_LIMIT:-$limit}
grace=${THIMBLE_GRACE:-60}
firmware=()
[ -z "${THIMBLE_FIRMWARE:-}" ] || firmware=(--firmware "$THIMBLE_FIRMWARE")
"$thimble" devices
"$thimble" doctor
# Pushes only if the arm has passed its feel check; otherwise it reads the arm with zero force and fails. No --kill-after:
# a program that ignores SIGTERM is left to the person at the arm.
timeout --foreground --signal=TERM "$((limit + grace))" \
  "$thimble" hil --require-device --device "${THIMBLE_DEVICE:-auto}" --arm "$THIMBLE_ARM" "${firmware[@]}" \
  --suite "$suite" --timeout "$limit"
