#!/usr/bin/env bash
# Each option of `thimble run` either leaves the result of a run unchanged, or is in its recording, whose replay is then
# bit-identical. The table below names every option: classify a new one there.
source "$(dirname "$0")/expect.sh" "$@"
export HOME=$work/home XDG_STATE_HOME=$work/state
mkdir -p "$HOME" "$XDG_STATE_HOME"
cp -r "$source_dir/app/arms" "$source_dir/app/scenes" .
sed -E 's/stiffness: 300/stiffness: 200/' arms/vintage_phantom.yaml >arms/other.yaml
sed -i '/^name:/s/.*/name: another_arm/' arms/other.yaml
scene=scenes/water_balloon.yaml

# option | class | arguments to try (none: it is named without a trial) | why
#   same      the ticks are those of the run without it
#   recorded  the recording has it: a replay gives every recorded force
#   hand      the recording has its effect on the hand: the state of the arm in each tick
#   arm       for a real arm or external forces: the recording has them in each tick, or its device
table='
--device        | arm      |                           | a real arm: its state is in each tick, its name in device
--arm           | recorded | --arm arms/other.yaml      | arm_file and arm_text
--firmware      | arm      |                           | of a real arm, before the run
--yes           | same     | --yes                     | asks nothing
--unchecked     | arm      |                           | a limit of the gate of a real arm: f_sent
--homed         | arm      |                           | asks nothing of a real arm
--no-real-time  | arm      |                           | the priority of the loop
--hold-to-run   | arm      |                           | whether a real arm has forces at all
--duration      | recorded | --duration 0.4            | the number of ticks
--clock         | same     | --clock paced --speed 4   | paced ticks are the virtual ones; wall: clock
--speed         | same     | --speed 4                 | the pace alone
--reload        | same     | --reload                  | between two runs
--no-reload     | same     | --no-reload               | between two runs
--hand          | hand     |                           | who leads the hand: its path is in each tick
--button-at     | hand     |                           | buttons of each tick
--view          | hand     |                           | a viewer turns knobs and pauses: setting and gain
--no-view       | same     | --no-view                 | without a viewer
--loop          | same     |                           | each run has its own recording
--sound         | same     |                           | what the window plays
--rumble        | same     |                           | what the window plays
--json          | same     | --json                    | the stream of the text
--name          | same     | --name another            | of the run, for viewers
--quality       | recorded | --quality draft           | options
--budget        | recorded | --quality auto --budget 400 | options
--theme         | same     |                           | of the window and the pictures
--report        | same     | --report report           | after the run
--record        | same     |                           | the recording itself
--force         | same     | --force                   | an older recording of that name is replaced
--save-mesh     | same     | --save-mesh out.off       | after the run
--save-object   | same     | --save-mesh one.off --save-object balloon | after the run
--ros2          | same     |                           | topics of the run
--ros-namespace | same     |                           | names of topics
--ros-network   | same     |                           | who sees the topics
--ros-names     | same     |                           | names of topics
--ros-domain    | same     |                           | of the topics
--ros-force     | arm      |                           | forces of a topic: setting is -2 in each tick
--ros-limit     | arm      |                           | of those forces
--ros-stale     | arm      |                           | of those forces
--ros-frames    | same     |                           | names in messages
--mesh-cache    | same     | --mesh-cache              | only the preparation (mesh_cache_test.sh has a large mesh)
--seed          | recorded | --seed 77                 | seed
--help          | same     |                           | no run
--version       | same     |                           | no run
--list          | same     |                           | no run
--verbose       | same     | --verbose                 | texts
--quiet         | same     | --quiet                   | texts
--progress      | same     | --progress                | lines on standard error
--no-progress   | same     | --no-progress             | no such lines
--log           | same     | --log a.log               | texts
'

# row OPTION: its line of the table.
row() { grep -E "^$1 +\|" <<<"$table"; }
field() { cut -d'|' -f"$1" | sed 's/^ *//; s/ *$//'; }

# The table names exactly the options of the command and of the program.
{ "$thimble" run --help && "$thimble" --help; } 2>&1 | grep -oE '^ +(-[a-zA-Z],)?--[a-z0-9-]+(, *--[a-z0-9-]+|,--[a-z0-9-]+)*|\{false\}|!--[a-z-]+' |
  grep -oE -- '--[a-z0-9-]+' | sort -u >options
checks=$((checks + 1))
[ "$(wc -l <options)" -ge 30 ] || { echo "FAILED: only $(wc -l <options) options were found"; failures=$((failures + 1)); }
while read -r option; do
  checks=$((checks + 1))
  if [ -z "$(row "$option")" ]; then
    echo "FAILED: $option is in no row of the table: does it change the result, and is it in the recording?"
    failures=$((failures + 1))
  fi
done <options
while read -r option; do
  checks=$((checks + 1))
  if ! grep -qx -- "$option" options && [ "$option" != --no-reload ]; then
    echo "FAILED: $option is in the table, but not an option of run"
    failures=$((failures + 1))
  fi
done < <(field 1 <<<"$table" | grep .)

# ticks FILE.h5: its table without the times of the loop.
ticks() {
  "$thimble" export "$1" --csv ticks.csv >/dev/null 2>&1 && cat ticks.csv
}
record() { "$thimble" run "$scene" --record "$@" >run.log 2>&1 || { cat run.log; return 1; }; }
record base.h5 --duration 2
ticks base.h5 >base.csv
expect 0 '' "$thimble" replay base.h5 --verify
while read -r line; do
  class=$(field 2 <<<"$line")
  read -ra arguments <<<"$(field 3 <<<"$line")"
  [ ${#arguments[@]} -gt 0 ] || continue
  checks=$((checks + 1))
  case " ${arguments[*]} " in *' --duration '*) duration=() ;; *) duration=(--duration 2) ;; esac
  rm -rf one.h5 report
  if ! record one.h5 "${duration[@]}" "${arguments[@]}"; then
    echo "FAILED: run ${arguments[*]}"
    failures=$((failures + 1))
    continue
  fi
  ticks one.h5 >one.csv
  changed=no
  cmp -s base.csv one.csv || changed=yes
  case $class in
    same) [ $changed = no ] || { echo "FAILED: ${arguments[*]} changes the result"; failures=$((failures + 1)); } ;;
    recorded)
      [ $changed = yes ] || { echo "FAILED: ${arguments[*]} changes nothing, so this shows nothing"; failures=$((failures + 1)); }
      ;;
  esac
  expect 0 '' "$thimble" replay one.h5 --verify
done < <(grep . <<<"$table")
finish
