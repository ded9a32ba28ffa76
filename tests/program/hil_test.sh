#!/usr/bin/env bash
# The checks of an arm as a test server runs them: what is printed, both files, exit codes.
source "$(dirname "$0")/expect.sh" "$@"

expect 0 '^9 checks: 8 passed, 0 failed, 1 skipped\.$' \
  "$thimble" hil --device sim --arm vintage_phantom --spring 200 --json good.json --junit good.xml
expect 0 '^vintage_phantom quick True reports feel_check constants watchdog friction_at_rest stiffest_wall force_accuracy soak cable_pull$' \
  /usr/bin/python3 -c '
import json
whole = json.load(open("good.json"))
print(whole["arm_file"], whole["suite"], whole["simulated"], *[one["name"] for one in whole["checks"]])
assert all(one["outcome"] == "passed" for one in whole["checks"][:-1]), whole
wall = next(one for one in whole["checks"] if one["name"] == "stiffest_wall")
figures = {one["name"]: one["value"] for one in wall["figures"]}
assert 500 < figures["stiffest_wall_low"] < figures["stiffest_wall_high"] < 2000
assert figures["wall_over_twin_low"] <= figures["wall_over_twin"] <= figures["wall_over_twin_high"]
assert figures["force_most"] <= 1, figures
soak = next(one for one in whole["checks"] if one["name"] == "soak")
assert "would come to" in soak["text"], soak
heat = {one["name"]: one["value"] for one in soak["figures"]}
assert 0 < heat["motor_heat"] < heat["heat_in_the_end"] < 0.2 and heat["heat_from_model"] < 1e-4, heat'
expect 0 'property name="heat_in_the_end" value="0\.[0-9]+ of the limit"' cat good.xml
expect 0 '^9 0 1 9 1$' /usr/bin/python3 -c '
from xml.etree import ElementTree
suite = ElementTree.parse("good.xml").getroot()
cases = suite.findall("testcase")
print(suite.get("tests"), suite.get("failures"), suite.get("skipped"), len(cases),
      len([case for case in cases if case.find("skipped") is not None]))'

# A motor that is turned round: named, nothing pushes after it, and a server sees a failure.
sed 's/^simulation:/&\n  wiring: {motor_gain: [1, -1, 1]}/' "$source_dir/app/arms/vintage_phantom.yaml" >reversed.yaml
expect 5 '^FAILED +feel_check .*Motor 2 pulls backwards' "$thimble" hil --device sim --arm reversed.yaml --junit bad.xml
expect 0 '^1 True$' /usr/bin/python3 -c '
from xml.etree import ElementTree
suite = ElementTree.parse("bad.xml").getroot()
failure = suite.find("testcase[@name=\"feel_check\"]/failure")
print(suite.get("failures"), "Motor 2" in failure.get("message"))'
expect 5 '^skipped +soak +The arm has not passed its feel check' "$thimble" hil --device sim --arm reversed.yaml

expect 3 'cannot be simulated' "$thimble" hil --device sim --arm touch
expect 3 'homed by' "$thimble" hil --device sim --arm falcon
expect 3 'No arm is plugged in' "$thimble" hil
expect 2 '--json: nowhere/x\.json cannot be written: the folder .* does not exist' "$thimble" hil --device sim --arm vintage_phantom --json nowhere/x.json
expect 2 'quick' "$thimble" hil --device sim --arm vintage_phantom --suite slow
expect 2 'spring' "$thimble" hil --device sim --arm vintage_phantom --spring 1
finish
