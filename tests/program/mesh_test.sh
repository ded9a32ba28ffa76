#!/usr/bin/env bash
# thimble mesh: corrections on load, repairs, and faults that remain.
source "$(dirname "$0")/expect.sh" "$@"

tetrahedron() {
  printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n'
}

tetrahedron >good.off
expect 0 '' "$thimble" mesh good.off --repair same.off --output mesh.json
expect_json mesh.json '.repaired.changes#' == 0
expect 0 '' "$thimble" mesh same.off --output mesh.json
expect_json mesh.json .touchable == true
tetrahedron | sed 's/^3 1 2 3$/3 2 1 3/' >flipped.off
expect 0 '' "$thimble" mesh flipped.off --output mesh.json
expect_json mesh.json .turned_on_load == 1
expect 0 '' "$thimble" mesh flipped.off --repair turned.off --output mesh.json
expect_json mesh.json '.repaired.changes[kind=turned_triangle].count' == 1
expect 0 '' "$thimble" mesh turned.off --output mesh.json
expect_json mesh.json .watertight == true
# A fifth vertex very close to the fourth opens the tip.
printf 'OFF\n5 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 1.000001\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 4\n' >torn.off
expect 2 '' "$thimble" mesh torn.off --output mesh.json
expect_json mesh.json '.faults[kind=open_edge].count' '>' 0
expect_json mesh.json .touchable == false
expect 0 '' "$thimble" mesh torn.off --repair joined.off --output mesh.json
expect_json mesh.json '.repaired.changes[kind=welded_vertex].count' == 1
expect 0 '' "$thimble" mesh joined.off --output mesh.json
expect_json mesh.json .watertight == true
tetrahedron | sed '$d;s/^4 4 0/4 3 0/' >open.off
expect_words 2 '--repair repair: scene' "$thimble" mesh open.off --output mesh.json
expect_json mesh.json '.remedy.options' == '["--repair"]'
expect_json mesh.json '.remedy.changes[kind=filled_hole].count' == 1
expect 0 '' "$thimble" mesh open.off --repair closed.off --output mesh.json
expect_json mesh.json '.repaired.changes[kind=filled_hole].count' == 1
expect 0 '' "$thimble" mesh closed.off --output mesh.json
expect_json mesh.json .watertight == true
# A sheet stays a sheet unless it is made a thin body.
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >sheet.off
expect_words 2 '--repair OUT.off --thicken 0.01' "$thimble" mesh sheet.off --repair still_open.off --output mesh.json
expect_json mesh.json .repaired.remedy.sheet_triangles == 1
expect 2 '' "$thimble" mesh still_open.off --output mesh.json
expect_json mesh.json '.faults[kind=open_edge].count' == 3
expect_words 2 '--repair OUT.off --thicken 0.01' "$thimble" mesh sheet.off --output mesh.json
expect_json mesh.json .remedy.options == '["--repair", "--thicken"]'
expect_json mesh.json .remedy.thickness == 0.01
expect 0 '' "$thimble" mesh sheet.off --repair thin.off --thicken 0.01 --output mesh.json
expect_json mesh.json .repaired.sheet_triangles == 1
expect 0 '' "$thimble" mesh thin.off --output mesh.json
expect_json mesh.json .watertight == true
expect_words 2 '--thicken --repair' "$thimble" mesh sheet.off --thicken 0.01
# Files of other programs.
for ending in gltf glb 3mf amf dae 3ds; do
  expect 0 '' "$thimble" mesh "$source_dir/tests/data/meshes/box.$ending" --output mesh.json
  expect_json mesh.json .watertight == true
done
expect 0 '' "$thimble" mesh "$source_dir/tests/data/meshes/box.3mf" --output mesh.json
expect_json mesh.json .unit_m == 0.0254
expect 0 '' "$thimble" mesh "$source_dir/tests/data/meshes/box.gltf" --output mesh.json
expect_json mesh.json .up == y
expect 0 '' "$thimble" mesh "$source_dir/tests/data/meshes/placed_box.gltf" --output mesh.json
expect_json mesh.json '.notes#' == 1
# What the maps of a scene can use.
expect 0 '' "$thimble" mesh "$source_dir/app/scenes/tissue.obj" --output mesh.json
expect_json mesh.json .texture_coordinates == true
expect_json mesh.json .vertex_colours == true
expect 0 '' "$thimble" mesh "$source_dir/tests/data/meshes/box.3mf" --output mesh.json
expect_json mesh.json .texture_coordinates == false
# Formats without a unit, and shapes that a format cannot express.
meshes="$source_dir/tests/data/meshes"
expect_words 0 '50 m scale size STL unit scale: 0.001' "$thimble" mesh "$meshes/mm50.stl" --output mesh.json
expect_json mesh.json .unit_doubtful == true
expect 0 '' "$thimble" mesh "$meshes/box.3mf" --output mesh.json
expect_json mesh.json .unit_doubtful == false
expect 0 '' "$thimble" mesh "$meshes/overlap.obj" --output mesh.json
expect_json mesh.json .touching_pairs == 1
expect 0 '' "$thimble" mesh "$meshes/overlap.obj" --repair overlap.off --output mesh.json
expect_json mesh.json .repaired.touching_pairs == 1
expect 0 '' "$thimble" mesh "$meshes/inside_out.off" --output mesh.json
expect_json mesh.json .turned_on_load == 12
expect_words 2 '"FOO_bar"' "$thimble" mesh "$meshes/unknown_required.gltf"
printf 'v 0 0 0\nv 1mm 0 0\nv 0 1 0\nf 1 2 3\n' >unit.obj
expect_words 2 'unit.obj:2 "1mm" 2' "$thimble" mesh unit.obj
# The same in a scene: refused, with the remedy; only reported if doubtful.
scene_of() {
  printf 'name: part\narm: vintage_phantom\nduration: 0.1\nobjects:\n  - {name: part, mesh: %s, stiffness: 500, position: [0, 0, -0.05]%s}\nhand:\n  path:\n    - {t: 0, at: [0, 0, 0.05]}\n    - {t: 0.1, at: [0, 0, 0.051]}\n' "$1" "$2"
}
scene_of "$meshes/mm50.stl" '' >large.yaml
for command in run tune; do
  expect_words 2 '50 m 250 0.2 STL unit scale: 0.001' "$thimble" $command large.yaml
done
scene_of "$meshes/mm50.stl" ', scale: 0.001' >scaled.yaml
expect 0 . "$thimble" run scaled.yaml
expect 1 '' bash -c '"$0" run scaled.yaml 2>&1 | grep -E "STL|scale|unit"' "$thimble"
scene_of "$meshes/overlap.obj" ', size: 0.06' >overlap.yaml
expect_words 0 '1 pair' "$thimble" run overlap.yaml
scene_of "$meshes/inside_out.off" ', size: 0.06' >inverted.yaml
expect_words 0 '12 triangles' "$thimble" run inverted.yaml
sed 's/0\.05\]}$/-0.05]}/; s/0\.051\]/-0.049]/' scaled.yaml >inside.yaml
expect_run 0 .contact.inside_at_start == '["part"]' "$thimble" run inside.yaml
expect_words 0 'Start part' "$thimble" run inside.yaml
expect_words 2 '.off' "$thimble" mesh good.off --repair good.stl
expect_words 2 'no_folder/good.off folder' "$thimble" mesh good.off --repair no_folder/good.off
# Division of a mesh into pages.
expect_words 0 'good.pages 4 1' "$thimble" mesh page good.off good.pages
expect 0 'THMBPAGE' head -c 8 good.pages
expect_words 2 'open.off # edges' "$thimble" mesh page open.off open.pages
expect_words 2 'no_folder/good.pages folder' "$thimble" mesh page good.off no_folder/good.pages
# Description of a page file, and one of any size.
expect 0 '' "$thimble" mesh good.pages --output mesh.json
expect_json mesh.json .damaged_pages == 0
expect_json mesh.json .pages == 1
expect_words 0 '2048 2' "$thimble" mesh generate ring.pages --triangles 2000
expect 0 '' "$thimble" mesh ring.pages --output mesh.json
expect_json mesh.json .triangles == 2048
expect_json mesh.json .pages == 2
expect_words 2 'ring.pages' "$thimble" mesh ring.pages --repair ring.off
expect 1 '' test -e ring.off
expect_words 2 'no_folder/ring.pages folder' "$thimble" mesh generate no_folder/ring.pages
printf 'x' | dd of=ring.pages bs=1 seek=10000 conv=notrunc status=none
expect 2 '' "$thimble" mesh ring.pages --output mesh.json
expect_json mesh.json .damaged_pages == 1
expect_words 2 'FILE missing' "$thimble" mesh
if command -v gnuplot >/dev/null; then
  expect_words 2 'open.png' "$thimble" mesh open.off --picture open.png
  expect 0 'PNG' head -c 4 open.png
fi
finish
