#!/usr/bin/env bash
# Ctrl-C and SIGTERM leave by zero force, with the report written and exit code 130.
source "$(dirname "$0")/expect.sh" "$@"
[ -f "$THIMBLE_MESHES/elephant.off" ] || { echo "Needs the scanned meshes"; exit 77; }

interrupted() {
  "$thimble" run "$source_dir/app/scenes/elephant.yaml" --clock wall --duration 60 --report "$2" &
  local pid=$!
  sleep 2
  kill -s "$1" $pid
  wait $pid
}
for signal in INT TERM; do
  # A machine that pauses for 100 ms makes the arm's watchdog fire first, which is right too: try again.
  for attempt in 1 2 3; do
    interrupted $signal report_$signal >output_$signal 2>&1
    status=$?
    [ $status = 4 ] && grep -q loop_stalled report_$signal/report.json || break
  done
  expect 0 'left with zero force' cat output_$signal
  expect 0 '^130$' echo $status
  expect 0 '"reason": "stopped"' cat report_$signal/report.json
  expect 0 '"motor_current_A": 0(\.0)?,?$' cat report_$signal/report.json
done
finish
