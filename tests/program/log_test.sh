#!/usr/bin/env bash
# What happens is in the log: where it lies, what is in it, what is heard on the terminal, and what happens where
# it cannot be written.
source "$(dirname "$0")/expect.sh" "$@"
export XDG_STATE_HOME=$work/state
file=$work/state/thimble/log/thimble.log
run=(run "$source_dir/tests/data/scenes/two_boxes.yaml" --duration 1)
said() { "$@" 2>&1 >/dev/null </dev/null; }  # on standard error alone

# By default nothing is heard, and the file knows.
expect 0 '^$' bash -c "$(declare -f said); echo \"\$(said '$thimble' ${run[*]})\""
expect 0 'info +[0-9]+ thimble: thimble 0\..*: run .*two_boxes\.yaml --duration 1$' cat "$file"
expect 0 '^[0-9-]{10}T[0-9:.]{12}[+-][0-9]{2}:[0-9]{2} info +[0-9]+ two_boxes: tick 0, 0\.000 s: Forces are let through\.$' cat "$file"
expect 0 'two_boxes: The run is over; the arm took zero force\.$' cat "$file"
expect 1 '^0$' grep -c 'The tip touches' "$file"

# A person hears more, before and behind the command; or less.
expect 0 '^thimble: tick 0, 0\.000 s: Forces are let through\.$' said "$thimble" "${run[@]}" -v
expect 0 '^thimble: tick 0, 0\.000 s: Forces are let through\.$' said "$thimble" -v "${run[@]}"
expect 0 '^thimble: tick [0-9]+, .* s: The tip touches ' said "$thimble" "${run[@]}" -vv
expect 0 'The tip touches' cat "$file"
expect 2 'do not go together' "$thimble" "${run[@]}" -v --quiet
echo 'name: [' >bad.yaml
expect 2 '^thimble: bad\.yaml' said "$thimble" --quiet run ./bad.yaml
expect 0 'error +[0-9]+ thimble: bad\.yaml' cat "$file"

# Another file.
rm -r "$work/state"
expect 0 '^Loop' "$thimble" "${run[@]}" --log own.log
expect 0 'Forces are let through' cat own.log
expect 1 'No such file' cat "$file"
expect 2 '^thimble: --log: /dev/full: the log cannot be written there' "$thimble" "${run[@]}" --log /dev/full

# Where it cannot be written it is told once, and the run goes on.
mkdir -p "$work/state"
echo 'in the way' >"$work/state/thimble"
expect 0 '^1$' bash -c "'$thimble' ${run[*]} 2>&1 | grep -c '^thimble: The log ends, for $file cannot be written'"
expect 0 '^Loop +1000 ticks' "$thimble" "${run[@]}"
rm "$work/state/thimble"

# Who looks for it is told where it is.
expect 0 "What happens is logged to $file\\." bash -c "'$thimble' doctor || true"
expect 0 '[-]-log' "$thimble" --help
expect 0 'fB.*log' "$thimble" manual
finish
