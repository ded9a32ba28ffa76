#!/usr/bin/env bash
# What app/demo.sh builds: runs, draws and reports as the whole program does, and says of the rest what to build.
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
scenes=$source_dir/app/scenes

expect 0 'Report and pictures' "$thimble" run "$scenes/box.yaml" --duration 0.2 --report out
expect 0 '"ticks": 200' cat out/report.json
expect_plot out/force_and_depth
for command in "study friction --out x" "bench box --seconds 1" "mesh a.off" doctor "replay --verify x"; do
  # shellcheck disable=SC2086
  expect 2 'app/setup.sh release thimble' "$thimble" $command
done
expect 0 'study +Measure' "$thimble" --help
# Others may run something on this machine meanwhile.
expect 0 'No run is shown|\(sim\), process [0-9]+' "$thimble" view --list
expect 2 'built without a window' "$thimble" view nobody

# No window is looked for where there is none, on whatever screen.
DISPLAY=:987 expect 0 'No window in this build' "$thimble" run "$scenes/box.yaml" --duration 0.2 \
  --clock wall --view
finish
