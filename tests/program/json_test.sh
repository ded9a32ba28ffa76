#!/usr/bin/env bash
# --json: one JSON object on standard output, valid by its schema, and all other text on standard error.
source "$(dirname "$0")/expect.sh" "$@"

python3 -c 'import jsonschema' 2>/dev/null || leave_out "the schemas with a validator: python3-jsonschema is missing"
cat >validate.py <<'END'
import json, sys, jsonschema

schema, result = json.load(open(sys.argv[1])), json.load(open(sys.argv[2]))
jsonschema.Draft202012Validator.check_schema(schema)
faults = [f"{list(fault.absolute_path)}: {fault.message[:300]}"
          for fault in jsonschema.Draft202012Validator(schema).iter_errors(result)]
print("\n".join(faults))
sys.exit(bool(faults))
END
# valid NAME STATUS ARGUMENT...: the result of a command is valid by app/cli/schemas/NAME.json.
valid() {
  local name=$1 status=$2 ended=0
  shift 2
  "$thimble" "$@" --json >"$name.json" 2>"$name.err" || ended=$?
  [ "$ended" = "$status" ] || fail_check "$* --json ended with $ended: $(cat "$name.err")"
  expect_own 0 '' python3 validate.py "$source_dir/app/cli/schemas/$name.json" "$name.json"
}
valid devices 0 devices
expect_json devices.json '.arms[name=sim].ready' == true
mkdir -p root
valid doctor 3 doctor --root root
expect_json doctor.json .problems '>=' 1
valid tune 0 tune rubber
valid bench 0 bench rubber --rate 1000 --duration 0.2
expect_json bench.json '.rates#' == 1
valid list 0 run --list
expect_json list.json '.scenes[name=rubber].name' == rubber
expect_json list.json '.arms[name=polhem].name' == polhem
valid wire 0 wire check "$source_dir/app/arms/wires/reference_serial.yaml"
expect_json wire.json .fuzz.damaged == 100000
valid run 0 run rubber --duration 0.3 --record touch.h5 --no-view
expect_json run.json '.arms[0].recording' == touch.h5
expect_json run.json '.arms[0].report.ticks' == 300
valid run 0 run two_hands --duration 0.1 --no-view
expect_json run.json '.arms#' == 2
valid recording 0 export touch.h5 --info
expect_json recording.json .ticks == 300
expect_json recording.json .complete == true
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n' >solid.off
valid mesh 0 mesh solid.off
expect_json mesh.json .touchable == true
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >open.off
valid mesh 2 mesh open.off
expect_json mesh.json .touchable == false
valid hil 0 hil --device sim --arm vintage_phantom --check reports
# Without a result nothing is printed on standard output.
expect_own 0 '^0$' bash -c "\"\$1\" run no_such_scene --json 2>/dev/null | wc -c" _ "$thimble"
# The old names still work.
expect_words 0 '--seconds --duration' "$thimble" bench rubber --rate 1000 --seconds 0.2
finish
