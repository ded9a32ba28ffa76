#!/usr/bin/env bash
# Progress: lines on standard error with --progress, one line at a terminal for long work, never on standard output.
source "$(dirname "$0")/expect.sh" "$@"
at_terminal=$source_dir/tests/program/at_terminal.py
"$thimble" run box --duration 5 --record touch.h5 --no-view >/dev/null 2>&1

# both COMMAND...: standard output is equal with and without --progress; only with it standard error has a last line.
both() {
  checks=$((checks + 2))
  "$@" >without.out 2>without.err
  "$@" --progress >with.out 2>with.err
  cmp -s without.out with.out || fail_check "$* prints other text with --progress"
  [ ! -s without.err ] || fail_check "$* shows progress without a terminal: $(cat without.err)"
  grep -qE ': 100 %, took [0-9]+ s$' with.err || fail_check "$* --progress : no last line in: $(cat with.err)"
}
both "$thimble" replay touch.h5 --verify
both "$thimble" export touch.h5 --csv touch.csv
both "$thimble" export touch.h5 --sound touch.wav
both "$thimble" tune rubber
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n' >solid.off
both "$thimble" mesh solid.off
both "$thimble" mesh solid.off --repair repaired.off
both "$thimble" mesh page solid.off solid.pages
if "$thimble" study --help 2>/dev/null | grep -q friction; then both "$thimble" study friction --output friction; fi
expect_own 0 'run: 100 %, took ' "$thimble" run box --duration 1 --no-view --progress
expect_own 0 'hil: 100 %, took ' "$thimble" hil --device sim --arm vintage_phantom --check reports --progress
expect_own 0 'bench: 100 %, took ' "$thimble" bench box --rate 1000 --duration 0.3 --progress

# JSON stays alone on standard output.
"$thimble" tune rubber --json --progress >tune.json 2>/dev/null
expect_json tune.json .format == thimble.tune

# At a terminal the line has the share and the time left, and is erased at the end.
long=(run box --clock paced --duration 4 --no-view)
expect_own 0 'run  [0-9]+ %, [0-9]+ s left  [0-9.]+ of 4\.0 s' /usr/bin/python3 "$at_terminal" -- "$thimble" "${long[@]}"
for option in --no-progress --quiet; do
  expect_own 1 '' bash -c "/usr/bin/python3 '$at_terminal' -- '$thimble' ${long[*]} $option | grep ' s left'"
done
finish
