#!/usr/bin/env bash
# The checks of an arm on a test server: output, both files, exit codes.
source "$(dirname "$0")/expect.sh" "$@"

expect 0 '' \
  "$thimble" hil --device sim --arm vintage_phantom --spring 200 --known-length 0.1 --output good.json --junit good.xml
expect 0 '^vintage_phantom quick True reports feel_check home_pose known_length constants watchdog friction_at_rest stiffest_wall force_accuracy soak cable_pull$' \
  /usr/bin/python3 -c '
import json
whole = json.load(open("good.json"))
print(whole["arm_file"], whole["suite"], whole["simulated"], *[one["name"] for one in whole["checks"]])
assert all(one["outcome"] == "passed" for one in whole["checks"][:-1]), whole
wall = next(one for one in whole["checks"] if one["name"] == "stiffest_wall")
figures = {one["name"]: one["value"] for one in wall["figures"]}
assert 500 < figures["stiffest_wall_low"] < figures["stiffest_wall_high"] < 2000
assert figures["wall_over_twin_low"] <= figures["wall_over_twin"] <= figures["wall_over_twin_high"]
assert figures["max_force"] <= 1, figures
soak = next(one for one in whole["checks"] if one["name"] == "soak")
assert "would reach" in soak["text"], soak
heat = {one["name"]: one["value"] for one in soak["figures"]}
assert 0 < heat["motor_heat"] < heat["heat_in_the_end"] < 0.2 and heat["heat_from_model"] < 1e-4, heat'
expect 0 'property name="heat_in_the_end" value="0\.[0-9]+ of the limit"' cat good.xml
expect 0 '^11 0 1 11 1$' /usr/bin/python3 -c '
from xml.etree import ElementTree
suite = ElementTree.parse("good.xml").getroot()
cases = suite.findall("testcase")
print(suite.get("tests"), suite.get("failures"), suite.get("skipped"), len(cases),
      len([case for case in cases if case.find("skipped") is not None]))'

# A reversed motor is named, nothing pushes after it, and the exit code is a failure.
sed 's/^simulation:/&\n  wiring: {motor_gain: [1, -1, 1]}/' "$source_dir/app/arms/vintage_phantom.yaml" >reversed.yaml
expect_words 5 'FAILED feel_check Motor 2' "$thimble" hil --device sim --arm reversed.yaml --junit bad.xml
expect 0 '^1 True$' /usr/bin/python3 -c '
from xml.etree import ElementTree
suite = ElementTree.parse("bad.xml").getroot()
failure = suite.find("testcase[@name=\"feel_check\"]/failure")
print(suite.get("failures"), "Motor 2" in failure.get("message"))'
expect_words 5 'NOT RUN soak' "$thimble" hil --device sim --arm reversed.yaml

# summary FILE: tests, failures, errors, skipped of a JUnit file, after its cases were counted.
cat >summary.py <<'end'
import sys
from xml.etree import ElementTree
suite = ElementTree.parse(sys.argv[1]).getroot()
kinds = {"failures": "failure", "errors": "error", "skipped": "skipped"}
cases = suite.findall("testcase")
for attribute, tag in kinds.items():
    assert int(suite.get(attribute)) == len([case for case in cases if case.find(tag) is not None]), attribute
assert int(suite.get("tests")) == len(cases)
print(suite.get("tests"), *[suite.get(attribute) for attribute in kinds])
end
# A check that did not run is an error, so that the file cannot count as a success.
expect 0 '^11 1 7 1$' /usr/bin/python3 summary.py bad.xml

# Without an arm there is no result: the simulated arm is checked only on request, and an old file is removed.
cp good.xml old.xml
cp good.json old.json
expect_words 3 '--device sim' "$thimble" hil --arm vintage_phantom --junit old.xml --output old.json
expect 0 '^11 0 11 0$' /usr/bin/python3 summary.py old.xml
expect 0 '^no_arm 3 not_run$' /usr/bin/python3 -c '
import json
whole = json.load(open("old.json"))
print(whole["end"], whole["exit_code"], *{one["outcome"] for one in whole["checks"]})'
expect 3 '--require-device' "$thimble" hil --device sim --arm vintage_phantom --require-device
expect_words 2 '--check reports' "$thimble" hil --device sim --arm vintage_phantom --check weight

# One check, and those that it requires before it pushes.
expect 0 '' "$thimble" hil --device sim --arm vintage_phantom --check reports --output one.json
expect_json one.json '.checks#' == 1
expect_json one.json '.checks[0].outcome' == passed
expect 0 '' \
  "$thimble" hil --device sim --arm vintage_phantom --check friction_at_rest --junit one.xml
expect 0 '^2 0 0 0$' /usr/bin/python3 summary.py one.xml
expect 0 '^\[2/2\] friction_at_rest$' "$thimble" hil --device sim --arm vintage_phantom --check friction_at_rest
expect_words 5 'cable_pull' "$thimble" hil --device sim --arm vintage_phantom --check cable_pull

# At the time limit and at a signal: zero force, and both files name the checks that did not run.
expect 5 'NOT RUN' "$thimble" hil --device sim --arm vintage_phantom --check soak --soak 60 --timeout 3 --junit late.xml
expect 0 '^2 0 1 0$' /usr/bin/python3 summary.py late.xml
cp good.xml ended.xml
expect_words 130 'NOT RUN' timeout -s TERM --preserve-status 3 \
  "$thimble" hil --device sim --arm vintage_phantom --soak 60 --check reports --check soak --junit ended.xml
expect 0 '^3 0 1 0$' /usr/bin/python3 summary.py ended.xml
# After SIGKILL no old result remains.
cp good.xml killed.xml
expect 137 '' timeout -s KILL 3 "$thimble" hil --device sim --arm vintage_phantom --soak 60 --check soak --junit killed.xml
expect 0 '^2 0 1 0$' /usr/bin/python3 summary.py killed.xml

# A pipe gets one text, with the results of all checks.
expect 0 '^1 0 0 0$' bash -c '"$0" hil --device sim --arm vintage_phantom --check reports --junit /dev/stderr 2>&1 >/dev/null |
  cat >piped.xml && /usr/bin/python3 summary.py piped.xml' "$thimble"
# Any name gives valid XML.
printf 'name: "a <b> & \\\"c\\\" \\x01 \\uFFFE"\n' >named.yaml
sed '/^name:/d' "$source_dir/app/arms/vintage_phantom.yaml" >>named.yaml
expect 0 . "$thimble" hil --device sim --arm named.yaml --check reports --junit named.xml
expect 0 '^1 0 0 0$' /usr/bin/python3 summary.py named.xml

expect_words 3 'simulated' "$thimble" hil --device sim --arm touch
expect_error 3 'falcon --arm vintage_phantom polhem woodenhaptics' "$thimble" hil --device sim --arm falcon
expect_words 3 '--device sim' "$thimble" hil
expect_words 2 '--output nowhere/x.json folder' "$thimble" hil --device sim --arm vintage_phantom --output nowhere/x.json
expect_words 2 '--suite quick full' "$thimble" hil --device sim --arm vintage_phantom --suite slow
expect_words 2 '--spring' "$thimble" hil --device sim --arm vintage_phantom --spring 1
finish
