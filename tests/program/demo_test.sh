#!/usr/bin/env bash
# The build of app/demo.sh runs, draws and reports like the whole program, and names the build for other commands.
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
scenes=$source_dir/app/scenes

expect 0 '' "$thimble" run "$scenes/box.yaml" --duration 0.2 --report out
expect_json out/report.json .ticks == 200
expect_plot out/force_and_depth
for command in "study friction --output x" "bench box --duration 1" "mesh a.off" doctor "replay --verify x"; do
  # shellcheck disable=SC2086
  expect 2 'app/setup.sh release thimble' "$thimble" $command
done
expect 0 '^  study +[A-Z]' "$thimble" --help
# Other runs may exist on this machine.
expect 0 'thimble run|\(sim\)' "$thimble" view --list
expect_words 2 'window' "$thimble" view no_such_run

# Without a viewer in the build no window is started, with or without a screen.
DISPLAY=:987 expect_words 0 'window' "$thimble" run "$scenes/box.yaml" --duration 0.2 \
  --clock wall --view
finish
