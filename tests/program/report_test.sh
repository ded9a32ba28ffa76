#!/usr/bin/env bash
# The demo's run on the virtual clock: a report, figures and pictures.
source "$(dirname "$0")/expect.sh" "$@"
[ -f "$THIMBLE_MESHES/elephant.off" ] || { echo "Needs the scanned meshes"; exit 77; }

expect 0 '' "$thimble" run "$source_dir/app/scenes/elephant.yaml" --report out
for key in arm scene build seed ticks rate_Hz period contact force_N energy_to_hand_J; do
  expect 0 "\"$key\"" cat out/report.json
done
expect_json out/report.json .contact.lost == 0
expect_json out/report.json .contact.touch_downs '>' 0
expect 0 '"met": true' cat out/figures.json
expect_plot out/{force_and_depth,path_on_mesh}
expect 1 '' test -e out/period_histogram.png  # in virtual time periods are constant
expect 0 '' "$thimble" run "$source_dir/app/scenes/box.yaml" --clock wall --duration 0.3 --report wall
expect_plot wall/period_histogram
# Flat triangles give back what they take. A smooth surface gains some work around the paths on a scan
# (SmoothWork.IsSomePercentOnScans).
expect_json out/report.json .energy_to_hand_J.max '<' 0.0001
sed 's/^\( *\)stiffness:/\1contact: {tracker: edge_planes}\n&/' "$source_dir/app/scenes/elephant.yaml" >flat.yaml
expect 0 '' "$thimble" run flat.yaml --report flat
expect_json flat/report.json .energy_to_hand_J.max '<' 0.000005
expect_json out/report.json '.contact.trackers[0].tracker' == compact
expect_json flat/report.json '.contact.trackers[0].tracker' == edge_planes
expect 0 '^Gate .* 0\.00 mJ' "$thimble" run "$source_dir/app/scenes/elephant.yaml"
expect 0 '^1$' bash -c '"$0" run "$1" | grep -c ^Energy' "$thimble" "$source_dir/app/scenes/elephant.yaml"
expect 0 '^Energy .* 0\.00 mJ' "$thimble" run "$source_dir/app/scenes/elephant.yaml" --duration 0.05
expect 0 'simulated [0-9]+ N/m' "$thimble" tune "$source_dir/app/scenes/elephant.yaml" --output tuned
expect 0 '"elephant.margin"' cat tuned/figures.json
sed 's/stiffness: 800/stiffness: 8000/' "$source_dir/app/scenes/elephant.yaml" >stiff.yaml
expect_words 5 '8000 N/m stiffness' "$thimble" tune stiff.yaml
expect_words 0 '8000 N/m tune' "$thimble" run stiff.yaml --duration 0.5
# Too much damping: no stiffness is possible, so the damping must change.
sed 's/damping: 1 .*/damping: 200/' "$source_dir/app/scenes/elephant.yaml" >damped.yaml
expect_words 5 'damping 200 N s/m #' "$thimble" tune damped.yaml --output damped
expect 1 '' grep -iE 'nan|inf|null' damped/figures.json
expect_words 0 'damping 200 N s/m' "$thimble" run damped.yaml --duration 0.5
# The named damping is accepted.
less=$("$thimble" run damped.yaml --duration 0.1 2>&1 | grep '200 N s/m' | grep -oE '[0-9.]+ N s/m' | grep -v '^200 ' | sed 's/ .*//; s/[.]$//' | head -1)
sed "s/damping: 1 .*/damping: ${less:-none}/" "$source_dir/app/scenes/elephant.yaml" >less.yaml
expect 1 '' bash -c '"$0" run less.yaml --duration 0.1 2>&1 | grep -E "damping.*N s/m"' "$thimble"
# The report period of the arm limits the stiffness of a fast loop.
sed -E 's/^rate: .*//; s/stiffness: 800/stiffness: 3000/; $ a rate: 10000' "$source_dir/app/scenes/elephant.yaml" >fast.yaml
expect_words 0 '3000 N/m 1 ms' "$thimble" run fast.yaml --duration 0.1
finish
