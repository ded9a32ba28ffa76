#!/usr/bin/env bash
# A simulated arm on a USB plug: it prints what to do, takes faults while it runs, and ends on Ctrl-C.
source "$(dirname "$0")/expect.sh" "$@"

for arm in woodenhaptics polhem polhem-64 falcon; do
  expect 0 "$arm" "$thimble" plug --help
done
expect_words 0 'mbed HID 1234:0006 14-byte' "$thimble" plug --help
expect_words 0 'mbed 0123456789' "$thimble" plug --help
expect_words 0 'bit_errors unplug lost' "$thimble" plug --help
expect_words 2 'woodenhaptics polhem polhem-64 falcon' "$thimble" plug excalibur --port 0
expect 2 'hand' "$thimble" plug polhem --hand fist
expect_error 2 '--port 0 65535 "70000"' "$thimble" plug polhem --port 70000
for address in nowhere 999.1.1.1 127.0.0; do
  expect_error 2 "--listen IPv4 \"$address\"" "$thimble" plug polhem --port 0 --listen $address
done
expect_words 2 'missing.txt' "$thimble" plug polhem --port 0 --faults missing.txt
echo 'mass 0.02' >mass.txt
expect_words 2 '--arm' "$thimble" plug polhem --port 0 --faults mass.txt
echo 'stall sideways' >bad_faults.txt
expect_words 2 "'sideways'" "$thimble" plug polhem --port 0 --faults bad_faults.txt
if [ ! -e /sys/devices/platform/vhci_hcd.0 ]; then
  expect_words 1 'vhci-hcd' "$thimble" plug polhem --port 0 --attach
fi

# An arm with other constants, on the board that drives it.
expect_error 2 "'falcon'" "$thimble" plug falcon --port 0 --arm polhem
expect_words 2 "'simulation'" "$thimble" plug polhem --port 0 --arm inverse3
expect 0 '^ +--arm ' "$thimble" plug --help

# It runs until it is stopped; meanwhile the pipe takes orders.
"$thimble" plug woodenhaptics --port 0 --arm woodenhaptics --hand none --control pipe --trace trace.txt >out.txt 2>&1 &
plug=$!
for _ in $(seq 100); do
  grep -q 'Ctrl-C' out.txt && break
  sleep 0.1
done
echo 'short in for=5' >pipe
echo 'lost out for=5' >pipe
echo 'hand 0 0.01 0' >pipe
echo 'hand on' >pipe
echo 'hand 1 2' >pipe
echo 'mass 0.025' >pipe
echo 'mass much' >pipe
echo 'mass -1' >pipe
echo 'quake' >pipe
for _ in $(seq 100); do
  grep -q "'quake'" out.txt && break
  sleep 0.1
done
kill -INT $plug
wait $plug
status=$?
expect 0 '^0$' echo $status
expect_words 0 'port # USB 1-1' cat out.txt
expect_error 0 "'quake'" cat out.txt
expect 0 "^thimble: .*'hand 1 2'" cat out.txt
expect 0 "^thimble: .*'mass much'" cat out.txt
expect_error 0 '0 kg' cat out.txt
expect 1 '' grep -E "^thimble: '(hand (0|on)|mass 0)" out.txt
expect 0 '^Unplugged' cat out.txt
expect_words 0 'sampled_frame' cat trace.txt
expect 1 '' test -e pipe
finish
