#!/usr/bin/env bash
# Tries a real arm with zero force: found, opened, and read for ten seconds. See README.md.
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
for attempt in 1 2 3; do # a wire that is not closed properly shows when it is opened again
  said=$("$thimble" feel-check --device "${THIMBLE_DEVICE:-auto}" --arm "$THIMBLE_ARM" "${firmware[@]}" --listen 10)
  echo "$said"
  if grep -q '^SIMULATED' <<<"$said"; then
    echo "FAILED: no arm was found, so the simulated one was read"
    exit 1
  fi
done
