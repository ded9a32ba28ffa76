#!/usr/bin/env bash
# Real processes under faults: signals, a stopped servo or viewer, a full disk, removed shared
# memory, a jump of the date, no real-time priority, no spare processor. In each
# phase the arm gets zero force at the end, the cause is named, and no recorded tick is lost. The same in
# simulated time: tests/sim/fault_matrix_test.cpp. Appends to the file that THIMBLE_FAULTS names.
source "$(dirname "$0")/expect.sh" "$@"
scenes=$source_dir/app/scenes
export XDG_STATE_HOME=$PWD/state
unset DISPLAY WAYLAND_DISPLAY
me=faults$$

# cell FAULT PHASE PROMISE: the checks since the last cell are the result of this one.
before=0
cell() {
  local result=met
  [ "$failures" = "$before" ] || result="NOT MET"
  before=$failures
  [ -z "${THIMBLE_FAULTS:-}" ] || echo "FAULT|$1|process|$2|$3|$result|" >>"$THIMBLE_FAULTS"
}
not_tested() {  # not_tested FAULT PHASE WHY
  echo "NOT TESTED: $1: $3"
  [ -z "${THIMBLE_FAULTS:-}" ] || echo "FAULT|$1|process|$2|-|not tested here: $3|" >>"$THIMBLE_FAULTS"
}

# No pictures are drawn, because they take longer than the runs; one is checked for.
mkdir -p tools
printf '#!/bin/sh\ntouch mesh.png\n' >tools/gnuplot
chmod +x tools/gnuplot
PATH=$PWD/tools:$PATH

# Each phase is a scene and the time (s) at which its hand is in this phase.
phases=("opening rubber 0.02" "free rubber 0.5" "sliding rubber 1.6" "deforming trampoline 1.8")
[ -n "${THIMBLE_LONG:-}" ] || phases=("opening rubber 0.02" "sliding rubber 1.6" "deforming trampoline 1.8")

# trouble SCENE SECONDS COMMAND...: runs a scene on the wall clock, recorded, and after SECONDS of touch
# COMMAND with the process number; leaves exit code, output, report and recording.
trouble() {
  local scene=$1 seconds=$2 pid
  shift 2
  rm -rf out report run.h5
  "$thimble" run "$scenes/$scene.yaml" --clock wall --duration 30 --no-view --report report \
    --record run.h5 >out 2>&1 </dev/null &
  pid=$!
  # The touch begins when the recording exists; a slow machine needs time to open it.
  for _ in $(seq 200); do [ -e run.h5 ] && break; sleep 0.02; done
  sleep "$seconds"
  "$@" $pid
  wait $pid
  status=$?
}
# If the machine pauses for 100 ms, the watchdog's fault comes first, which is correct as well.
left_well() {  # left_well CODE REASON
  if [ "$1" != 4 ] && [ "$status" = 4 ] && grep -q loop_stalled report/report.json 2>/dev/null; then
    echo "(this machine paused for 100 ms: $1 came as loop_stalled)"
  else
    expect 0 "^$1\$" echo "$status"
    expect 0 "\"(reason|fault)\": \"$2\"" cat report/report.json
  fi
  expect 0 '"motor_current_A": -?0(\.0)?,?$' cat report/report.json
  ticks=$(grep -oE '^  "ticks": [0-9]+' report/report.json | grep -oE '[0-9]+')
  expect_ticks run.h5 -eq "$ticks"
}

send() { kill -s "$1" "$2"; }
for signal in INT TERM HUP; do
  for phase in "${phases[@]}"; do
    read -r name scene seconds <<<"$phase"
    [ "$signal" = HUP ] && [ "$name" != sliding ] && [ -z "${THIMBLE_LONG:-}" ] && continue
    # A background job of a script ignores SIGINT until the program installs its handler.
    [ "$signal $name" = "INT opening" ] && continue
    trouble "$scene" "$seconds" send $signal
    if [ "$name" = opening ] && [ ! -e report/report.json ]; then  # before any force
      expect 0 '^(129|130|143)$' echo "$status"
    else
      left_well 130 stopped
    fi
    cell "SIG$signal" "$name, recording" "zero force, exit code 130, every tick recorded"
  done
done

stand_still() {
  kill -STOP "$1"
  sleep 0.3
  kill -CONT "$1"
}
for phase in "${phases[@]}"; do
  read -r name scene seconds <<<"$phase"
  [ "$name" = opening ] && continue  # a slow opening is no fault
  trouble "$scene" "$seconds" stand_still
  left_well 4 loop_stalled
  expect 0 '[^ ]*loop_stalled[^ ]*\.h5' cat out
  cell "SIGSTOP, SIGCONT of the servo" "$name, recording" \
    "zero force, loop_stalled, every tick recorded, black box"
done

# Processes outside of the servo may stop, end, or lose their memory.
if [ -d /dev/shm ]; then
  segment=/dev/shm/thimble-$(id -u)-$me
  "$thimble" run "$scenes/rubber.yaml" --clock wall --duration 3 --name "$me" --record watched.h5 --report watched_report \
    >watched 2>&1 &
  run=$!
  for _ in $(seq 100); do [ -e "$segment" ] && break; sleep 0.05; done
  "$thimble" view "$me" --text --follow >view.log 2>&1 &
  viewer=$!
  sleep 1
  kill -STOP $viewer
  sleep 1
  kill -CONT $viewer
  expect 0 '' rm "$segment"
  wait $run
  status=$?
  expect 0 '^[04]$' echo "$status"
  [ "$status" = 4 ] && expect_json watched_report/report.json .end.fault == loop_stalled
  expect 0 '"motor_current_A": -?0(\.0)?,?$' cat watched_report/report.json
  expect_words 0 'watched.csv # rubber 1000' "$thimble" export watched.h5 --csv watched.csv
  kill $viewer 2>/dev/null
  wait $viewer
  expect 1 '' test $? -ge 132  # 130, by the signal; more is a crash
  cell "SIGSTOP, SIGCONT of the viewer" "sliding, recording" "the run continues to its end"
  expect 1 '' bash -c '"$0" view --list | grep "^$1:"' "$thimble" "$me"
  expect_run 0 .end.reason == done "$thimble" run "$scenes/honey.yaml" --duration 0.1 --name "$me"
  cell "shared memory removed" "sliding, recording" "the run continues; the name is free again"
else
  not_tested "shared memory removed" sliding "no POSIX shared memory"
fi

# The disk. A file size limit has the same effect and needs no privileges.
expect_words 2 'small.h5' bash -c \
  'ulimit -f 100; exec "$0" run "$1" --duration 60 --no-view --record small.h5' "$thimble" "$scenes/rubber.yaml"
cell "file size limit" "opening" "refused with a sentence, no crash"
expect 0 '' "$thimble" run "$scenes/rubber.yaml" --duration 1 --no-view --record good.h5
expect_words 1 '/dev/full' "$thimble" export good.h5 --csv /dev/full
cell "disk full" "table of a recording" "refused with a sentence"
cat >on_full_disk.sh <<'END'
mkdir -p disk
mount -t tmpfs -o size=192k tmpfs disk || exit 77
"$1" run "$2" --clock wall --duration 3 --no-view --record disk/run.h5 --report full_report >full 2>&1
echo "code $?"
"$1" export disk/run.h5 --csv full.csv
head -c 1m /dev/zero >disk/all 2>/dev/null
"$1" run "$2" --duration 6 --no-view --record disk/second.h5
echo "code $?"
END
if unshare -rm true 2>/dev/null; then
  unshare -rm bash on_full_disk.sh "$thimble" "$scenes/rubber.yaml" >full_disk 2>&1
  if [ $? = 77 ]; then
    not_tested "disk full" recording "no file system in memory may be mounted"
  else
    expect_own 0 '^code [14]$' grep code full_disk
    expect_words 0 'recording # space' cat full
    expect_json full_report/report.json .end.zero_assured == true
    expect 0 'full.csv: [1-9][0-9]+ .*rubber.* cut' cat full_disk
    cell "disk full" "recording" "the run continues; the written part is readable; error message, exit code 1"
    expect 0 '^thimble: .*second\.h5' cat full_disk
    expect_own 0 '^code 2$' tail -1 full_disk
    cell "disk full" "opening" "refused with a sentence, no crash"
  fi
else
  not_tested "disk full" recording "no namespaces of one's own"
fi
expect 0 '^0$' bash -c '"$0" run "$1" --duration 0.5 --no-view | true; echo ${PIPESTATUS[0]}' \
  "$thimble" "$scenes/rubber.yaml"
cell "reader of the output gone" "sliding" "the run continues to its end"

# The servo does not use the date.
jump=$(dirname "$work")/libclock_jump.so
ends_well() {  # ends_well COMMAND...: a touch on the wall clock, under any load of the machine
  "$@" run "$scenes/rubber.yaml" --clock wall --duration 1.5 --no-view --report report >out 2>&1
  status=$?
  expect 0 '^[04]$' echo "$status"
  [ "$status" = 0 ] || expect 0 loop_stalled cat report/report.json
  expect 0 '"motor_current_A": -?0(\.0)?,?$' cat report/report.json
}
if [ -e "$jump" ]; then
  ends_well env LD_PRELOAD="$jump" "$thimble"
  # 1.5 s are 1500 ticks, less the missed ones; a servo on the date would have millions, or none.
  ticks=$(grep -oE '^  "ticks": [0-9]+' report/report.json | grep -oE '[0-9]+')
  expect 0 '^yes$' echo "$([ "$ticks" -ge 20 ] && [ "$ticks" -le 1501 ] && echo yes || echo "$ticks ticks")"
  cell "date jumps by a day and back" "sliding" "the servo does not notice"
else
  not_tested "date jumps by a day and back" sliding "no LD_PRELOAD beside a sanitizer"
fi

rt=(prlimit --rtprio=0)
[ "$(id -u)" != 0 ] || rt=(setpriv --bounding-set=-sys_nice --inh-caps=-sys_nice prlimit --rtprio=0)
if "${rt[@]}" true 2>/dev/null; then
  ends_well "${rt[@]}" "$thimble"
  expect_words 0 'Real-time group' cat out
  expect_json report/report.json .real_time.fifo == false
  cell "real-time priority refused" "sliding" "message with a remedy; the run continues"
else
  not_tested "real-time priority refused" sliding "setpriv or prlimit cannot take it away"
fi

loops=()
for _ in $(seq $((2 * $(nproc)))); do
  timeout 20 bash -c 'while :; do :; done' &
  loops+=($!)
done
ends_well "$thimble"
kill "${loops[@]}"
wait "${loops[@]}" 2>/dev/null
cell "all processors busy" "sliding" "to its end, or off and named"

finish
