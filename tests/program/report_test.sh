#!/usr/bin/env bash
# The demo's run on the virtual clock: a report, figures and pictures.
source "$(dirname "$0")/expect.sh" "$@"
[ -f "$THIMBLE_MESHES/elephant.off" ] || { echo "Needs the scanned meshes"; exit 77; }

expect 0 'Report and pictures' "$thimble" run "$source_dir/app/scenes/elephant.yaml" --report out
for key in arm scene build seed ticks rate_Hz period contact force_N energy_to_hand_J; do
  expect 0 "\"$key\"" cat out/report.json
done
expect 0 '"lost": 0,' cat out/report.json
expect 0 '"touch_downs": [1-9]' cat out/report.json
expect 0 '"met": true' cat out/figures.json
expect_plot out/{force_and_depth,path_on_mesh}
expect 1 '' test -e out/period_histogram.png  # in virtual time there is nothing to see
expect 0 '' "$thimble" run "$source_dir/app/scenes/box.yaml" --clock wall --duration 0.3 --report wall
expect_plot wall/period_histogram
expect 0 '^Gate      energy watched: 0\.00 mJ given at most' "$thimble" run "$source_dir/app/scenes/elephant.yaml"
expect 0 '^1$' bash -c '"$0" run "$1" | grep -c ^Energy' "$thimble" "$source_dir/app/scenes/elephant.yaml"
expect 0 'the arm took 0\.00 mJ in all' "$thimble" run "$source_dir/app/scenes/elephant.yaml" --duration 0.05
expect 0 'simulated [0-9]+ N/m' "$thimble" tune "$source_dir/app/scenes/elephant.yaml" --out tuned
expect 0 '"elephant.margin"' cat tuned/figures.json
sed 's/stiffness: 800/stiffness: 8000/' "$source_dir/app/scenes/elephant.yaml" >stiff.yaml
expect 5 'asks for 8000 N/m.* set its stiffness to' "$thimble" tune stiff.yaml
expect 0 'asks for 8000 N/m.*See thimble tune' "$thimble" run stiff.yaml --duration 0.5
# Too much damping: no stiffness is carried, so the damping is what to change.
sed 's/damping: 1 .*/damping: 200/' "$source_dir/app/scenes/elephant.yaml" >damped.yaml
expect 5 'asks for a damping of 200 N s/m.*unstable at any stiffness: set it to [0-9.]+ N s/m or less' "$thimble" tune damped.yaml --out damped
expect 1 '' grep -iE 'nan|inf|null' damped/figures.json
expect 0 'asks for a damping of 200 N s/m' "$thimble" run damped.yaml --duration 0.5
# What it names is accepted.
less=$("$thimble" run damped.yaml --duration 0.1 2>&1 | sed -nE 's/.*set it to ([0-9.]+) N s.m or less.*/\1/p' | head -1)
sed "s/damping: 1 .*/damping: ${less:-none}/" "$source_dir/app/scenes/elephant.yaml" >less.yaml
expect 1 '' bash -c '"$0" run less.yaml --duration 0.1 2>&1 | grep "asks for"' "$thimble"
# The reports of the arm bound what a fast loop carries.
sed -E 's/^rate: .*//; s/stiffness: 800/stiffness: 3000/; $ a rate: 10000' "$source_dir/app/scenes/elephant.yaml" >fast.yaml
expect 0 "asks for 3000 N/m.* A faster loop is not enough, for the arm's reports come every 1 ms" "$thimble" run fast.yaml --duration 0.1
finish
