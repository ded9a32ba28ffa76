#!/usr/bin/env bash
# Each command has a help text with an example, in lines below 80 characters.
source "$(dirname "$0")/expect.sh" "$@"

expect 0 '0 [a-z]+, 1 [a-z ]+, 2 [a-z ]+, 3 ' "$thimble" --help
expect 0 '^thimble [0-9]+\.[0-9]+\.[0-9]+ \(' "$thimble" --version
# Each command of the table (app/cli/commands.inc) is in the help, and has a row in the guide.
mapfile -t commands < <("$thimble" --help | sed -n '/^Subcommands:/,$s/^  \([a-z][a-z-]*\).*/\1/p')
for command in run exec view devices doctor calibrate feel-check identify twin hil mesh plug bench; do
  expect 0 . grep -xe "$command" <(printf '%s\n' "${commands[@]}")
done
for command in "${commands[@]}"; do
  expect 0 "$command" "$thimble" "$command" --help
  if [[ $output != *"(not in this build)"* ]]; then
    expect 0 . grep "^Example: thimble $command" <(printf '%s\n' "$output")
    expect 1 '^0$' bash -c '"$0" "$1" --help | grep -cE "^.{80,}"' "$thimble" "$command"
  fi
  expect 0 '^1$' bash -c '"$0" "$1" --help | grep -cE "^  (-h|--help)"' "$thimble" "$command"
  expect 0 '^thimble [0-9]' "$thimble" "$command" --version
  expect 0 . grep "\`thimble $command\b" "$source_dir/app/guide/pages/commands.md"
done
for option in device clock duration report seed quality view hand name unchecked hold-to-run; do
  expect 0 "--$option" "$thimble" run --help
done
expect 0 '^sim ' "$thimble" devices

# On a desktop it opens the start window.
expect_words 0 'thimble OPTIONS SUBCOMMAND' env -u DISPLAY -u WAYLAND_DISPLAY "$thimble"
expect 0 '^  friction +[a-zA-Z]' "$thimble" study --help
expect 0 '--output' "$thimble" study friction --help

expect_words 2 'touch run' "$thimble" touch
expect_words 2 'SCENE missing' "$thimble" run
expect 2 'clock' "$thimble" run box --clock sundial
expect_words 3 "'omni'" "$thimble" run box --device omni
expect 2 'duration' "$thimble" run box --duration -1
expect 2 'duration' "$thimble" run box --duration nan
expect 2 'seed' "$thimble" run box --seed many
expect_words 2 'button2 button16 key' "$thimble" run box --hold-to-run foot
expect_words 2 'terminal' "$thimble" run box --hold-to-run key
expect_words 2 'terminal' "$thimble" exec --hold-to-run key true
finish
