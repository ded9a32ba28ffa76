#!/usr/bin/env bash
# Every signal that ends a program leads to zero force, a complete recording and report,
# and exit code 130. A burst of signals is one request. A further signal ends the program at once only
# when the arm has zero force and the recording is closed.
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
scene=$source_dir/app/scenes/rubber.yaml
# No pictures are drawn, because they take longer than the runs.
mkdir -p tools
printf '#!/bin/sh\ntouch mesh.png\n' >tools/gnuplot
chmod +x tools/gnuplot
PATH=$PWD/tools:$PATH

# begin: starts a recorded run on the wall clock; returns when it touches. Sets pid to its number.
begin() {
  rm -rf report run.h5 run.csv out
  "$thimble" run "$scene" --clock wall --duration 60 --no-view --report report --record run.h5 \
    >out 2>&1 </dev/null &
  pid=$!
  for _ in $(seq 500); do
    [ ! -e run.h5 ] && kill -0 $pid 2>/dev/null || break
    sleep 0.02
  done
  sleep 0.4
}
early=0 # runs that got a signal before they began
# left_well WHAT: the run has ended with zero force; report and recording are complete.
left_well() {
  wait $pid
  status=$?
  checks=$((checks + 1))
  # If the machine pauses for 100 ms, the watchdog's fault comes first, which is correct as well.
  local reason='"stopped"' code=130
  if [ "$status" = 4 ] && grep -q loop_stalled report/report.json; then
    reason=loop_stalled code=4
  fi
  local said
  said=$("$thimble" export run.h5 --csv run.csv 2>&1)
  local rows
  rows=$(grep -c '^[0-9]' run.csv)
  # On a busy machine the signal may come before the run begins: then it does not run, and there is no report.
  if [ "$status" = 130 ] && [ ! -e report/report.json ] && [ -s run.csv ] && [ "$rows" = 0 ]; then
    early=$((early + 1))
    return
  fi
  ticks=$(grep -oE '^  "ticks": [0-9]+' report/report.json 2>/dev/null | grep -oE '[0-9]+')
  if [ "$status" = $code ] && grep -q "$reason" report/report.json &&
    grep -qE '"motor_current_A": -?0(\.0)?,?$' report/report.json &&
    [ "$rows" = "${ticks:-none}" ] && ! grep -q ' cut ' <<<"$said"; then
    return
  fi
  echo "FAILED: $1: exit code $status, ${ticks:-no} ticks in the report; $said"
  tail -3 out | sed 's/^/    /'
  failures=$((failures + 1))
}

for signal in INT TERM HUP QUIT USR1 USR2 ALRM VTALRM PROF XCPU IO PWR STKFLT RTMIN RTMAX; do
  begin
  kill -s "$signal" $pid
  left_well "SIG$signal"
done

# Bursts: the pauses are 0 to about 20 ms, as exactly as a shell can.
for burst in "INT INT" "INT 0.001 INT" "TERM 0.003 TERM" "INT 0.01 INT" "TERM 0.02 INT 0.002 TERM" \
  "HUP 0.001 HUP 0.001 HUP 0.001 HUP" "HUP TERM HUP" "QUIT 0.005 QUIT" "USR1 0.001 INT 0.004 USR2"; do
  for _ in 1 2; do
    begin
    for step in $burst; do
      case $step in
        0.*) sleep "$step" ;;
        *) kill -s "$step" $pid 2>/dev/null ;;
      esac
    done
    left_well "burst $burst"
  done
done

# A closed terminal: its shell and the kernel both signal it, the kernel with a SIGCONT.
if command -v script >/dev/null; then
  for _ in 1 2 3; do
    rm -rf report run.h5 out pid code
    cat >in_terminal.sh <<END
"$thimble" run "$scene" --clock wall --duration 60 --no-view --report report --record run.h5 >out 2>&1 &
echo \$! >pid
trap 'kill -HUP \$(cat pid); kill -HUP \$(cat pid)' HUP
while :; do wait \$(cat pid); code=\$?; kill -0 \$(cat pid) 2>/dev/null || break; done
echo \$code >code
END
    setsid script -qfc "bash in_terminal.sh" /dev/null >/dev/null 2>&1 </dev/null &
    terminal=$!
    for _ in $(seq 500); do [ -e run.h5 ] && break; sleep 0.02; done
    sleep 0.4
    kill -9 $terminal
    wait $terminal 2>/dev/null
    for _ in $(seq 500); do [ -s code ] && break; sleep 0.02; done
    (exit "$(cat code)") &
    pid=$!
    left_well "closed terminal"
  done
else
  echo "NOT TESTED: a closed terminal: script is not installed"
fi

# Zero force was sent and the recording is closed, but pictures take time: now a signal ends it.
printf '#!/bin/sh\ntouch drawing\nexec sleep 60\n' >tools/gnuplot
begin
kill -s TERM $pid
for _ in $(seq 500); do [ -e report/drawing ] && break; sleep 0.02; done
sleep 0.6
kill -s TERM $pid
wait $pid
expect 0 '^143$' echo $?
expect 0 'run\.h5' cat out
expect_words 0 'run.csv # rubber 1000' bash -c '"$0" export run.h5 --csv run.csv | head -1 | grep -v cut' "$thimble"
[ $early = 0 ] || echo "NOTE: $early signals came before the run began; this machine is busy"
expect 0 '' test "$early" -lt $((checks / 2))
finish
