#!/usr/bin/env bash
# thimble mesh: what is put right on loading, what a repair mends, and what it leaves.
source "$(dirname "$0")/expect.sh" "$@"

tetrahedron() {
  printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n'
}

tetrahedron >good.off
expect 0 'Nothing was changed' "$thimble" mesh good.off --repair same.off
expect 0 'it can be touched' "$thimble" mesh same.off
tetrahedron | sed 's/^3 1 2 3$/3 2 1 3/' >flipped.off
expect 0 '1 triangle was turned round' "$thimble" mesh flipped.off
expect 0 '1 triangle was turned round' "$thimble" mesh flipped.off --repair turned.off
expect 0 'closed and wound alike' "$thimble" mesh turned.off
# A fifth vertex a hair beside the fourth tears the tip open.
printf 'OFF\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 1.000001\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 4\n' >torn.off
expect 2 'only one triangle' "$thimble" mesh torn.off
expect 0 '1 vertex was joined' "$thimble" mesh torn.off --repair joined.off
expect 0 'closed and wound alike' "$thimble" mesh joined.off
tetrahedron | sed '$d;s/^4 4 0/4 3 0/' >open.off
expect 2 'A repair makes it touchable: .*repair: true in a scene' "$thimble" mesh open.off
expect 2 '1 hole was filled' "$thimble" mesh open.off
expect 0 '1 hole was filled' "$thimble" mesh open.off --repair closed.off
expect 0 'closed and wound alike' "$thimble" mesh closed.off
# A sheet stays one, until it is made a thin body.
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >sheet.off
expect 2 'touched as a sheet: --repair OUT.off --thicken 0\.01 here' "$thimble" mesh sheet.off --repair still_open.off
expect 2 'only one triangle' "$thimble" mesh still_open.off
expect 2 'touched as a sheet: --repair OUT.off --thicken 0\.01 here' "$thimble" mesh sheet.off
expect 0 'touched as a sheet of 1 triangle' "$thimble" mesh sheet.off --repair thin.off --thicken 0.01
expect 0 'closed and wound alike' "$thimble" mesh thin.off
expect 2 '--thicken needs --repair' "$thimble" mesh sheet.off --thicken 0.01
# What others' programs write.
for ending in gltf glb 3mf amf dae 3ds; do
  expect 0 'closed and wound alike' "$thimble" mesh "$source_dir/tests/data/meshes/box.$ending"
done
expect 0 'unit +0\.0254 m' "$thimble" mesh "$source_dir/tests/data/meshes/box.3mf"
expect 0 'up +y' "$thimble" mesh "$source_dir/tests/data/meshes/box.gltf"
expect 0 'note +1 of 1 part was put where' "$thimble" mesh "$source_dir/tests/data/meshes/placed_box.gltf"
# Formats without a unit, and shapes that a format does not let through.
meshes="$source_dir/tests/data/meshes"
expect 0 '50 m large in a scene without scale or size; STL names no unit: set scale: 0\.001' "$thimble" mesh "$meshes/mm50.stl"
"$thimble" mesh "$meshes/box.3mf" >unit.txt 2>&1
expect 1 '^0$' grep -c 'names no unit' unit.txt
expect 0 '1 pair of parts overlap or lie flush' "$thimble" mesh "$meshes/overlap.obj"
expect 0 '1 pair of parts overlap or lie flush' "$thimble" mesh "$meshes/overlap.obj" --repair overlap.off
expect 0 '12 triangles were turned round' "$thimble" mesh "$meshes/inside_out.off"
expect 2 'requires the glTF extension "FOO_bar", which is not read' "$thimble" mesh "$meshes/unknown_required.gltf"
printf 'v 0 0 0\nv 1mm 0 0\nv 0 1 0\nf 1 2 3\n' >unit.obj
expect 2 'unit\.obj:2: "1mm" in vertex 2 is not a number' "$thimble" mesh unit.obj
# The same in a scene: refused, with the remedy; reported, where it is only doubtful.
scene_of() {
  printf 'name: part\narm: vintage_phantom\nduration: 0.1\nobjects:\n  - {name: part, mesh: %s, stiffness: 500, position: [0, 0, -0.05]%s}\nhand:\n  path:\n    - {t: 0, at: [0, 0, 0.05]}\n    - {t: 0.1, at: [0, 0, 0.051]}\n' "$1" "$2"
}
scene_of "$meshes/mm50.stl" '' >large.yaml
for command in run tune; do
  expect 2 '50 m large, 250 times the reach of the arm \(0\.2 m\); STL names no unit: set scale: 0\.001' "$thimble" $command large.yaml
done
scene_of "$meshes/mm50.stl" ', scale: 0.001' >scaled.yaml
"$thimble" run scaled.yaml >scaled.txt 2>&1
expect 1 '^0$' grep -c 'names no unit' scaled.txt
scene_of "$meshes/overlap.obj" ', size: 0.06' >overlap.yaml
expect 0 '1 pair of parts overlap or lie flush' "$thimble" run overlap.yaml
scene_of "$meshes/inside_out.off" ', size: 0.06' >inverted.yaml
expect 0 '12 triangles were turned round' "$thimble" run inverted.yaml
sed 's/0\.05\]}$/-0.05]}/; s/0\.051\]/-0.049]/' scaled.yaml >inside.yaml
expect 0 'The tip starts inside part: no surface is felt there until' "$thimble" run inside.yaml --report inside
expect 0 'Start     the tip was inside part' "$thimble" run inside.yaml
expect 0 '"part"' grep -A 2 inside_at_start inside/report.json
expect 2 'end in \.off' "$thimble" mesh good.off --repair good.stl
expect 2 'cannot be written' "$thimble" mesh good.off --repair no_folder/good.off
# Cutting a mesh into pages.
expect 0 'good\.pages: 4 triangles in 1 pages' "$thimble" mesh page good.off good.pages
expect 0 'THMBPAGE' head -c 8 good.pages
expect 2 'only one triangle' "$thimble" mesh page open.off open.pages
expect 2 'cannot be written' "$thimble" mesh page good.off no_folder/good.pages
# What a page file is, and one of any size.
expect 0 'All pages are whole' "$thimble" mesh good.pages
expect 0 'bumpy ring of 2048 triangles in 2 pages' "$thimble" mesh generate ring.pages --triangles 2000
expect 0 'triangles   2048' "$thimble" mesh ring.pages
expect 2 'neither drawn nor repaired' "$thimble" mesh ring.pages --repair ring.off
expect 2 'cannot be written' "$thimble" mesh generate no_folder/ring.pages
printf 'x' | dd of=ring.pages bs=1 seek=10000 conv=notrunc status=none
expect 2 '1 pages are damaged' "$thimble" mesh ring.pages
expect 2 'FILE is missing' "$thimble" mesh
if command -v gnuplot >/dev/null; then
  expect 2 'Picture: open\.png' "$thimble" mesh open.off --picture open.png
  expect 0 'PNG' head -c 4 open.png
fi
finish
