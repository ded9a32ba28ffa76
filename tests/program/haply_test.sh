#!/usr/bin/env bash
# An Inverse3 behind its vendor's service, as a user sees it: devices, doctor, run.
source "$(dirname "$0")/expect.sh" "$@"
python=/usr/bin/python3  # Debian's
[ -x $python ] || python=python3
if ! $python -c 'import websockets' 2>/dev/null; then
  echo "NOT TESTED: the program with a service; install python3-websockets."
  exit 77
fi
export XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state
# Only root may listen on this port, so it is closed.
export THIMBLE_HAPLY_PORT=1
expect 0 '^sim ' "$thimble" devices
expect_words 3 "'049D'" "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --device 049D

$python "$source_dir/tests/program/haply_service.py" port >forces.txt 2>service.txt &
service=$!
trap 'kill $service 2>/dev/null' EXIT
for _ in $(seq 200); do
  [ -s port ] && break
  sleep 0.05
done
THIMBLE_HAPLY_PORT=$(cat port)
expect 0 '^049D .*Inverse3 .* [0-9]+ +ws://localhost:[0-9]+ +ready' "$thimble" devices
"$thimble" doctor >doctor.txt 2>&1
expect_words 0 'Inverse3 049D port #' cat doctor.txt
expect_error 2 calibrated "$thimble" calibrate --device 049D
# Without real-time priority no command pushes a real arm unless the user allows it, and doctor names that as a problem.
weak() { # COMMAND...
  if [ "$(id -u)" = 0 ]; then
    prlimit --rtprio=0 setpriv --bounding-set=-sys_nice "$@"
  else
    prlimit --rtprio=0 "$@"
  fi
}
for command in feel-check identify hil; do
  expect_words 2 'real-time --no-real-time' weak "$thimble" $command --device 049D
done
expect_words 2 'feel-check' weak "$thimble" identify --device 049D --no-real-time
expect_words 3 'PROBLEM real-time 80' weak "$thimble" doctor
# In real time. On a busy machine the service may pause longer than the gate waits for a report.
touch_it() {
  for _ in 1 2 3 4 5; do
    "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --device auto --yes --no-real-time --no-view --duration 1 && return
    sleep 1
  done
  return 4
}
expect_words 0 'inverse3.yaml Inverse3' touch_it
expect 0 '^049D ' tail -n 1 forces.txt
# One per millisecond, less those that a busy machine missed; the last is zero.
expect 0 '^[1-9][0-9][0-9]+ ' wc -l forces.txt
expect 0 '^049D -?0\.?0* -?0\.?0* -?0\.?0*$' tail -n 1 forces.txt

# Several arms to choose from: two behind the service, then one there and one on USB, if the kernel can simulate it.
rm port
kill $service
wait $service 2>/dev/null
$python "$source_dir/tests/program/haply_service.py" port 049D 0A11 >forces.txt 2>service.txt &
service=$!
for _ in $(seq 200); do
  [ -s port ] && break
  sleep 0.05
done
THIMBLE_HAPLY_PORT=$(cat port)
scene=$source_dir/tests/data/scenes/two_boxes.yaml
expect_words 3 "'auto' 049D Inverse3 0A11 --device NAME" \
  "$thimble" run "$scene" --device auto --yes --no-real-time --no-view
# exec needs the compatibility layer; a build with a sanitizer has none.
if [ -e "$(dirname "$(readlink -f "$thimble")")/compat/lib/libHD.so" ]; then
  expect_words 3 '--device NAME' "$thimble" exec --serve haply --port 0 --device auto --yes --no-real-time true
fi
cat >with_falcon.sh <<'END'
mount -t tmpfs none /sys || exit 77
falcon=/sys/bus/usb/devices/1-2
mkdir -p $falcon
for line in idVendor=0403 idProduct=cb48 serial=F7 product=FALCON busnum=1 devnum=9; do echo "${line#*=}" >$falcon/${line%%=*}; done
exec "$@"
END
if unshare -rm bash with_falcon.sh true 2>/dev/null; then
  expect_words 3 "'auto' 049D Inverse3 F7 Falcon --device NAME" \
    unshare -rm bash with_falcon.sh "$thimble" run "$scene" --device auto --yes --no-real-time --no-view
else
  echo "NOT TESTED: two kinds of arms with --device auto: no namespaces of one's own"
fi
expect 0 '^0$' stat -c %s forces.txt  # no arm was chosen, so none got a message
finish
