#!/usr/bin/env bash
# Scenes with several arms: the exit code does not depend on their order in the file, and commands for one arm name a remedy.
source "$(dirname "$0")/expect.sh" "$@"
export XDG_STATE_HOME=$work/state

# The left hand rests on a cube. The right one leaves it too fast, which is a fault.
left='  - name: left
    arm: vintage_phantom
    at: {position: [0, -0.06, 0]}
    hand: {path: [{t: 0, at: [0, -0.05, 0]}, {t: 0.5, at: [0, -0.012, 0], stop: true}, {t: 3, at: [0, -0.012, 0], stop: true}]}'
right='  - name: right
    arm: vintage_phantom
    at: {position: [0, 0.06, 0], turn_degrees: 180}
    hand: {path: [{t: 0, at: [0, 0.05, 0]}, {t: 0.5, at: [0, 0.012, 0], stop: true}, {t: 0.52, at: [0, 0.08, 0.08], stop: true}]}'
scene_of() { # scene_of FAULTS ENTRY...
  printf 'name: cube\nduration: 1\nfaults: %s\narms:\n' "$1"
  shift
  printf '%s\n' "$@"
  printf 'objects: [{name: cube, box: {sides: [0.03, 0.03, 0.03]}, stiffness: 700, damping: 2}]\n'
}
for faults in together apart; do
  scene_of $faults "$left" "$right" >second.yaml
  scene_of $faults "$right" "$left" >first.yaml
  for place in first second; do
    rm -rf report
    ends_with 4 "$thimble" run $place.yaml --report report
    expect_json report/right/report.json .end.fault == over_speed
    [ $faults = apart ] || expect_json report/left/report.json .end.fault == other_arm
  done
done

for command in tune bench; do
  "$thimble" $command --help >/dev/null 2>&1 || continue # in a separate package
  expect_error 2 'second.yaml: left arms' "$thimble" $command second.yaml
done
sed '/arm: vintage/s/$/\n    tool: {radius: 0.003}/' second.yaml >tool.yaml
expect_error 2 'tool.yaml:#: tool arms' "$thimble" run tool.yaml
finish
