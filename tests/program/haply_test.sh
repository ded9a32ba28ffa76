#!/usr/bin/env bash
# An Inverse3 by its vendor's service, as a person meets it: devices, doctor, run.
source "$(dirname "$0")/expect.sh" "$@"
python=/usr/bin/python3  # Debian's
[ -x $python ] || python=python3
if ! $python -c 'import websockets' 2>/dev/null; then
  echo "NOT TESTED: the program with a service; install python3-websockets."
  exit 77
fi
export XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state
# Nobody listens on this port of this computer: only root may.
export THIMBLE_HAPLY_PORT=1
expect 0 '^sim ' "$thimble" devices
expect 3 "No arm is called '049D'" "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --device 049D

$python "$source_dir/tests/program/haply_service.py" port >forces.txt 2>service.txt &
service=$!
trap 'kill $service 2>/dev/null' EXIT
for _ in $(seq 200); do
  [ -s port ] && break
  sleep 0.05
done
THIMBLE_HAPLY_PORT=$(cat port)
expect 0 '^049D +Haply Inverse3 +service +port [0-9]+ +ws://localhost:[0-9]+ +ready' "$thimble" devices
"$thimble" doctor >doctor.txt 2>&1
expect 0 'Haply Inverse3 049D: its service on port [0-9]+ has it .*Untried on hardware' cat doctor.txt
expect 2 "calibrated by its vendor's own software" "$thimble" calibrate --device 049D
expect 0 'Arm file: .*inverse3\.yaml .*the arm is a Haply Inverse3' \
  "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --device auto --yes --no-real-time --no-view --duration 1
expect 0 '^049D ' tail -n 1 forces.txt
# A millisecond each, less what a busy machine left out; and the last of them is zero.
expect 0 '^[1-9][0-9][0-9]+ ' wc -l forces.txt
expect 0 '^049D -?0\.?0* -?0\.?0* -?0\.?0*$' tail -n 1 forces.txt
finish
