#!/usr/bin/env bash
# Reports about missing arms, and runs on the simulated arm.
source "$(dirname "$0")/expect.sh" "$@"
export XDG_CONFIG_HOME=$work/config XDG_STATE_HOME=$work/state
vintage=$source_dir/app/arms/vintage_phantom.yaml

# A system below a folder: one WoodenHaptics arm without udev rule and without node.
mkdir -p root/sys/bus/usb/devices/1-1/power
cd root/sys/bus/usb/devices/1-1
echo 1234 >idVendor
echo 0006 >idProduct
echo WH01 >serial
echo 1 >busnum
echo 4 >devnum
echo auto >power/control
cd "$work"
# Without a driver the size of its reports is unknown, so its kind is unknown.
expect_words 0 'WH01 mbed HID USB 1 4 - doctor' \
  "$thimble" devices --root root
expect_words 3 'PROBLEM udev' "$thimble" doctor --root root
expect 3 '-> sudo modprobe usbhid' "$thimble" doctor --root root
expect 3 'power/control' "$thimble" doctor --root root
mkdir -p root/etc/udev/rules.d
cp "$source_dir/udev/70-thimble.rules" root/etc/udev/rules.d/
expect 3 '^ok .*/etc/udev/rules\.d' "$thimble" doctor --root root
# With a driver: a board with reports of 8 bytes, which is identified when it is opened; one of 14 bytes, whose kind is
# unknown; and a second one with the same serial number, which is named by its socket.
hid=root/sys/bus/usb/devices/1-1/1-1:1.0/0003:1234:0006.0001
mkdir -p $hid/hidraw/hidraw3 root/dev
: >root/dev/hidraw3
descriptor() { # of the raw HID examples, with reports of $1 (octal) bytes
  printf "\\006\\253\\377\\012\\000\\002\\241\\001\\165\\010\\225\\$1\\011\\001\\201\\002\\011\\002\\221\\002\\300"
}
descriptor 010 >$hid/report_descriptor
expect_words 0 'WH01 WoodenHaptics USB HID 1 4 /dev/hidraw3 ready' "$thimble" devices --root root
descriptor 016 >$hid/report_descriptor
expect_words 0 'WH01 mbed HID 14 doctor' "$thimble" devices --root root
expect 0 'board: mbed_hid_14' "$thimble" doctor --root root
cp -r root/sys/bus/usb/devices/1-1 root/sys/bus/usb/devices/1-2
expect_words 0 'usb-1-2 mbed HID' "$thimble" devices --root root
rm -r root/sys/bus/usb/devices/1-[12]
expect 1 '' bash -c '"$0" doctor --root root | grep -E "mbed|WH01|usb-1"' "$thimble"

expect_words 3 "'WH02'" \
  "$thimble" run "$source_dir/tests/data/scenes/stroke.yaml" --device WH02
# Each arm file runs on its own simulated arm; the Falcon takes the given firmware, or any.
# An arm behind its vendor's software is not simulated, and this is reported.
for arm in "$source_dir"/app/arms/*.yaml; do
  if grep -qE '^protocol: (haply_service|dhd_library|hd_library)' "$arm"; then
    expect_words 2 'simulated' "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --arm "$arm"
    expect_words 3 'simulated' "$thimble" feel-check --arm "$arm"
    expect_error 2 calibrated "$thimble" calibrate --dry-run --arm "$arm"
    continue
  fi
  scene=$source_dir/tests/data/scenes/two_boxes.yaml
  # The line of a paddle is between the boxes.
  if grep -q '^shape: paddle' "$arm"; then scene=$source_dir/app/scenes/ice.yaml; fi
  expect_run 0 .contact.touch_downs '>' 0 "$thimble" run "$scene" --arm "$arm"
  expect 0 '^ok +force z' "$thimble" feel-check --arm "$arm"
  expect 0 '^motor_sign' "$thimble" calibrate --dry-run --arm "$arm"
done
sed '/^simulation:/,$d' "$source_dir/app/arms/falcon.yaml" >bare.yaml
expect_words 2 "'simulation'" "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" \
  --arm bare.yaml
: >empty.bin
expect_words 2 'firmware' "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" \
  --arm "$source_dir/app/arms/falcon.yaml" --firmware empty.bin

# Without a plugged-in arm the first and the last line say that the simulated one is used,
# with or without success, and nothing is saved.
for options in "" "--device sim"; do
  expect 0 '^home_counts +0 7700 0$' "$thimble" calibrate $options --arm "$vintage"
  expect 0 '^ok +watchdog' "$thimble" feel-check $options --arm "$vintage"
done
sed 's/^simulation:/&\n  wiring: {motor_gain: [-1, 1, 1]}/' "$vintage" >reversed.yaml
"$thimble" calibrate --arm "$vintage" >calibrate.txt 2>&1
"$thimble" feel-check --arm "$vintage" >check.txt 2>&1
"$thimble" feel-check --arm reversed.yaml >reversed.txt 2>&1
for said in calibrate.txt check.txt reversed.txt; do
  for end in head tail; do
    expect 0 '^SIMULATED: .*vintage_phantom' "$end" -n 1 "$said"
  done
done
expect 0 '^FAILED' cat reversed.txt
expect 1 '' test -e config/thimble/arms/sim.yaml
expect 1 '' test -e state/thimble/feel_checks
expect_words 3 '--arm NAME' "$thimble" feel-check
expect_words 3 '--arm NAME' "$thimble" calibrate --device auto

# Identified constants go into a new file, which runs; no existing file is overwritten, and a reversed
# motor is named before any motion depends on it.
expect_words 0 'twin.yaml' "$thimble" identify --arm "$vintage" --duration 10 --known-mass 0.025 --places 0 \
  --output twin.yaml
expect 0 'mass: 0\.07[45][0-9]*  # kg, apparent \[I ' cat twin.yaml
expect_run 0 .contact.touch_downs '>' 0 "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --arm twin.yaml
expect_words 0 'report/index.html' "$thimble" identify --arm "$vintage" --duration 10 --output told.yaml --report report
expect 0 '<li><b>Scale</b>: ' cat report/index.html
expect 0 '<li><b>Links</b>: .* 8 ' cat report/index.html
expect 1 '' grep -q 'links:' told.yaml
expect 0 '^good$' /usr/bin/python3 -c '
import json, re
page = open("report/index.html").read()
assert "The fit is good" in page and "watchdog of the firmware" in page and "src=" not in page, page[:2000]
figures = {one["name"]: one for one in json.load(open("report/figures.json"))}
assert abs(figures["report period"]["value"] - 1) < 1e-6 and figures["model_misfits"]["met"], figures
assert abs(figures["watchdog of the firmware"]["value"] - 100) < 2, figures
print("good")'
if command -v gnuplot >/dev/null; then
  expect_plot report/identify_fit report/identify_rest report/identify_friction report/identify_lines
  expect 0 '^4$' grep -c '^<svg' report/index.html
fi
# An arm with two motors has no places by default, and no panels of an absent motor; an arm file with a low
# limit lowers the default force.
expect 0 '^--places ' "$thimble" identify --arm five_bar --duration 10 --output planar.yaml --report planar
expect 0 '' test -e planar.yaml
expect 0 '' test -e planar/index.html
expect_words 2 '--places' "$thimble" identify --arm five_bar --places 5 --output no.yaml
sed 's/^  force_max: 3 .*/  force_max: 0.5/' "$source_dir/app/arms/five_bar.yaml" >weak.yaml
expect 0 '^--max-force .*0\.5' "$thimble" identify --arm weak.yaml --duration 10 --output weak_found.yaml
# Links are measured over the workspace; a file with other links gets the measured ones.
sed 's/^simulation:/&\n  links: {inertia: [0.0004, 0.0005, 0.0003], yaw_b: 0.0005, yaw_c: 0.0003}/' "$vintage" >linked.yaml
expect 0 '' "$thimble" identify --arm linked.yaml --duration 10 --output links.yaml \
  --report links
expect 0 'links: \{inertia: .*yaw_c: .*\}  # inertia: kg m\^2 about A, B and C \[I ' cat links.yaml
expect_run 0 .contact.touch_downs '>' 0 "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --arm links.yaml
expect 5 '^BAD FIT' "$thimble" identify --arm linked.yaml --duration 10 --output no.yaml --places 0 --report bad
expect_json bad/figures.json '[name=model_misfits].met' == false
expect 1 '' test -e no.yaml
if command -v gnuplot >/dev/null; then
  expect_plot links/identify_masses
  expect 0 '^5$' grep -c '^<svg' links/index.html
fi
expect_words 2 'twin.yaml' "$thimble" identify --arm "$vintage" --duration 10 --output twin.yaml
expect_error 4 'Motor 1' "$thimble" identify --arm reversed.yaml --output no.yaml
expect 1 '' test -e no.yaml
sed 's/^simulation:/&\n  drive_train: {stiffness: [20, 20, 20], inertia: [0.0005, 0.0005, 0.0005], damping: [0.01, 0.01, 0.01]}/' \
  "$vintage" >springy.yaml
expect 0 '' "$thimble" identify --arm springy.yaml --duration 10 --output soft.yaml
expect 0 'drive_train: .*stiffness: \[(19|20)[.0-9]*, (19|20)[.0-9]*, (19|20)[.0-9]*\]' cat soft.yaml
# Behind cables the friction of a joint is a constant.
sed 's/damping: \[0.01/coulomb: [0, 0.02, 0], &/' springy.yaml >sticky.yaml
expect 0 ' 2 +(19|20)[.0-9]* \+- .* mN m ' "$thimble" identify --arm sticky.yaml --duration 10 \
  --output stuck.yaml
expect 0 'coulomb: \[0, 0\.0(19|20)[0-9]*, 0\]' cat stuck.yaml
# Arms whose motors are built in: the results are in the new file, which runs.
expect 0 '' "$thimble" identify --arm falcon --duration 10 --output found.yaml
expect 0 'torque_constant: .* 1 A being 1000 motor values \[I ' cat found.yaml
expect 0 '^ *# delay from force to motion: 0\.00[0-9]* ' cat found.yaml
expect_run 0 .ticks == 100 "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --arm found.yaml --duration 0.1
expect_error 4 Vendor-driven "$thimble" identify --arm inverse3

# Unsafe limits: an error with file and line, in any file.
for wrong in 's/force_max: 5 /force_max: 100 /' 's/soft_start: 0.3/soft_start: 0/' \
  's/soft_start: 0.3/soft_start: 1e-9/' 's/watchdog: 0.1 /watchdog: 10 /' \
  's/rise_max: 2000/rise_max: 1e6/' 's/stall: 0.02 /stall: 0.1 /'; do
  sed "$wrong" "$vintage" >wrong.yaml
  expect 2 'wrong\.yaml:(4[5-9]|5[01]): (force_max|soft_start|watchdog|rise_max|stall): ' \
    "$thimble" run "$source_dir/tests/data/scenes/two_boxes.yaml" --arm wrong.yaml
done
expect_words 3 "'WH02'" "$thimble" feel-check --arm "$vintage" --device WH02
finish
