#!/usr/bin/env bash
# The JSON Schema of scene and arm files for editors: valid JSON, a valid schema, and the right verdict on files. The unit
# test KeySchema checks its contents without Python.
source "$(dirname "$0")/expect.sh" "$@"

for kind in scene arm; do
  "$thimble" help schema $kind >$kind.schema.json || fail_check "help schema $kind"
  expect_json $kind.schema.json .title == "Thimble $kind file"
  expect_json $kind.schema.json .type == object
done
"$thimble" help schema | cmp - scene.schema.json || fail_check "help schema prints another schema than help schema scene"
expect_error 2 'schema scene arm "mesh"' "$thimble" help schema mesh

if ! python3 -c 'import jsonschema, yaml' 2>/dev/null; then
  echo "NOT TESTED: the schema with a validator; install python3-jsonschema and python3-yaml."
  finish
fi
cat >validate.py <<'END'
import json, re, sys, jsonschema, yaml

class Loader(yaml.SafeLoader):
    """YAML 1.2, as the program and editors read it: `on` is a text, 1e-5 a number."""

KINDS = {"bool": r"^(true|false)$", "float": r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$"}
Loader.yaml_implicit_resolvers = {first: [one for one in some if one[0].rsplit(":", 1)[1] not in KINDS]
                                  for first, some in yaml.SafeLoader.yaml_implicit_resolvers.items()}
for kind, pattern in KINDS.items():
    Loader.add_implicit_resolver("tag:yaml.org,2002:" + kind, re.compile(pattern), None)

schema = json.load(open(sys.argv[1]))
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
faults = [f"{name}: {list(fault.absolute_path)}: {fault.message[:300]}" for name in sys.argv[2:]
          for fault in validator.iter_errors(yaml.load(open(name), Loader=Loader))]
print("\n".join(faults))
sys.exit(bool(faults))
END
expect_own 0 '' python3 validate.py scene.schema.json "$source_dir"/app/scenes/*.yaml
expect_own 0 '' python3 validate.py arm.schema.json "$source_dir"/app/arms/*.yaml
# change KIND FILE SED: a shipped file with one change must not satisfy the schema.
change() {
  sed "$3" "$source_dir/app/$2" >changed.yaml
  cmp -s changed.yaml "$source_dir/app/$2" && fail_check "$3 changes nothing in $2"
  expect_own 1 '' python3 validate.py "$1.schema.json" changed.yaml
}
change scene scenes/rubber.yaml 's/stiffness:/stifness:/'
change scene scenes/rubber.yaml 's/stiffness: [0-9]*/stiffness: soft/'
change scene scenes/rubber.yaml 's/stiffness: [0-9]*/stiffness: 100001/'
change arm arms/vintage_phantom.yaml 's/force_max:/force_most:/'
change arm arms/vintage_phantom.yaml 's/soft_start: [0-9.]*/soft_start: fast/'
change arm arms/vintage_phantom.yaml 's/soft_start: [0-9.]*/soft_start: 0.01/'
finish
