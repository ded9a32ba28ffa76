#!/usr/bin/env bash
# Checks a real arm by `thimble hil`. See README.md.
#   tests/hardware/arm_test.sh THIMBLE SOURCE_DIR      with THIMBLE_ARM=app/arms/FILE.yaml
set -euo pipefail
if [ -z "${THIMBLE_ARM:-}" ]; then
  echo "HARDWARE TEST SKIPPED: plug an arm in and name its file, e.g. THIMBLE_ARM=app/arms/woodenhaptics.yaml"
  exit 77
fi
thimble=$1
cd "$2"
firmware=()
[ -z "${THIMBLE_FIRMWARE:-}" ] || firmware=(--firmware "$THIMBLE_FIRMWARE")
"$thimble" devices
"$thimble" doctor
# Pushes only if the arm has passed its feel check; else it reads it with zero force and fails.
said=$("$thimble" hil --device "${THIMBLE_DEVICE:-auto}" --arm "$THIMBLE_ARM" "${firmware[@]}" \
  --suite "${THIMBLE_SUITE:-quick}") && code=0 || code=$?
echo "$said"
if grep -q '^SIMULATED' <<<"$said"; then
  echo "FAILED: no arm was found, so the simulated one was checked"
  exit 1
fi
exit "$code"
