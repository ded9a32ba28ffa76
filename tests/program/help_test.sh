#!/usr/bin/env bash
# Every command explains itself.
source "$(dirname "$0")/expect.sh" "$@"

expect 0 'makes virtual objects touchable' "$thimble" --help
expect 0 'Exit codes: 0 done' "$thimble" --help
expect 0 '^thimble [0-9]+\.[0-9]+\.[0-9]+ \(' "$thimble" --version
for command in run exec view devices doctor calibrate feel-check identify twin hil mesh plug bench; do
  expect 0 "$command" "$thimble" "$command" --help
  expect 0 '^thimble [0-9]' "$thimble" "$command" --version
done
for option in device clock duration report seed quality view hand name unchecked hold-to-run; do
  expect 0 "--$option" "$thimble" run --help
done
expect 0 '^sim +simulated arm' "$thimble" devices

expect 0 '^Usage: thimble' "$thimble"
expect 0 'friction +limit cycles of friction' "$thimble" study --help
expect 0 '--out' "$thimble" study friction --help

expect 2 'touch is no command of' "$thimble" touch
expect 2 'SCENE is missing' "$thimble" run
expect 2 'clock' "$thimble" run box --clock sundial
expect 3 "No arm is called 'omni'" "$thimble" run box --device omni
expect 2 'duration' "$thimble" run box --duration -1
expect 2 'duration' "$thimble" run box --duration nan
expect 2 'seed' "$thimble" run box --seed many
expect 2 'button2 to button16, or key' "$thimble" run box --hold-to-run foot
expect 2 'needs a terminal' "$thimble" run box --hold-to-run key
expect 2 'the terminal is the program' "$thimble" exec --hold-to-run key true
finish
