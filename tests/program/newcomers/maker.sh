#!/usr/bin/env bash
# A maker of an arm: plugged-in and missing parts, firmware on a USB plug, the checks before the first
# force, a new arm file. All on simulated arms.
source "$(dirname "$0")/follow.sh"

says guide/first_arm.md 'The command that fixes a problem is printed below it.'
see '^sim +simulated arm' thimble devices
thimble doctor >doctor.txt 2>&1 || true  # no arm is plugged in
see 'udev rule' cat doctor.txt
rule=$(sed -n 's/^ *-> sudo cp \([^ ]*\) .*/\1/p' doctor.txt)
[ -z "$rule" ] || [ -e "$rule" ] || fail "doctor names $rule, which is not there"

says guide/commands.md 'makes a simulated arm a USB device of this machine (needs root)'
thimble plug falcon --port 0 >plug.txt 2>&1 &
plug=$!
wait_for 'on port [0-9]+ as USB device' plug.txt
kill -INT $plug
wait $plug || fail "plug ended with $?: $(cat plug.txt)"
see '^Unplugged' cat plug.txt

says guide/own_arm.md 'They then print SIMULATED on the first and the last line, and save nothing.'
see '^encoder_sign' thimble calibrate --device sim --arm polhem
see '^ok +watchdog' thimble feel-check --device sim --arm polhem

# The messages of a board that a maker builds, drawn and decoded.
says guide/own_board.md 'It draws both messages, so that you can compare them with your firmware byte by byte'
see '\|encoder_1' thimble wire check reference_five_bar
see 'the simulated arm reference_five_bar' thimble run disc --arm reference_five_bar --duration 1

came=$(thimble run --list | awk '$1 == "polhem" { print $2 }')
cp "$came" my_arm.yaml
sed -i 's/^name: .*/name: my_arm/' my_arm.yaml
says guide/own_arm.md 'thimble run app/scenes/elephant.yaml --arm app/arms/woodenhaptics.yaml --duration 2'
see 'the simulated arm my_arm' thimble run rubber --arm my_arm.yaml --duration 2
# A reversed motor is found before it pushes a user.
says guide/own_arm.md 'It reports a wire that is dead, reversed or swapped'
sed 's/^simulation:/&\n  wiring: {motor_gain: [1, -1, 1]}/' my_arm.yaml >reversed.yaml
thimble feel-check --device sim --arm reversed.yaml >check.txt 2>&1 </dev/null && fail "reversed: $(cat check.txt)"
see 'Motor 2 pulls backwards' cat check.txt
