#!/usr/bin/env bash
# thimble study accuracy as a script sees it: the page, its parts, and counts that are repeatable.
source "$(dirname "$0")/expect.sh" "$@"

rm -rf out
expect_words 2 'nonsense tessellation' "$thimble" study accuracy --axis nonsense --output out
expect 0 '' \
  "$thimble" study accuracy --axis velocity --no-count --output out
for file in index.html velocity.csv summary.json figures.json; do
  expect 0 '' test -s "out/$file"
done
expect_links out/index.html 1
# Two diagrams of one axis, each with its own title.
if command -v gnuplot >/dev/null; then
  expect 0 '^2 2$' bash -c 'titles=$(grep -h -m 1 "^set title \"" out/data/*.gp); echo "$(wc -l <<<"$titles") $(sort -u <<<"$titles" | wc -l)"'
fi
expect_links out/runs/index.html 3
expect 1 '' grep -E 'src="http|href="http' out/index.html
expect 0 '"default_point"' cat out/summary.json
# A pipe gets no progress line.
expect 1 '^0$' bash -c '"$0" study accuracy --axis velocity --no-count --output piped 2>&1 | grep -c "$(printf "\r")"' "$thimble"

# Ctrl-C stops it, a terminal shows the remaining time, and --resume continues after the measured axes with the same numbers.
stopped() {
  local pid
  setsid "$thimble" study accuracy --axis velocity --axis encoder --output stopped "$@" >stopped.txt 2>&1 &
  pid=$!
  for _ in $(seq 1200); do
    if [ -n "${child:-}" ]; then pgrep -s $pid -f "$child" >/dev/null && break; fi
    if [ -z "${child:-}" ]; then [ "$(wc -l 2>/dev/null <stopped/accuracy.journal || echo 0)" -ge 2 ] && break; fi
    sleep 0.05
  done
  kill -TERM -- -$pid  # a shell makes background jobs ignore SIGINT
  wait $pid
}
expect 130 'study accuracy .*[0-9]+ (s|min) left' /usr/bin/python3 "$source_dir/tests/program/at_terminal.py" wait ' left' keys '\x03' -- \
  "$thimble" study accuracy --no-count --output terminal
expect 0 '' mkdir stopped
stopped --no-count
expect 0 '^130$' echo $?
expect_words 0 '--resume' cat stopped.txt
expect 1 '' test -e stopped/figures.json
line=$(sed -n 2p stopped/accuracy.journal)
expect_words 2 '--resume' "$thimble" study accuracy --axis velocity --no-count --output stopped --resume
expect 0 '' "$thimble" study accuracy --axis velocity --axis encoder --no-count --output stopped --resume
expect 0 '^yes$' bash -c '[ "$(sed -n 2p stopped/accuracy.journal)" = "$1" ] && echo yes' _ "$line"
if command -v valgrind >/dev/null; then
  rm -r stopped
  child=callgrind stopped
  expect 0 '^130$' echo $?
  expect 1 '' grep -E 'not counted|not installed' stopped.txt
fi
expect 0 '' "$thimble" bench "$source_dir/app/scenes/box.yaml" --rate 1000 --duration 0.3 --output enough
expect_json enough/figures.json '.#' '>' 0
expect_words 2 '--quality reference "best"' "$thimble" run "$source_dir/app/scenes/box.yaml" --quality best
expect 0 'reference' "$thimble" run "$source_dir/app/scenes/box.yaml" --duration 0.1 --quality reference

if command -v valgrind >/dev/null; then
  count() {
    valgrind --tool=callgrind --toggle-collect=thimble_probed_stroke \
      --callgrind-out-file=/dev/null "$thimble-studies" cost-probe "accuracy/$1" 1 2>&1 \
      >/dev/null | awk '/Collected/ {print $4}'
  }
  # A method by itself, a tick that is searched for as the worst, and an effect with its baseline subtracted.
  for subject in velocity/window/8 tracking/edge_planes/300mm_s effects/effects/friction.bristle; do
    first=$(count "$subject")
    again=$(count "$subject")
    echo "Instructions of one stroke of $subject: $first and $again"
    off=$((first > again ? first - again : again - first))
    expect 0 '' test "${first:-0}" -gt 10000
    expect 0 '' test $((off * 1000)) -le "$first"
  done
else
  echo "LEFT OUT: instructions are not counted, valgrind is not installed"
fi
finish
