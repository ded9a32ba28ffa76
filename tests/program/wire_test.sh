#!/usr/bin/env bash
# The described wires of arm files: `thimble wire check` draws, fuzzes and decodes, `thimble wire serve` puts a board
# behind a pseudo-terminal.
source "$(dirname "$0")/expect.sh" "$@"

wires=$source_dir/app/arms/wires
check() { "$thimble" wire check "$@"; }
for wire in woody_8_byte hfab_14_byte hfab_lines falcon_packet haply_hapi hapkit_lines reference_serial reference_hid; do
  expect 0 '^  [|{[F]' check "$wires/$wire.yaml"
done
expect 0 '^  encoder_2 +-1000$' check "$wires/woody_8_byte.yaml" --capture "e8 03 18 fc 00 00 07 00"
expect_words 5 '--capture 4' check "$wires/woody_8_byte.yaml" --capture "e8 03 18 fc"
expect_words 5 '--capture 16 13' check "$wires/falcon_packet.yaml" --capture "'<AAAAAAAAAAAAAA>'"
expect_words 2 '--capture zz' check "$wires/woody_8_byte.yaml" --capture zz
expect_words 0 '0.5 N' check "$wires/haply_hapi.yaml"
sed 's/sequence, type: u16, at: 6}/sequence, type: u16, at: 7}/' "$wires/woody_8_byte.yaml" >beyond.yaml
expect_words 2 'beyond.yaml:16 sequence 7 8' check ./beyond.yaml
expect_words 2 'wire' check polhem

# Frames with a length, SLIP and a counter that wraps around.
expect_words 0 'command SLIP' check "$source_dir/tests/fuzz/files/wire/length_and_slip"
expect 0 '^  encoder_1 +-1$' check "$source_dir/tests/fuzz/files/wire/length_and_slip" --capture "02 07 04 00 ff ff 00 00 00 d0 ca 03"
sed 's/wrap: 12/wrap: 20/' "$source_dir/tests/fuzz/files/wire/length_and_slip" >wide.yaml
expect_words 2 'wide.yaml:19 encoder_1 wrap 4 5 16 20' check ./wide.yaml
# A board that answers is not asked at a port whose USB properties are unknown.
expect_words 3 '--device /dev/null identity' check "$wires/haply_hapi.yaml" --device /dev/null
expect_words 3 'no_such_board' check "$wires/reference_serial.yaml" --device no_such_board

# The board of an arm behind a pseudo-terminal, until it is stopped.
grep -vE '^(protocol|board|board_model):' "$source_dir/app/arms/vintage_phantom.yaml" >served.yaml
{ echo 'protocol: described'; sed 's/watchdog: 0.05/watchdog: 0.1/' "$wires/reference_serial.yaml"; } >>served.yaml
"$thimble" wire serve ./served.yaml >out.txt 2>&1 &
served=$!
for _ in $(seq 100); do
  grep -q '/dev/pts/' out.txt && break
  sleep 0.1
done
node=$(grep -o '/dev/pts/[0-9]*' out.txt)
# It streams reports in COBS, each of which ends with a zero byte.
expect 0 '^[1-9]' bash -c "timeout 5 head -c 400 $node | tr -dc '\\0' | wc -c"
# Its timing at the port, without a byte sent: it counts the commands that it gets.
expect 0 '99 %' check ./served.yaml --device "$node"
"$thimble" wire check ./served.yaml --device "$node" --json >port.json 2>/dev/null
expect_json port.json .port.exchange == stream
expect_json port.json .port.rate_Hz '>=' 100
expect_json port.json .port.damaged == 0
expect_json port.json .port.lost '>=' 0  # the simulated board skips reports on a busy computer
kill -INT "$served"
wait "$served"
expect 0 ': 0, .*: 0\.$' tail -n 1 out.txt
expect_words 2 'polhem described' "$thimble" wire serve polhem
finish
