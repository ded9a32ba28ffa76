#!/usr/bin/env bash
# The log: its place, its content, the messages on the terminal, and a log that cannot be
# written.
source "$(dirname "$0")/expect.sh" "$@"
export XDG_STATE_HOME=$work/state
file=$work/state/thimble/log/thimble.log
run=(run "$source_dir/tests/data/scenes/two_boxes.yaml" --duration 1)
said() { "$@" 2>&1 >/dev/null </dev/null; }  # only standard error

# By default the terminal gets nothing, and the file gets the events.
expect 0 '^$' bash -c "$(declare -f said); echo \"\$(said '$thimble' ${run[*]})\""
expect 0 'info +[0-9]+ thimble: thimble 0\..*: run .*two_boxes\.yaml --duration 1$' cat "$file"
expect 0 '^[0-9-]{10}T[0-9:.]{12}[+-][0-9]{2}:[0-9]{2} info +[0-9]+ two_boxes: tick 0, 0\.000 s: ' cat "$file"
expect 0 "info +[0-9]+ two_boxes: [^ ]" tail -n 1 "$file"
logged() { grep -c ' two_boxes: ' "$1"; }
brief=$(logged "$file")

# More messages on the terminal, with the option before and after the command; or fewer.
expect 0 '^thimble: tick 0, 0\.000 s: ' said "$thimble" "${run[@]}" -v
expect 0 '^thimble: tick 0, 0\.000 s: ' said "$thimble" -v "${run[@]}"
# -vv prints and logs more than -v: contacts, at a later tick.
before=$(logged "$file")
expect 0 '^thimble: tick [1-9][0-9]*, .* s: ' said "$thimble" "${run[@]}" -vv
expect 0 '' test $(($(logged "$file") - before)) -gt "$brief"
expect 1 '' bash -c "$(declare -f said); said '$thimble' ${run[*]} -v | grep '^thimble: tick [1-9][0-9]*, .* left'"
expect_error 2 '--verbose --quiet' "$thimble" "${run[@]}" -v --quiet
echo 'name: [' >bad.yaml
expect 2 '^thimble: bad\.yaml' said "$thimble" --quiet run ./bad.yaml
expect 0 'error +[0-9]+ [a-z]*: bad\.yaml' cat "$file"

# Another file.
rm -r "$work/state"
expect_run 0 .ticks == 1000 "$thimble" "${run[@]}" --log own.log
expect 0 ' two_boxes: tick 0, ' cat own.log
expect 1 '' test -e "$file"
expect_error 2 '--log /dev/full log' "$thimble" "${run[@]}" --log /dev/full
expect_error 2 '--log none/own.log' "$thimble" "${run[@]}" --log none/own.log
expect 1 '' test -e none

# A log that cannot be written is reported once, and the run continues.
mkdir -p "$work/state"
echo 'in the way' >"$work/state/thimble"
expect 0 '^1$' bash -c "'$thimble' ${run[*]} 2>&1 | grep -c '^thimble: .*$file'"
expect_run 0 .ticks == 1000 "$thimble" "${run[@]}"
rm "$work/state/thimble"

# doctor, help and manual name the log.
expect 0 "^ok .*$file" bash -c "'$thimble' doctor || true"
expect 0 '[-]-log' "$thimble" --help
expect 0 'fB.*-log' "$thimble" manual
finish
