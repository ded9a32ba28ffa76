#!/usr/bin/env bash
# Names of unknown origin cannot control a terminal: escapes, C1 controls, reordered and broken UTF-8 in names of files,
# scenes, objects, runs, topics and options appear in no output or log of any command.
source "$(dirname "$0")/expect.sh" "$@"
export HOME=$work/home XDG_STATE_HOME=$work/state XDG_DATA_HOME=$work/data
mkdir -p "$HOME" "$XDG_STATE_HOME"

hostile=$'n\e]0;title\a\e[31m\x08\r\x7f\xc2\x9b31m\xe2\x80\xae\xe2\x81\xa6\xff\xc0\x80x'
# The same in YAML; a scalar cannot hold broken UTF-8.
yaml_hostile='n\e]0;title\a\e[31m\b\r\x7f\u009b31m\u202e\u2066x'

# bad_bytes FILE: its lines with a control character except line feed and tab, with C1, with a character that reorders
# text, or with bytes that are no UTF-8.
bad_bytes() {
  LC_ALL=C grep -naP '[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\x8e\x8f\xa8-\xae]|\xe2\x81[\xa6-\xaf]' "$1"
  iconv -f UTF-8 -t UTF-8 "$1" >/dev/null 2>&1 || echo "no UTF-8"
}

# plain COMMAND...: prints text, without control sequences for a terminal.
plain() {
  local bad
  checks=$((checks + 1))
  timeout 60 "$@" >out 2>&1 </dev/null
  if [ $? -ge 128 ]; then
    echo "FAILED: $(printf '%q ' "$@"): a signal"
    failures=$((failures + 1))
    return
  fi
  cat out >>all
  bad=$(bad_bytes out | head -3 | cat -v)
  if [ -n "$bad" ] || [ ! -s out ]; then
    echo "FAILED: $(printf '%q ' "$@"): ${bad:-nothing was printed}"
    failures=$((failures + 1))
  fi
}

# The check itself finds each kind.
checks=$((checks + 1))
for text in $'\e[31m' $'\r' $'\x7f' $'\xc2\x9b' $'\xe2\x80\xae' $'\xe2\x81\xa6' $'\xff'; do
  printf 'a %s b\n' "$text" >one
  [ -n "$(bad_bytes one)" ] || { echo "FAILED: $(cat -v one) was not found"; failures=$((failures + 1)); }
done

cp -r "$source_dir/app/arms" "$source_dir/app/scenes" .
sed -E "s/^name: .*/name: \"$yaml_hostile\"/; s/name: entry_face/name: \"$yaml_hostile\"/" scenes/box.yaml >scenes/hostile.yaml
cp scenes/hostile.yaml "scenes/$hostile.yaml"
scene=scenes/hostile.yaml

# A scene with such names, in every kind of run.
plain "$thimble" run $scene --duration 0.05 --record rec.h5 --report report --save-mesh all.off --log run.log
plain "$thimble" run $scene --duration 0.05 --save-mesh one.off --save-object absent
plain "$thimble" run "scenes/$hostile.yaml" --duration 0.05 --record "$hostile.h5" --report "$hostile" --save-mesh "$hostile.off"
plain "$thimble" run "$hostile"
plain "$thimble" run box --arm "$hostile"
plain "$thimble" run box --device "$hostile"
plain "$thimble" run box --quality "$hostile"
plain "$thimble" run box "--$hostile"
plain "$thimble" run box "$hostile"
plain "$thimble" run box --duration "$hostile"
plain "$thimble" run box --log "no/$hostile/folder"
plain "$thimble" run box --duration 0.05 --record "no/$hostile/rec.h5"
plain "$thimble" run --list
plain "$thimble" "$hostile"
plain "$thimble" help "$hostile"
plain "$thimble" help scene "$hostile"
plain "$thimble" tune $scene
plain "$thimble" tune "$hostile"
plain "$thimble" shot "$hostile" --output x.png
plain "$thimble" bench "$hostile"
plain "$thimble" study "$hostile"
plain "$thimble" doctor
plain "$thimble" devices
plain "$thimble" calibrate --device "$hostile"
plain "$thimble" feel-check --device "$hostile"
plain "$thimble" identify --device "$hostile"
plain "$thimble" hil --device "$hostile" --suite full
plain "$thimble" exec --arm "$hostile" -- true
plain "$thimble" plug "$hostile"
plain "$thimble" plug vintage_phantom --faults "$hostile"
plain "$thimble" view "$hostile" --text --for 2
plain "$thimble" view "$hostile" --pause
plain "$thimble" view --list
plain "$thimble" run $scene --duration 0.05 --clock paced --speed 10 --name "$hostile"

# Keys, values and texts of scenes and arms.
for change in "s/^arm: .*/arm: \"$yaml_hostile\"/" "s/stiffness: 300/\"$yaml_hostile\": 300/" \
  "s/stiffness: 300/stiffness: \"$yaml_hostile\"/" "s/form: wedges/form: \"$yaml_hostile\"/" \
  "s/box: .sides: .*/mesh: \"$yaml_hostile.off\"/" "s/box: .sides: .*/mesh: \"cgal:$yaml_hostile.off\"/"; do
  sed -E "$change" scenes/hostile.yaml >scenes/changed.yaml
  plain "$thimble" run scenes/changed.yaml --duration 0.05
done
printf 'name: a%s\n' "$hostile" >scenes/raw.yaml
plain "$thimble" run scenes/raw.yaml
sed -E "s/^name: .*/name: \"$yaml_hostile\"/" arms/vintage_phantom.yaml >arms/hostile.yaml
plain "$thimble" run $scene --duration 0.05 --arm arms/hostile.yaml --record arm.h5
plain "$thimble" doctor --arm arms/hostile.yaml

# Meshes and pictures whose names appear in errors of their readers and of libraries.
for ending in off obj stl ply gltf glb 3mf dae amf 3ds; do
  printf '%s' "$hostile" >"bad.$ending"
  plain "$thimble" mesh "bad.$ending"
  printf 'OFF\n4 4 0\n0 0 %s\n' "$hostile" >"$hostile.$ending"
  plain "$thimble" mesh "$hostile.$ending"
done
printf 'ply\nformat ascii 1.0\nelement %s 3\nproperty float x\nend_header\n' "$hostile" >key.ply
plain "$thimble" mesh key.ply
printf '{"asset":{"version":"2.0"},"extensionsRequired":["%s"]}' "$yaml_hostile" | sed 's/\\e/\\u001b/g; s/\\a/\\u0007/; s/\\x7f/\\u007f/' >key.gltf
plain "$thimble" mesh key.gltf
plain "$thimble" mesh page "$hostile.off" "no/$hostile/out.pages"

# Recordings, trajectories and tables.
plain "$thimble" export rec.h5 --csv "$hostile.csv"
plain "$thimble" export "$hostile.h5" --csv rec.csv
plain "$thimble" export "no$hostile.h5" --csv rec.csv
plain "$thimble" replay rec.h5
plain "$thimble" replay "$hostile.h5" --page "$hostile.html"
plain "$thimble" replay rec.h5 --scene "$hostile"
plain "$thimble" replay rec.h5 --record "no/$hostile.h5"
plain "$thimble" twin arm.h5 --arm "$hostile"
plain "$thimble" twin arm.h5 --arm arms/hostile.yaml
printf 't x y z\n0 0 0 %s\n' "$hostile" >path.csv
plain "$thimble" replay path.csv --scene $scene
plain "$thimble" replay path.csv --scene $scene --columns "$hostile"
plain "$thimble" replay path.csv --scene $scene --frame "$hostile"
printf '%s' "$hostile" >"$hostile.db3"
plain "$thimble" replay "$hostile.db3" --scene $scene

# The logs.
for log in run.log "$XDG_STATE_HOME"/thimble/log/*.log; do
  checks=$((checks + 1))
  bad=$(bad_bytes "$log" | head -3 | cat -v)
  [ -z "$bad" ] || { echo "FAILED: $log: $bad"; failures=$((failures + 1)); }
done
# Files for a browser or a program keep the names unchanged.
checks=$((checks + 1))
python3 -c 'import json; json.load(open("report/report.json"))' ||
  { echo "FAILED: report.json is no JSON"; failures=$((failures + 1)); }
# The names were printed at all.
checks=$((checks + 1))
[ "$(grep -c 'n?]0;title??\[31m' all)" -gt 20 ] ||
  { echo "FAILED: the names are in few texts"; failures=$((failures + 1)); }
finish
