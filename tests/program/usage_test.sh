#!/usr/bin/env bash
# Command lines with a mistake: the wrong word, what was expected, the nearest known word, and where to read on.
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
export XDG_STATE_HOME=$work/state

# Commands.
expect 0 '^Usage: thimble' "$thimble"
expect 0 '^  run +Touch a scene' "$thimble"
expect 2 '^thimble: rum is no command of `thimble`\. Did you mean run\? Known: run, .*See `thimble --help`\.$' "$thimble" rum elephant
expect 2 '^thimble: friktion is no command of `thimble study`\. Did you mean friction\?.*accuracy' "$thimble" study friktion
expect 2 '^thimble: wxyz is no command of `thimble`\. Known: run' "$thimble" wxyz
expect 2 '^thimble: `thimble study` needs a command behind it: .*friction.*See `thimble study --help`\.$' "$thimble" study
expect 2 '^thimble: `thimble` needs a command behind it: run, ' "$thimble" --quiet
# Hidden commands are not suggested.
expect 1 '' bash -c '"$0" cost-prob 2>&1 | grep "Did you mean"' "$thimble"

# Options.
expect 2 '^thimble: --lst is no option of `thimble run`\. Did you mean --list\? See `thimble run --help`\.$' "$thimble" run --lst
expect 2 '^thimble: --duratoin is no option of `thimble run`\. Did you mean --duration\?' "$thimble" run box --duratoin 3
expect 2 '^thimble: --duratoin is no option of .* Did you mean --duration\?' "$thimble" run box --duratoin=3
expect 2 '^thimble: -duration is no option of `thimble run`\. Did you mean --duration\?' "$thimble" run box -duration 3
expect 2 '^thimble: --duration is an option of .*`thimble run`.*, not of `thimble`; write it behind the command' "$thimble" --duration 3
expect 2 '^thimble: --verbos is no option of `thimble run`\. Did you mean --verbose\?' "$thimble" run box --verbos
expect 2 '^thimble: --wxyz is no option of `thimble run`\. See `thimble run --help`\.$' "$thimble" run box --wxyz
expect 0 '^hello$' "$thimble" exec -- echo hello
expect 0 '^hello -- you$' "$thimble" exec --arm polhem -- echo hello -- you
expect 2 '^thimble: --csv: .*standard output' "$thimble" export a.h5 --csv -
expect 2 'name is empty' "$thimble" run ''
# A variable of a script that is not set: no option does as if it were not there.
expect 2 '^thimble: --hold-to-run: its value is empty' "$thimble" run box --no-view --duration 0.1 --hold-to-run ''
expect 2 '^thimble: --hold-to-run: its value is empty' "$thimble" exec --hold-to-run '' -- true
expect 2 '^thimble: --record: its value is empty' "$thimble" run box --no-view --duration 0.1 --record ''
expect 2 '^thimble: --junit: its value is empty' "$thimble" hil --device sim --arm vintage_phantom --check reports --junit ''
expect 2 '^thimble: --csv: its value is empty' "$thimble" export a.h5 --csv ''
expect 0 '^hello  you$' "$thimble" exec -- echo hello '' you
expect 2 '^thimble: --recrod is no option of `thimble exec`\. Did you mean --record\?' "$thimble" exec --recrod a.h5 true
# A wrong letter is like every other letter; the beginning of a name is not.
expect 2 '^thimble: -z is no option of `thimble run`\. See' "$thimble" run box -z
expect 2 '^thimble: -x5 is no option of `thimble run`\. See' "$thimble" run box -x5
expect 2 '^thimble: -o is no option of `thimble shot`\. Did you mean --out\?' "$thimble" shot box -o a.png
expect 2 '^thimble: RUN is no command of `thimble`\. Did you mean run\?' "$thimble" RUN box
expect 2 '^thimble: --duration: given 2 times; give it once\. See' "$thimble" run box --duration 1 --duration 2
# A word too many for a command below `mesh` is not the file of `mesh`.
expect 2 '^thimble: "in\.off" is one argument too many for `thimble mesh generate`' "$thimble" mesh generate 1000 in.off
expect 1 '' test -e 1000
expect 2 '^thimble: "more" is one argument too many for `thimble mesh page`' "$thimble" mesh page in.off out.pages more
expect 2 '^thimble: "in\.off" is one argument too many for `thimble mesh page`' "$thimble" mesh in.off page in.off out.pages
expect 1 '' test -e out.pages
expect 2 '^thimble: "sphere" is one argument too many for `thimble run`' "$thimble" run box sphere

# Values.
expect 2 '^thimble: --duration: expected 0\.001 to 86400 seconds, found three\.$' "$thimble" run box --duration three
expect 2 '^thimble: --duration: its value is missing; expected a number\. See `thimble run --help`\.$' "$thimble" run box --duration
expect 2 '^thimble: --seed: expected a whole number of 0 or more, found "many"\.$' "$thimble" run box --seed many
for seed in 7.5 0x10 -1 1e3 nan 010x; do
  expect 2 "^thimble: --seed: expected a whole number of 0 or more, found \"$seed\"\\.\$" "$thimble" run box "--seed=$seed"
done
expect 0 '' "$thimble" run box --duration 0.01 --seed 18446744073709551615
expect 2 '^thimble: --seed: expected a whole number of 0 or more, found "18446744073709551616"' "$thimble" run box --seed 18446744073709551616
expect 2 '^thimble: --speed: expected a number from [0-9.]+ to [0-9.]+, found "nan"\.$' "$thimble" run box --speed nan
expect 2 '^thimble: --at: expected a number from 0 to 86400, found "0x10"\.$' "$thimble" shot box --at 0x10
expect 2 '^thimble: --rate: expected a number from 100 to 50000, found "5"\.$' "$thimble" bench box --rate 5
expect 2 '^thimble: --jobs: expected a whole number from 0 to 1024, found "2000"\.$' "$thimble" study trouble --arm polhem --jobs 2000
expect 2 '^thimble: --thicken: expected a number above 0, found "-1"\.$' "$thimble" mesh a.off --repair b.off --thicken -1
expect 2 '^thimble: --direction: expected 3 values, found 2\. See' \
  "$thimble" study stability --arm vintage_phantom --direction 1 2
expect 2 '^thimble: --places: expected a whole number from 3 to 9 or 0, found "2"\.$' \
  "$thimble" identify --device sim --arm vintage_phantom --places 2
expect 2 '^thimble: --clock: expected virtual, paced or wall, found "virtul"\. Did you mean virtual\?$' "$thimble" run box --clock virtul
expect 2 '^thimble: --quality: expected draft, normal, reference or auto, found "best"\.$' "$thimble" run box --quality best
expect 2 '^thimble: FILE: expected scene or arm, found "scen"\. Did you mean scene\?$' "$thimble" help scen
expect 2 '^thimble: --firmware: there is no file no\.bin\.$' "$thimble" run box --firmware no.bin
expect 2 '^thimble: --firmware: .* is a folder; name a file\.$' "$thimble" run box --firmware "$work"
expect 2 '^thimble: --root: there is no folder nowhere\.$' "$thimble" doctor --root nowhere
expect 2 '^thimble: SCENE is missing\. `thimble run --list` lists the scenes\. See `thimble run --help`\.$' "$thimble" run
expect 2 '^thimble: FILE is missing\. See `thimble mesh --help`\.$' "$thimble" mesh
expect 2 '^thimble: --arm is missing\. See `thimble twin --help`\.$' "$thimble" twin a.h5
expect 2 '^thimble: `thimble export` needs --csv, --bag or --sound\. See' "$thimble" export a.h5
expect 2 '^thimble: --save-object needs --save-mesh: add it\.' "$thimble" run box --save-object box
expect 2 '^thimble: --(no-)?view and --(no-)?view do not go together; remove one of them\.' "$thimble" run box --view --no-view
expect 2 '^thimble: .*elefant: there is no such file, .*Did you mean elephant\?' "$thimble" run elefant
expect 2 '^thimble: .*vintage_fantom: .*Did you mean vintage_phantom\?' "$thimble" run box --arm vintage_fantom
expect 2 '^thimble: --axis: velocty is no axis; did you mean velocity\?' "$thimble" study accuracy --axis velocty --out out
expect 2 '^thimble: No key of scene files is called "stifness".* Did you mean stiffness\?' "$thimble" help scene stifness
expect 2 '^thimble: --save-object: the scene has no object "wegdes"\. Did you mean wedges\?' \
  "$thimble" run box --duration 0.01 --save-mesh a.off --save-object wegdes
expect 2 '^thimble: .*polhm.* Did you mean polhem\?' "$thimble" plug polhm

# What one command is asked in vain.
expect 2 '^thimble: --device sim needs to know which arm to simulate: add --arm NAME' "$thimble" calibrate --device sim
for command in feel-check identify hil; do
  expect 2 '^thimble: --device sim needs to know which arm to simulate' "$thimble" $command --device sim
done
for hand in keyboard mouse gamepad; do
  expect 2 "^thimble: --hand $hand needs the window, and there is no screen" "$thimble" run box --hand $hand
done

# --quiet prints errors only, and a run says what it has to say without.
expect 0 '^Loop' "$thimble" run box --duration 0.1
expect 0 '^0$' bash -c '"$0" run box --duration 0.1 --quiet --quality auto --record q.h5 --report q --save-mesh q.off --view 2>&1 | wc -c' "$thimble"
expect 0 '' test -s q.h5 -a -s q/report.json -a -s q.off
expect 2 '^thimble: ' "$thimble" run no_such --quiet

# A scene that asks for too much, and one that cannot be opened.
sed "s/stiffness: .*/stiffness: 20000/; s#\.\./arms#$source_dir/app/arms#" "$source_dir/app/scenes/box.yaml" >stiff.yaml
expect 5 '^NOT MET: .*margin' "$thimble" tune stiff.yaml
expect 0 'rest_oscillation .*: met' "$thimble" tune "$source_dir/app/scenes/honey.yaml"
printf 'OFF\n0 0 0\n' >empty.off
cat >broken.yaml <<END
name: broken
duration: 1
arm: $source_dir/app/arms/vintage_phantom.yaml
objects: [{name: none, mesh: empty.off, stiffness: 500}]
hand: {path: [{t: 0, at: [0, 0, 0]}, {t: 1, at: [0, 0, 0]}]}
END
expect 2 '^thimble: .*empty\.off' "$thimble" tune broken.yaml

# The twin of an arm that touched something is none.
expect 0 'Recording' "$thimble" run box --record touch.h5
expect 2 '^thimble: The tip touches objects between .* s of the recording.*--from and --until' \
  "$thimble" twin touch.h5 --arm vintage_phantom
finish
