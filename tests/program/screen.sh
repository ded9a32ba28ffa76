# A virtual screen for the rest of a test, set as DISPLAY. Source it after expect.sh, if Xvfb is installed.
#   $work/Xvfb_screen0: its content
# -noreset: otherwise it restarts when the last window closes, and refuses the next one meanwhile.
# Its number comes from this shell: two tests that search for a free number at once may take the same one.
Xvfb :$((100 + $$ % 50000)) -displayfd 3 -noreset -screen 0 1300x820x24 -fbdir "$work" 3>display.txt 2>/dev/null &
xvfb=$!
trap 'kill $xvfb' EXIT
for _ in $(seq 100); do [ -s display.txt ] && break; sleep 0.1; done
DISPLAY=:$(cat display.txt)
export DISPLAY

# wait_for SECONDS COMMAND...: until it succeeds.
wait_for() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || return 1
    sleep 0.1
  done
}
