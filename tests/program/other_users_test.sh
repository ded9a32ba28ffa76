#!/usr/bin/env bash
# Other users of the computer, and clients that misbehave, can neither stop commands nor fill the memory.
source "$(dirname "$0")/expect.sh" "$@"
python=/usr/bin/python3
export XDG_STATE_HOME=$work/state
port_of() { sed -n 's/.* on port \([0-9]*\) as USB device.*/\1/p' "$1"; }

# A client of `plug` that takes transfers back and never reads: its queue is bounded.
cat >flood.py <<'P'
import socket, struct, sys, time
client = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
client.sendall(struct.pack(">HHI32s", 0x0111, 0x8003, 0, b"1-1"))
client.setblocking(False)
unlink = struct.pack(">IIIIII24x", 2, 1, 0, 0, 0, 1)
end = time.monotonic() + float(sys.argv[2])
sent = 0
while time.monotonic() < end:
    try:
        sent += client.send(unlink * 200)
    except BlockingIOError:
        time.sleep(0.001)
    except OSError:
        print("disconnected")
        break
print(sent, "bytes taken")
P
# Clients that send nothing, and one that requests the list of devices.
cat >idle.py <<'P'
import socket, struct, sys
idle = [socket.create_connection(("127.0.0.1", int(sys.argv[1]))) for _ in range(40)]
client = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
client.settimeout(60)
client.sendall(struct.pack(">HHI", 0x0111, 0x8005, 0))
print("answered" if len(client.recv(4096)) >= 12 else "closed")
P
"$thimble" plug woodenhaptics --port 0 --hand none >plug.txt 2>&1 &
plug=$!
trap 'kill -9 $plug 2>/dev/null' EXIT
for _ in $(seq 300); do
  [ -n "$(port_of plug.txt)" ] && break
  sleep 0.1
done
expect_own 0 '^answered' timeout 120 "$python" idle.py "$(port_of plug.txt)"
before=$(awk '/^VmRSS/ { print $2 }' /proc/$plug/status)
expect_own 0 'bytes taken' timeout 120 "$python" flood.py "$(port_of plug.txt)" 3
after=$(awk '/^VmRSS/ { print $2 }' /proc/$plug/status)
echo "plug: $before KiB before the flood, $after KiB after"
expect_own 0 '^bounded' bash -c "[ $((after - before)) -lt 20000 ] && echo bounded"
kill -INT $plug
wait $plug

if [ "$(id -u)" != 0 ] || ! command -v setpriv >/dev/null; then
  leave_out "other users: only root may act as one (setpriv)"
  finish
fi
as_other() { setpriv --reuid 65534 --regid 65534 --clear-groups "$@"; }

# A pipe of another user with the name of a run's shared memory: no command waits for it.
name=other-users-$$
pipe=/dev/shm/thimble-0-$name
as_other mkfifo -m 666 "$pipe"
trap 'rm -f "$pipe"; kill -9 $plug 2>/dev/null' EXIT
scene=$source_dir/tests/data/scenes/two_boxes.yaml
expect 0 '' timeout 60 "$thimble" view --list
expect_run 0 .ticks == 100 timeout 120 "$thimble" run "$scene" --duration 0.1 --clock paced --name "$name"
"$thimble" run "$scene" --duration 600 --clock paced --name "$name" >run.txt 2>&1 &
run=$!
trap 'rm -f "$pipe"; kill -9 $plug $run 2>/dev/null' EXIT
for _ in $(seq 300); do
  "$thimble" view --list 2>/dev/null | grep -q "$name" && break
  sleep 0.1
done
expect 0 "$name" "$thimble" view --list
kill -TERM $run
wait $run
status=$?
expect 0 '^130$' echo $status

# A service of another user that claims to have an Inverse3.
if "$python" -c 'import websockets' 2>/dev/null; then
  mkdir -m 777 service
  as_other "$python" "$source_dir/tests/program/haply_service.py" service/port >service/forces.txt 2>service/errors.txt &
  service=$!
  trap 'rm -f "$pipe"; kill -9 $plug $run $service 2>/dev/null' EXIT
  for _ in $(seq 300); do
    [ -s service/port ] && break
    sleep 0.1
  done
  export THIMBLE_HAPLY_PORT=$(cat service/port)
  expect 1 '' bash -c '"$0" devices | grep Inverse3' "$thimble"
  expect_words 3 "'049D'" "$thimble" run "$scene" --device 049D
  kill $service
  wait $service 2>/dev/null
else
  leave_out "a service of another user: install python3-websockets"
fi
finish
