#!/usr/bin/env bash
# The workflow that users copy (app/examples/11_check_in_ci.yml): the commands of its steps pass with a correct scene and
# arm, and fail where they should. Instead of an installation, the names of its packages are checked.
source "$(dirname "$0")/expect.sh" "$@"
workflow=$source_dir/app/examples/11_check_in_ci.yml
/usr/bin/python3 -c 'import yaml' 2>/dev/null || {
  echo "NOT TESTED: the workflow for users; install python3-yaml."
  exit 77
}

# Writes each step's commands into steps/NUMBER.sh, its name into steps/NUMBER.name, and its environment into steps/env.
/usr/bin/python3 - "$workflow" <<'END' || exit 1
import pathlib, shlex, sys, yaml

job = yaml.safe_load(open(sys.argv[1]))["jobs"]["touch"]
assert job["container"] == "debian:12", job["container"]
folder = pathlib.Path("steps")
folder.mkdir()
folder.joinpath("env").write_text("".join(f"export {k}={shlex.quote(v)}\n" for k, v in job["env"].items()))
runs = [step for step in job["steps"] if "run" in step]
for number, step in enumerate(runs):
    folder.joinpath(f"{number}.sh").write_text(step["run"])
    folder.joinpath(f"{number}.name").write_text(step["name"])
uploads = [step for step in job["steps"] if step.get("uses", "").startswith("actions/upload-artifact")]
assert len(uploads) == 1 and uploads[0]["if"] == "always()", uploads
folder.joinpath("uploaded").write_text(uploads[0]["with"]["path"])
END
steps=$(ls steps/*.sh | wc -l)
expect 0 '^5$' echo "$steps"

# The user's repository, with the program in its path and a package to install.
mkdir -p bin repository/packages
ln -s "$thimble" bin/thimble
cat >bin/apt-get <<'END'
#!/bin/sh
[ "$1" = update ] && exit 0
[ "$1" = install ] || exit 100
for word in "$@"; do
  case $word in
    ./*) [ -f "$word" ] && echo "installs $word" || exit 100 ;;
  esac
done
END
chmod +x bin/apt-get
touch repository/packages/thimble_0.3.0_amd64.deb
cp "$source_dir/app/scenes/box.yaml" repository/scene.yaml
cp "$source_dir/app/arms/vintage_phantom.yaml" repository/arm.yaml
cp "$source_dir"/app/scenes/*.png repository/ 2>/dev/null

# step NUMBER: runs its commands as a workflow in a container does: in the repository, with sh, up to the first failure.
step() {
  (
    source steps/env
    export PATH=$PWD/bin:$PATH
    cd repository && sh -e "../steps/$1.sh"
  )
}
number_of() { # number_of NAME: number of the step with this name
  local file
  file=$(grep -lx "$1" steps/*.name) || return 1
  basename "$file" .name
}

for i in $(seq 0 $((steps - 1))); do expect 0 '' step "$i"; done
expect_own 0 'installs ./packages/thimble_0.3.0_amd64.deb' step "$(number_of 'Install Thimble')"
while read -r file; do expect 0 '' test -e "repository/$file"; done <steps/uploaded
expect 0 'failures="0"' cat repository/hil.xml

# Wrong inputs must fail: otherwise the green workflow would mean nothing.
right=$(cat repository/scene.yaml)
rm repository/touch.h5
echo "stifness: 3" >>repository/scene.yaml
expect_words 2 'scene.yaml:# stifness' step "$(number_of 'Touch the scene')"
sed 's/stiffness: *[0-9.]*/stiffness: 3900/' <<<"$right" >repository/scene.yaml
expect 5 '[.]margin .*NOT MET' step "$(number_of 'Check that walls are stable')"
sed -i 's/"lost": 0/"lost": 1/' repository/report/report.json
expect 1 'contact' step "$(number_of 'Lose no contact, and stay below the limit of the arm')"
sed -i 's/^simulation:/&\n  wiring: {motor_gain: [1, -1, 1]}/' repository/arm.yaml
expect_words 5 'Motor 2' step "$(number_of 'Check the arm')"
rm repository/packages/*.deb
expect 100 '' step "$(number_of 'Install Thimble')"
finish
