#!/usr/bin/env bash
# Command lines with an error: the wrong word, the expected one, the nearest known word, and where to find help.
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
export XDG_STATE_HOME=$work/state

# Commands.
expect_words 0 'thimble OPTIONS SUBCOMMAND' "$thimble"
expect 0 '^  run +[A-Z]' "$thimble"
expect_error 2 'rum run --help' "$thimble" rum elephant
expect_error 2 'friktion study friction accuracy' "$thimble" study friktion
expect_error 2 'wxyz run' "$thimble" wxyz
expect_error 2 'study friction --help' "$thimble" study
expect_error 2 'run shot view mesh' "$thimble" --quiet
# Hidden commands are not suggested.
expect 1 '' bash -c '"$0" cost-prob 2>&1 | grep "Did you mean"' "$thimble"

# Options.
expect_error 2 '--lst run --list --help' "$thimble" run --lst
expect_error 2 '--duratoin run --duration' "$thimble" run box --duratoin 3
expect_error 2 '--duratoin --duration' "$thimble" run box --duratoin=3
expect_error 2 '-duration run --duration' "$thimble" run box -duration 3
expect_error 2 '--duration run' "$thimble" --duration 3
expect_error 2 '--verbos run --verbose' "$thimble" run box --verbos
expect_error 2 '--wxyz run --help' "$thimble" run box --wxyz
expect_own 0 '^hello$' "$thimble" exec -- echo hello
expect_own 0 '^hello -- you$' "$thimble" exec --arm polhem -- echo hello -- you
expect_error 2 '--csv' "$thimble" export a.h5 --csv -
expect_words 2 'empty' "$thimble" run ''
# An unset variable of a script: an option with an empty value is an error, not ignored.
expect_error 2 '--hold-to-run empty' "$thimble" run box --no-view --duration 0.1 --hold-to-run ''
expect_error 2 '--hold-to-run empty' "$thimble" exec --hold-to-run '' -- true
expect_error 2 '--record empty' "$thimble" run box --no-view --duration 0.1 --record ''
expect_error 2 '--junit empty' "$thimble" hil --device sim --arm vintage_phantom --check reports --junit ''
expect_error 2 '--csv empty' "$thimble" export a.h5 --csv ''
expect_own 0 '^hello  you$' "$thimble" exec -- echo hello '' you
expect_error 2 '--recrod exec --record' "$thimble" exec --recrod a.h5 true
# A wrong letter gets no suggestion, the beginning of a name does.
expect_error 2 '-z run' "$thimble" run box -z
expect_error 2 '-x5 run' "$thimble" run box -x5
expect_error 2 '-o shot --output' "$thimble" shot box -o a.png
expect_error 2 'RUN run' "$thimble" RUN box
expect_error 2 '--duration 2' "$thimble" run box --duration 1 --duration 2
# An extra word for a command below `mesh` is not taken as the file of `mesh`.
expect_error 2 '"in.off" mesh generate' "$thimble" mesh generate 1000 in.off
expect 1 '' test -e 1000
expect_error 2 '"more" mesh page' "$thimble" mesh page in.off out.pages more
expect_error 2 '"in.off" mesh page' "$thimble" mesh in.off page in.off out.pages
expect 1 '' test -e out.pages
expect_error 2 '"sphere" run' "$thimble" run box sphere

# Values.
expect_error 2 '--duration 0.001 86400 three' "$thimble" run box --duration three
expect_error 2 '--duration missing run --help' "$thimble" run box --duration
expect_error 2 '--seed 0 "many"' "$thimble" run box --seed many
for seed in 7.5 0x10 -1 1e3 nan 010x; do
  expect_error 2 "--seed 0 \"$seed\"" "$thimble" run box "--seed=$seed"
done
expect 0 '' "$thimble" run box --duration 0.01 --seed 18446744073709551615
expect_error 2 '--seed 0 "18446744073709551616"' "$thimble" run box --seed 18446744073709551616
expect_error 2 '--speed # "nan"' "$thimble" run box --speed nan
expect_error 2 '--at 0 86400 "0x10"' "$thimble" shot box --at 0x10
expect_error 2 '--rate 100 50000 "5"' "$thimble" bench box --rate 5
expect_error 2 '--jobs 0 1024 "2000"' "$thimble" study trouble --arm polhem --jobs 2000
expect_error 2 '--thicken 0 "-1"' "$thimble" mesh a.off --repair b.off --thicken -1
expect_error 2 '--direction 3 2' \
  "$thimble" study stability --arm vintage_phantom --direction 1 2
expect_error 2 '--places 3 9 0 "2"' \
  "$thimble" identify --device sim --arm vintage_phantom --places 2
expect_error 2 '--clock virtual paced wall "virtul"' "$thimble" run box --clock virtul
expect_error 2 '--quality draft normal reference auto "best"' "$thimble" run box --quality best
expect_error 2 'FILE scene "scen"' "$thimble" help scen
expect_error 2 '--firmware no.bin' "$thimble" run box --firmware no.bin
expect_error 2 '--firmware folder' "$thimble" run box --firmware "$work"
expect_error 2 '--root folder nowhere' "$thimble" doctor --root nowhere
expect_error 2 'SCENE missing run --list scenes --help' "$thimble" run
expect_error 2 'FILE missing mesh --help' "$thimble" mesh
expect_error 2 '--arm missing twin --help' "$thimble" twin a.h5
expect_error 2 'export --csv --bag --sound' "$thimble" export a.h5
expect_error 2 '--save-object --save-mesh' "$thimble" run box --save-object box
expect_error 2 '--view --no-view' "$thimble" run box --view --no-view
expect_error 2 'elefant elephant' "$thimble" run elefant
expect_error 2 'vintage_fantom vintage_phantom' "$thimble" run box --arm vintage_fantom
expect_error 2 '--axis velocty velocity' "$thimble" study accuracy --axis velocty --output out
expect_error 2 'scene "stifness" stiffness' "$thimble" help scene stifness
# A key with a new name.
expect_error 2 '"grain" wavelength thimble help scene' "$thimble" help scene grain
expect_error 2 '"turning" angular_velocity thimble help scene' "$thimble" help scene turning
expect_error 2 '"swing_degrees" amplitude_degrees thimble help arm' "$thimble" help arm swing_degrees
expect_error 2 '--save-object scene "wegdes" wedges' \
  "$thimble" run box --duration 0.01 --save-mesh a.off --save-object wegdes
expect_error 2 'polhm polhem' "$thimble" plug polhm

# Requests that a command cannot fulfil.
expect_error 2 '--device sim --arm NAME' "$thimble" calibrate --device sim
for command in feel-check identify hil; do
  expect_error 2 '--device sim' "$thimble" $command --device sim
done
for hand in keyboard mouse gamepad; do
  expect_error 2 "--hand $hand window screen" "$thimble" run box --hand $hand
done

# --quiet prints errors only; without it a run prints its summary.
expect 0 . "$thimble" run box --duration 0.1
expect 0 '^0$' bash -c '"$0" run box --duration 0.1 --quiet --quality auto --record q.h5 --report q --save-mesh q.off --view 2>&1 | wc -c' "$thimble"
expect 0 '' test -s q.h5 -a -s q/report.json -a -s q.off
expect 2 '^thimble: ' "$thimble" run no_such --quiet

# A scene beyond the limits, and one that cannot be opened.
sed "s/stiffness: .*/stiffness: 20000/; s#\.\./arms#$source_dir/app/arms#" "$source_dir/app/scenes/box.yaml" >stiff.yaml
expect 5 '' "$thimble" tune stiff.yaml --output unmet
expect_json unmet/figures.json '[name=entry_face.margin].met' == false
expect_words 5 'NOT MET entry_face.margin' "$thimble" tune stiff.yaml
expect 0 '' "$thimble" tune "$source_dir/app/scenes/honey.yaml" --output tuned
expect_json tuned/figures.json '[name=rest_oscillation].met' == true
printf 'OFF\n0 0 0\n' >empty.off
cat >broken.yaml <<END
name: broken
duration: 1
arm: $source_dir/app/arms/vintage_phantom.yaml
objects: [{name: none, mesh: empty.off, stiffness: 500}]
hand: {path: [{t: 0, at: [0, 0, 0]}, {t: 1, at: [0, 0, 0]}]}
END
expect 2 '^thimble: .*empty\.off' "$thimble" tune broken.yaml

# A recording with contact cannot be used for a twin.
expect 0 '' "$thimble" run box --record touch.h5
expect_error 2 'objects recording --from --until' \
  "$thimble" twin touch.h5 --arm vintage_phantom
finish
