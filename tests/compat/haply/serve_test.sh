#!/usr/bin/env bash
# Programs of the Inverse3 on a simulated arm: `thimble exec --serve haply`, with a Python program (python3-websockets) and
# with Thimble's own driver, so that both ends can be compared.
#   serve_test.sh THIMBLE SOURCE_DIR WORK_DIR
source "$(dirname "$0")/../../program/expect.sh" "$1" "$2" "$3"
export TMPDIR=$work XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state
ends=$source_dir/tests/compat/round_trip/both_ends.awk
program=$source_dir/tests/compat/haply/program.py
serve() { "$thimble" exec --serve haply --port 0 "$@"; }

# Thimble's driver as a client of Thimble's service: the arm of the inner run is the simulated arm of the outer run. The hand
# presses into a box of the inner run's scene.
printf '0 0.002 -0.03 0.02\n0.05 0.002 -0.03 0.02\n0.5 0.002 -0.03 0.0135\n1 0.004 -0.027 0.011\n3 0 -0.03 0.012\n900 0 -0.03 0.012\n' >press.txt
# On a busy machine the inner run may miss the arm for 20 ms, and reports it. Both must agree until then, and it is repeated
# until the touch was long enough.
for _ in 1 2 3 4 5 6; do
  rm -f outer.h5 inner.h5
  serve --clock virtual --hand press.txt --record outer.h5 "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" \
    --device 0001 --yes --no-real-time --no-view --duration 4 --record inner.h5 >run.txt 2>&1
  status=$?
  [ $status = 0 ] || expect 0 'no_reports|loop_stalled|was blocked|stalled for longer|reported nothing' cat run.txt
  for end in outer inner; do expect 0 '' "$thimble" export $end.h5 --csv $end.csv; done
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) { if ($i ~ /^p_WT.x/) p = i; if ($i ~ /^v_WT.x/) v = i; if ($i ~ /^f_sent_W.x/) f = i; if ($i == "fresh") n = i }; next }
    $n { print $p, $(p + 1), $(p + 2), $v, $(v + 1), $(v + 2), $f, $(f + 1), $(f + 2); next }
    { print "- - - - - -", $f, $(f + 1), $(f + 2) }' inner.csv >inner.txt
  awk -f "$ends" -v force_step=1e-6 -v opening=600 inner.txt outer.csv >same.txt
  cat same.txt
  expect_own 0 ' ticks here, 0 not there, 0 out of order; .* 0 from elsewhere$' cat same.txt
  grep -qE ' [0-9]{3,} ticks there with a force' same.txt && break
done
expect_own 0 '^[0-9]{3,} ticks here, .* [0-9]{3,} ticks there with a force from here, [0-9]{2,} different' cat same.txt

expect 2 'haply' "$thimble" exec --serve tetris true
expect 2 '70000' "$thimble" exec --serve haply --port 70000 true
expect_words 7 'ws://localhost:#' serve sh -c 'exit 7'
expect_words 2 './nowhere' serve ./nowhere
expect_words 2 'arm nonesuch' serve --arm nonesuch true

python=/usr/bin/python3 # Debian's
[ -x $python ] || python=python3
if ! $python -c 'import websockets' 2>/dev/null; then
  echo "NOT TESTED: a program of the Inverse3 in Python; install python3-websockets."
  finish
fi
run() { serve --clock virtual $python "$program" "$@"; }
expect_own 0 'first_message: right' run first_message
expect_own 0 'stylus: right' serve --clock virtual --arm polhem $python "$program" stylus
expect_own 0 'two: right' run two virtual
expect_own 0 'garbage: right' run garbage
expect 0 '^Wrong +message [0-9]+ .*JSON' run garbage
expect 0 '^Wrong +set_cursor_position 1 ' run garbage
expect 0 '^Wrong +device_id 1 ' run garbage
expect_own 0 'huge: right' run huge
expect 0 'off: .*not finite' run huge
expect_own 0 'doors: right' run doors
# Bit-identical each time, and equal at both ends.
printf '0 0 0 0\n1 0.01 0.012 0.01\n2 -0.01 0 0\n' >hand.txt
for turn in first second; do
  expect_own 0 'force: right' serve --clock virtual --hand hand.txt --record $turn.h5 $python "$program" force $turn.txt
  expect 0 '' "$thimble" export $turn.h5 --csv $turn.csv
done
expect_own 0 '^same$' sh -c 'cmp first.txt second.txt && cmp first.csv second.csv && echo same'
expect_own 0 '^2500 ticks here, 0 not there, 0 out of order; [0-9]{4} ticks there with a force from here, [0-9]{4} different, 0 from elsewhere$' \
  awk -f "$ends" -v force_step=1e-9 -v opening=600 first.txt first.csv
# In real time: the force ends with the messages.
expect_own 0 'lets_go: right' serve $python "$program" lets_go
expect_own 0 'cut: right' serve $python "$program" cut
expect_words 0 'python3 Haply 20 ms' serve $python "$program" lets_go

# Without a program: serves clients until Ctrl-C.
env --default-signal=INT "$thimble" exec --serve haply --port 0 >served.txt 2>&1 &
service=$!
trap 'kill $service 2>/dev/null' EXIT
for _ in $(seq 200); do
  grep -q 'ws://localhost:' served.txt && break
  sleep 0.05
done
export THIMBLE_HAPLY_PORT
THIMBLE_HAPLY_PORT=$(grep -oE 'ws://localhost:[0-9]+' served.txt | grep -oE '[0-9]+$')
expect_own 0 'two: right' $python "$program" two
expect 0 '^0001 ' "$thimble" devices
expect_words 2 "$THIMBLE_HAPLY_PORT --port" \
  "$thimble" exec --serve haply --port "$THIMBLE_HAPLY_PORT" true
$python "$program" hold >hold.txt 2>&1 &
hold=$!
for _ in $(seq 200); do
  grep -q holding hold.txt && break
  sleep 0.05
done
kill -INT $service
wait $service
status=$?
expect 0 '^0$' echo $status
expect 0 'accepted zero force' cat served.txt
wait $hold
expect_own 0 'hold: WRONG' cat hold.txt
finish
