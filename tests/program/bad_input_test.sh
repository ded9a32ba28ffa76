#!/usr/bin/env bash
# Bad input of every kind: one clear sentence, a non-zero exit code, and nothing crashes.
source "$(dirname "$0")/expect.sh" "$@"

good_scene() {
  cp -r "$source_dir/app/arms" "$source_dir/app/scenes" .
}

# scene_with SED: the demo's scene, changed by a sed expression, as scenes/changed.yaml.
scene_with() { sed -E "$1" scenes/elephant.yaml >scenes/changed.yaml; }

tetrahedron() {
  printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n'
}

# Meshes.
tetrahedron >good.off
expect 0 '' "$thimble" mesh good.off --output good.json
expect_json good.json .touchable == true
expect 2 'no_such.off' "$thimble" mesh no_such.off
expect 2 'folder' "$thimble" mesh .
expect 2 'cgal:elephant.*scenes' "$thimble" mesh cgal:elephant
: >empty.off
expect 2 'empty\.off' "$thimble" mesh empty.off
printf 'OFF\n0 0 0\n' >no_triangles.off
expect 2 'no_triangles\.off' "$thimble" mesh no_triangles.off
tetrahedron | sed 's/^1 0 0$/1 nan 0/' >nan.off
expect 2 'nan\.off:4' "$thimble" mesh nan.off
tetrahedron | sed 's/^1 0 0$/1e300 0 0/' >huge.off
expect 2 'huge\.off:4' "$thimble" mesh huge.off
tetrahedron | sed '$d' >open.off
sed -i 's/^4 4 0/4 3 0/' open.off
expect 2 '' "$thimble" mesh open.off --output open.json
expect_json open.json '.faults[kind=open_edge].count' == 3
tetrahedron | head -c 40 >truncated.off
expect 2 'truncated\.off' "$thimble" mesh truncated.off
tetrahedron | sed 's/^3 2 0 3$/3 2 0 9/' >index.off
expect 2 'index\.off:10' "$thimble" mesh index.off
printf 'OFF\n1000000000000 4 0\n' >bomb.off
expect 2 'bomb\.off' "$thimble" mesh bomb.off
head -c 4000 /dev/urandom >noise.off
expect 2 'noise\.off' "$thimble" mesh noise.off
head -c 4000 /dev/urandom >noise.stl
expect 2 'noise\.stl' "$thimble" mesh noise.stl
head -c 4000 /dev/urandom >noise.ply
expect 2 'noise\.ply' "$thimble" mesh noise.ply
head -c 4000 /dev/urandom >noise.obj
expect 2 'noise\.obj' "$thimble" mesh noise.obj
for ending in gltf glb 3mf dae amf 3ds; do
  head -c 4000 /dev/urandom >noise.$ending
  expect_words 2 "noise.$ending" "$thimble" mesh noise.$ending
done
cp good.off good.xyz
expect 2 'good\.xyz' "$thimble" mesh good.xyz
mkdir folder.off
expect_words 2 'folder.off' "$thimble" mesh folder.off
# Faces with more corners are split: a cube of six squares can be touched.
printf 'OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n' >cube.off
expect 0 '' "$thimble" mesh cube.off --output cube.json
expect_json cube.json .triangles == 12

# Scenes.
good_scene
# Keys with an old name are read as before, each with one warning that gives the new name.
sed '0,/wavelength:/s//grain:/' scenes/sandpaper.yaml >scenes/old_keys.yaml
expect_words 0 'old_keys.yaml:# grain wavelength' "$thimble" run scenes/old_keys.yaml
expect 0 '^1$' sh -c "'$thimble' run scenes/old_keys.yaml 2>&1 | grep -c 'old_keys.*grain'"
for scene in sandpaper old_keys; do
  "$thimble" run scenes/$scene.yaml --duration 2 --record $scene.h5 >/dev/null 2>&1
  "$thimble" export $scene.h5 --csv $scene.csv >/dev/null 2>&1
done
expect 0 '^2000$' sh -c "grep -vc '^[a-z#]' sandpaper.csv"
expect 0 '' cmp sandpaper.csv old_keys.csv
expect 2 'no_such.yaml' "$thimble" run no_such.yaml
: >empty.yaml
expect 2 'empty\.yaml' "$thimble" run empty.yaml
printf '{[' >syntax.yaml
expect 2 'syntax\.yaml:1' "$thimble" run syntax.yaml
head -c 4000 /dev/urandom >noise.yaml
expect 2 'noise\.yaml' "$thimble" run noise.yaml
scene_with 's/^( *)stiffness:.*/\1stiffness: stiff/'
expect_words 2 'changed.yaml:# stiffness N/m "stiff"' \
  "$thimble" run scenes/changed.yaml
scene_with 's/^( *)stiffness:.*/\1stiffness: -5/'
expect 2 'changed\.yaml:[0-9]+: stiffness: .*-5' "$thimble" run scenes/changed.yaml
scene_with 's/^( *)stiffness:.*/\1stiffness: .nan/'
expect 2 'changed\.yaml:[0-9]+: stiffness' "$thimble" run scenes/changed.yaml
scene_with 's/^( *)stiffness:(.*)/\1stifness:\2/'
expect_words 2 'changed.yaml:# stifness stiffness' "$thimble" run scenes/changed.yaml
# A wrong value is reported by itself, without the checks that would compare with it.
for seed in 7.5 0x1f 9007199254740993 -1 "'7'"; do
  sed "s/^seed:.*/seed: $seed/" scenes/box.yaml >scenes/changed.yaml
  expect_error 2 'changed.yaml:# seed 0 9007199254740992' "$thimble" run scenes/changed.yaml
done
expect 0 '^1$' bash -c '"$0" run scenes/changed.yaml 2>&1 | wc -l' "$thimble"
sed 's/^seed:.*/rate: 0x3e8/' scenes/box.yaml >scenes/hex.yaml
expect_words 2 'hex.yaml:11 rate 10 100000 "0x3e8"' "$thimble" run scenes/hex.yaml
expect 0 '^1$' bash -c '"$0" run scenes/hex.yaml 2>&1 | wc -l' "$thimble"
cat >scenes/damped.yaml <<END
name: damped
duration: 1
arm: ../arms/vintage_phantom.yaml
objects:
  - {name: honey, field: viscous, damping: 5000}
  - {name: ball, sphere: {radius: 0.03}, stiffness: 600, damping: 5000, effects: [{friction: lugre, coefficient: 0.5, damping: 5}]}
hand: {path: [{t: 0, at: [0, 0, 0]}, {t: 1, at: [0, 0, 0]}]}
END
expect_words 2 'damped.yaml:6 damping 0 1000 N s/m "5000"' "$thimble" run scenes/damped.yaml
expect 0 '^2$' bash -c '"$0" run scenes/damped.yaml 2>&1 | wc -l' "$thimble"
# Invalid characters, by line and column; a pipe; very many keys.
printf 'name: caf\xe9\n' >scenes/latin1.yaml
expect_words 2 'latin1.yaml:1:10 0xE9 UTF-8' "$thimble" run scenes/latin1.yaml
printf 'name: a\nobjects:\n\t- {name: b}\n' >scenes/tab.yaml
expect_words 2 'tab.yaml:3:1 tab' "$thimble" run scenes/tab.yaml
printf 'name: a\nduration:\xc2\xa010\n' >scenes/nbsp.yaml
expect_words 2 'nbsp.yaml:2:10 U+00A0' "$thimble" run scenes/nbsp.yaml
mkfifo scenes/pipe.yaml
expect_words 2 'pipe.yaml' timeout 20 "$thimble" run scenes/pipe.yaml
mkdir -p app/scenes && mkfifo app/scenes/pipe.yaml
expect 0 '^  vintage_phantom ' timeout 20 "$thimble" run --list
rm -r app
seq 100000 | sed 's/.*/key_&: 1/' >scenes/many.yaml
expect_words 2 '# follow' timeout 60 "$thimble" run scenes/many.yaml
scene_with 's/^arm:.*/arm: no_such_arm.yaml/'
expect 2 'no_such_arm\.yaml' "$thimble" run scenes/changed.yaml
scene_with 's/^( *)mesh:.*/\1mesh: no_such_mesh.off/'
expect 2 'no_such_mesh\.off' "$thimble" run scenes/changed.yaml
cp good.off open.off noise.off scenes/
scene_with 's/^( *)mesh:.*/\1mesh: open.off/'
expect_words 2 'open.off' "$thimble" run scenes/changed.yaml

# A page file with damage in its pages: the run ends, and its exit code reports the damage.
expect 0 '' "$thimble" mesh generate scenes/ring.pages --triangles 20000
cat >scenes/ring.yaml <<END
name: ring
duration: 1
arm: ../arms/vintage_phantom.yaml
objects: [{name: ring, mesh: ring.pages, size: 0.09, stiffness: 700, damping: 1}]
hand: {path: [{t: 0, at: [0.0317, 0, 0.035]}, {t: 1, at: [0.0317, 0, 0.009]}]}
END
expect 0 '' "$thimble" run scenes/ring.yaml
# Each page of 64 KiB gets wrong bytes.
bytes=$(stat -c %s scenes/ring.pages)
for ((at = bytes - 8; at > 8192; at -= 65536)); do
  printf 'damaged' | dd of=scenes/ring.pages bs=1 seek="$at" conv=notrunc status=none
done
expect 2 'ring\.pages' "$thimble" run scenes/ring.yaml

# Output that is lost is an error; a reader that closes the pipe is not.
expect 1 '^thimble: ' bash -c '"$0" run --list >/dev/full' "$thimble"
expect 1 '^thimble: ' bash -c '"$0" --help >/dev/full' "$thimble"
expect 0 . bash -c 'set -o pipefail; "$0" run --list | head -1' "$thimble"
# A recording instead of its scene.
cp scenes/box.yaml scenes/mine.yaml
expect_words 2 'mine.yaml recording' \
  "$thimble" run scenes/mine.yaml --duration 0.1 --record scenes/mine.yaml
expect 0 '' cmp scenes/box.yaml scenes/mine.yaml
sed 's/^seed:.*/rate: 40/' scenes/box.yaml >scenes/slow.yaml
expect_words 2 'slow.yaml:11 rate 50 40' "$thimble" run scenes/slow.yaml
# A seed above 64 bits: the message gives the range.
expect_error 2 '--seed 0 18446744073709551615 "99999999999999999999"' \
  "$thimble" run scenes/box.yaml --seed 99999999999999999999
# A bad arm file is bad input, whether or not an arm is plugged in.
for command in calibrate feel-check 'identify --output new.yaml' 'run scenes/box.yaml --device auto'; do
  # shellcheck disable=SC2086
  expect_error 2 'empty.yaml' "$thimble" $command --arm ./empty.yaml
done
# A number in quotes is a text.
scene_with 's/^( *)stiffness:.*/\1stiffness: "800"/'
expect_words 2 'changed.yaml:# stiffness N/m "800" quotes' "$thimble" run scenes/changed.yaml
# Fields have no mesh to save.
expect_error 2 '--save-mesh' "$thimble" run charges --save-mesh charges.off
expect 1 '' test -e charges.off
# A trajectory with a number that is not finite.
for line in '0.5 nan 0 0' '0.5 0 0 nan' 'nan 0 0 0'; do
  printf '0 0 0 0.03\n%s\n1 0 0 0.03\n' "$line" >nan.txt
  expect_error 2 'nan.txt 2' "$thimble" replay nan.txt --scene scenes/box.yaml
done
# A missing recording is reported as such, whatever else is asked of it.
expect_error 2 'nofile.h5 file' "$thimble" view nofile.h5 --text
expect_error 2 'nofile.h5 file' "$thimble" view nofile.h5
# A wire so slow that no report arrives is an error of the arm file, found at once.
sed -E 's/^( *)delay_in: [0-9.]+/\1delay_in: 1/' arms/vintage_phantom.yaml >arms/late.yaml
expect_error 2 'late.yaml:# delay_in 0.256 s' timeout 20 "$thimble" run scenes/box.yaml --arm arms/late.yaml
# A viewer ends at the given time although there is no run.
expect 0 . timeout 20 "$thimble" view no_such_run --text --for 0.2

# A report that cannot be written.
if [ -f "$THIMBLE_MESHES/elephant.off" ]; then
  : >a_file
  expect 2 'a_file' "$thimble" run scenes/elephant.yaml --duration 0.01 --report a_file/report
fi
finish
