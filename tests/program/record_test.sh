#!/usr/bin/env bash
# Every tick is recorded, even if the program is killed, and the last seconds before a fault always.
source "$(dirname "$0")/expect.sh" "$@"
[ -f "$THIMBLE_MESHES/elephant.off" ] || { echo "Needs the scanned meshes"; exit 77; }
scene=$source_dir/app/scenes/elephant.yaml
export XDG_STATE_HOME=$PWD/state
rm -rf state

expect 0 '' "$thimble" run "$scene" --duration 2 --record run.h5
expect_words 0 'run.csv 2000 elephant 1000' "$thimble" export run.h5 --csv run.csv
expect 0 'p_WT.x \[m\],p_WT.y \[m\]' head -1 run.csv
expect 0 '^2001$' grep -c '' run.csv

# The recorded hand touches again: the same scene gives bit-identical forces, another one does not.
names="elephant tin_can honey"
[ -e "$(dirname "$thimble")/thimble-bodies.so" ] && names+=" dominoes cans" # several bodies that move
for name in $names; do
  expect 0 '' "$thimble" run "$source_dir/app/scenes/$name.yaml" --duration 3 --record again.h5 --force
  expect_ticks again.h5 -eq 3000
  expect_words 0 "again.h5 3000 $name" "$thimble" replay again.h5 --verify
done
sed "s/stiffness: 800/stiffness: 700/; s#\.\./arms#$source_dir/app/arms#" "$scene" >softer.yaml
expect 0 '' "$thimble" replay run.h5 --scene softer.yaml --record softer.h5
expect_words 0 'softer.csv 2000 elephant' "$thimble" export softer.h5 --csv softer.csv
# The requested force differs in some ticks.
wanted() { awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^f_wanted_W/) at[++n] = i; next } { print $at[1], $at[2], $at[3] }' "$1"; }
expect 0 '^[1-9]' bash -c "$(declare -f wanted); diff <(wanted run.csv) <(wanted softer.csv) | wc -l"
expect_error 2 'softer.yaml' "$thimble" replay run.h5 --scene softer.yaml --verify

# A changed file of the scene is found by its contents, and named.
mkdir -p tissue
cp "$source_dir"/app/scenes/tissue* tissue/
expect 0 '' "$thimble" run tissue/tissue.yaml --duration 1 --record tissue.h5
touch tissue/tissue.obj
expect_words 0 'tissue.h5 1000' "$thimble" replay tissue.h5 --verify
for changed in tissue_lumps.png tissue_ribs.png tissue.obj; do
  cp tissue/$changed good
  case $changed in
    *.png) cp tissue/tissue_$([ $changed = tissue_lumps.png ] && echo ribs || echo lumps).png tissue/$changed ;;
    *) sed -i '1i # another first line' tissue/$changed ;;
  esac
  expect_error 2 "--verify tissue/$changed" "$thimble" replay tissue.h5 --verify
  cp good tissue/$changed
done
# The files may be moved together.
mv tissue moved
expect_words 0 'tissue.h5 1000' "$thimble" replay tissue.h5 --scene moved/tissue.yaml --verify

# A trajectory from another program touches a scene, and its forces are compared.
printf 't x y z fx fy fz\n0 0 0 20 0 0 0\n1 0 0 5 0 0 1\n2 10 0 5 0 0 1\n' >probe.traj
rubber=$source_dir/app/scenes/rubber.yaml
expect_words 0 'Force N # direction' "$thimble" replay probe.traj --scene "$rubber" \
  --length mm --columns 't x y z fx fy fz' --record probe.h5
expect_words 0 'probe.csv 2001 rubber' "$thimble" export probe.h5 --csv probe.csv
expect_words 0 'elephant # ' "$thimble" replay probe.traj --scene "$scene" --frame elephant
expect_words 2 '--scene' "$thimble" replay probe.traj
expect_words 2 'probe.traj line 2' "$thimble" replay probe.traj --scene "$rubber"
expect_words 2 'scene "mouse"' "$thimble" replay probe.traj --scene "$rubber" --frame mouse

# A disk that refuses writes.
expect 2 'no/such/folder' "$thimble" run "$scene" --duration 1 --record no/such/folder/run.h5
expect_words 2 'recording' "$thimble" export "$scene" --csv x.csv
expect_words 2 'none.h5' "$thimble" export none.h5 --csv x.csv

# Killed in the middle, the recording can still be read.
"$thimble" run "$scene" --clock wall --duration 60 --record killed.h5 >/dev/null 2>&1 &
pid=$!
sleep 2
kill -9 $pid
wait $pid 2>/dev/null
expect_words 0 'killed.csv # elephant 1000 recording cut' \
  "$thimble" export killed.h5 --csv killed.csv

# A stalled loop is a fault: the seconds before it are always saved.
"$thimble" run "$scene" --clock wall --duration 60 >stalled 2>&1 &
pid=$!
sleep 2
kill -STOP $pid
sleep 0.5
kill -CONT $pid
wait $pid
expect 0 '[^ ]*loop_stalled\.h5' cat stalled
expect_words 0 'fault.csv # elephant' "$thimble" export state/thimble/faults/*loop_stalled.h5 --csv fault.csv
finish
