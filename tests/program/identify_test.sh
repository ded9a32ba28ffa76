#!/usr/bin/env bash
# thimble identify at a terminal (keys that stop, questions, largest force) and in a script.
source "$(dirname "$0")/expect.sh" "$@"
python=/usr/bin/python3
at_terminal="$python $source_dir/tests/program/at_terminal.py"
arm=$source_dir/app/arms/vintage_phantom.yaml
brief="identify --device sim --arm vintage_phantom --duration 10 --places 0"
# The simulation of a motion of ten minutes takes much longer than a press of a key.
endless="identify --device sim --arm vintage_phantom --duration 600"

# Any key, and Ctrl-C, ends it while the tip moves, and the terminal is restored.
expect 130 '' $at_terminal wait ' to stop' raw keys x -- "$thimble" $endless --output never.yaml
expect_own 130 '^The terminal was left as it was' $at_terminal wait ' to stop' raw keys ' ' -- "$thimble" $endless --output never.yaml
expect 130 '' $at_terminal wait ' to stop' raw keys '\x03' -- "$thimble" $endless --output never.yaml
expect_own 130 '^The terminal was left as it was' $at_terminal wait ' to stop' raw keys '\x03' -- "$thimble" $endless --output never.yaml
# A closed terminal ends it as well.
expect 130 '' $at_terminal wait ' to stop' hangup -- "$thimble" $endless --output never.yaml
expect 1 '' test -e never.yaml
# Input from anything other than a terminal stops nothing.
expect_words 0 'Ctrl-C' bash -c '(sleep 0.3; echo x) | "$@"' _ "$thimble" $brief --output piped.yaml
expect 0 'mass: ' cat piped.yaml

# At a terminal nothing is written without a yes.
expect 0 '' $at_terminal wait 'asked.yaml? [y/N]' keys 'n\n' -- "$thimble" $brief --output asked.yaml
expect 1 '' test -e asked.yaml
expect 0 '' $at_terminal wait 'asked.yaml? [y/N]' keys 'y\n' -- "$thimble" $brief --output asked.yaml
expect 0 'mass: 0\.07.*\[I ' cat asked.yaml
expect_words 2 'asked.yaml' $at_terminal -- "$thimble" $endless --output asked.yaml
expect 0 '' $at_terminal -- "$thimble" $brief --output said.yaml --yes
expect 0 'mass: ' cat said.yaml
# A script uses --output or --yes.
expect_words 0 '--output --yes' "$thimble" $brief
expect 1 '' test -e vintage_phantom_identified.yaml
expect_words 0 'vintage_phantom_identified.yaml' "$thimble" $brief --yes
expect 0 'mass: ' cat vintage_phantom_identified.yaml

# A bad fit is written only with its own option, and each mark contains it; a yes is not enough.
# A joint with friction, whose cable is too stiff to be detected.
sed 's/^simulation:/&\n  drive_train: {coulomb: [0, 0.03, 0], stiffness: [2000, 2000, 2000], inertia: [0.00001, 0.00001, 0.00001], damping: [0.01, 0.01, 0.01]}/' \
  "$arm" >sticky.yaml
expect_words 5 'BAD FIT Joint 2' "$thimble" identify --device sim --arm sticky.yaml --duration 10 --places 0
# Amplifiers that saturate far below the value of the file, which is detected sooner.
sed 's/current_max: 6 .*/current_max: 0.3/' "$arm" >weak.yaml
bad="identify --device sim --arm weak.yaml --duration 10 --places 0 --output bad.yaml"
expect_words 5 'BAD FIT Motor 3' "$thimble" $bad
expect 5 '' "$thimble" $bad --yes
expect 1 '' test -e bad.yaml
expect 5 '' $at_terminal wait 'bad.yaml? [y/N]' keys '\n' -- "$thimble" $bad --write-bad-fit
expect 1 '' test -e bad.yaml
expect 5 '' "$thimble" $bad --write-bad-fit --report bad
expect 0 '^# BAD FIT: ' head -n 1 bad.yaml
expect 0 'class="verdict bad"' cat bad/index.html
expect 0 '^[1-9][0-9]* 0$' bash -c 'echo "$(grep -c "\[I .*BAD FIT" bad.yaml) $(grep "\[I " bad.yaml | grep -vc "BAD FIT")"'

# The user sets the largest force, up to the limit of the arm file.
most() { # FILE: the largest requested force, N
  "$thimble" export "$1" --csv "$1.csv" >/dev/null
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^f_wanted_W\.[xyz]/) at[++n] = i; next }
    n == 3 { s = $at[1] ^ 2 + $at[2] ^ 2 + $at[3] ^ 2; if (s > most) most = s }
    END { m = sqrt(most); print n, (m > '"$2"' && m <= '"$3"') ? "within" : m }' "$1.csv"
}
for force in 0.5 2; do
  expect 0 '' "$thimble" $brief --max-force $force --record "$force.h5" --output "$force.yaml"
done
expect_own 0 '^3 within$' most 0.5.h5 0.4 0.5
expect_own 0 '^3 within$' most 2.h5 1 2
expect_error 2 '6 N 5 gate.force_max' "$thimble" $brief --max-force 6
expect_error 2 '0.2 N' "$thimble" $brief --max-force 0.1
expect_words 2 'mass #' "$thimble" $brief --max-force 0.5 --known-mass 0.05
expect 2 'max-force' "$thimble" $brief --max-force -1
# The old name of the option still works, with a warning, and is not in the help.
expect_words 0 '--force-most --max-force' "$thimble" $brief --force-most 0.5 --record old.h5 --output old.yaml
expect_own 0 '^3 within$' most old.h5 0.4 0.5
expect 2 'force-most' "$thimble" $brief --force-most -1
expect_error 2 '--force-most --max-force' "$thimble" $brief --force-most 0.5 --max-force 0.5
expect 1 '^0$' bash -c '"$0" identify --help | grep -c force-most' "$thimble"
expect 2 'places' "$thimble" identify --device sim --arm vintage_phantom --places 2
finish
