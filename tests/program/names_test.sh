#!/usr/bin/env bash
# Scenes and arms are found by name: in the user's folder, next to the program, in XDG_DATA_DIRS, in this order and never in the
# working folder. The error of an unknown name lists the known ones.
source "$(dirname "$0")/expect.sh" "$@"
export HOME=$work/home XDG_DATA_DIRS=$work/other/share
unset XDG_DATA_HOME

# box_at FILE DURATION: the box, as a scene of this duration.
box_at() {
  mkdir -p "$(dirname "$1")"
  sed "s#\.\./arms#$source_dir/app/arms#; s/^duration:.*/duration: $2/" "$source_dir/app/scenes/box.yaml" >"$1"
}

# From a folder without scenes: those of the source, because the program is below it.
expect_run 0 .ticks == 200 "$thimble" run box --duration 0.2
expect_run 0 .ticks == 200 "$thimble" run box.yaml --duration 0.2 --arm vintage_phantom
expect 0 '^  elephant .*/elephant\.yaml$' "$thimble" run --list
expect 0 '^  vintage_phantom .*/vintage_phantom\.yaml$' "$thimble" run --list
description=$(sed -n 's/^description: *//p' "$source_dir/app/scenes/elephant.yaml")
expect 0 "${description:-none}" "$thimble" run --list
expect 0 'N/m' "$thimble" tune box
expect_words 2 'elefant scene box elephant' "$thimble" run elefant
expect_words 2 'vintage vintage_phantom' "$thimble" run box --arm vintage
expect 2 'folder/elephant' "$thimble" run folder/elephant
expect_words 2 'SCENE missing' "$thimble" run --duration 1

# Nearer folders come first: other folders of the system, the user's own.
expect_words 2 'only_there' "$thimble" run only_there
box_at other/share/thimble/scenes/only_there.yaml 0.02
expect_run 0 .ticks == 20 "$thimble" run only_there
box_at home/.local/share/thimble/scenes/only_there.yaml 0.03
expect_run 0 .ticks == 30 "$thimble" run only_there
expect 0 '^  only_there .*/home/\.local/share/thimble/scenes/only_there\.yaml$' "$thimble" run --list
mkdir -p home/.local/share/thimble/arms home/.config/thimble/arm_files
cp "$source_dir/app/arms/vintage_phantom.yaml" home/.local/share/thimble/arms/mine.yaml
cp "$source_dir/app/arms/polhem.yaml" home/.config/thimble/arm_files/checked.yaml
expect 0 '^  mine .*/home/\.local/share/thimble/arms/mine\.yaml$' "$thimble" run --list
expect 0 '^  checked .*/home/\.config/thimble/arm_files/checked\.yaml$' "$thimble" run --list
sed 's#^arm:.*#arm: mine#' "$source_dir/app/scenes/box.yaml" >by_name.yaml
expect_run 0 .ticks == 200 "$thimble" run by_name.yaml --duration 0.2
sed -i 's#^arm:.*#arm: nobody#' by_name.yaml
expect_words 2 'by_name.yaml:# arm: mine' \
  "$thimble" run by_name.yaml
expect 0 '^ok .*[^ ]*home/\.local/share/thimble ' \
  bash -c '"$0" doctor || true' "$thimble"
box_at xdg/thimble/scenes/only_there.yaml 0.04
expect_run 0 .ticks == 40 env XDG_DATA_HOME="$work/xdg" "$thimble" run only_there

# The working folder may be untrusted: its files are found by path only, never by name.
box_at app/scenes/only_there.yaml 0.05
box_at app/scenes/box.yaml 0.05
box_at scenes/box.yaml 0.05
mkdir -p app/arms arms
sed 's/force_max: .*/force_max: 99/' "$source_dir/app/arms/vintage_phantom.yaml" | tee app/arms/vintage_phantom.yaml >arms/vintage_phantom.yaml
expect_run 0 .ticks == 30 "$thimble" run only_there
expect_run 0 .ticks == 200 "$thimble" run box --duration 0.2
expect 0 "^  box +$source_dir/app/scenes/box\.yaml\$" "$thimble" run --list
expect 0 "^  vintage_phantom +$source_dir/app/arms/vintage_phantom\.yaml\$" "$thimble" run --list
expect_run 0 .ticks == 50 "$thimble" run app/scenes/only_there.yaml
box_at only_there 0.06
expect_run 0 .ticks == 30 "$thimble" run only_there
expect_run 0 .ticks == 60 "$thimble" run ./only_there
box_at box.yaml 0.07
expect_run 0 .ticks == 70 "$thimble" run box.yaml
mv only_there no_name
expect_run 0 .ticks == 60 "$thimble" run no_name
mkdir only_there  # a folder is no scene
expect_run 0 .ticks == 30 "$thimble" run only_there
rm -rf app arms scenes box.yaml

# A broken scene is listed without description, and a run reports the reason.
printf '{[' >home/.local/share/thimble/scenes/broken.yaml
expect 0 '^  broken .*/scenes/broken\.yaml$' "$thimble" run --list
expect 2 'broken\.yaml:1' "$thimble" run broken
# Without HOME, the system's list of users gives the user's folder; relative folders are ignored.
home_of_user=$(getent passwd "$(id -u)" | cut -d: -f6)
expect 0 "^ok .* $home_of_user/\.local/share/thimble[, ]" bash -c 'env -u HOME "$0" doctor || true' "$thimble"
expect 0 "^ok .* $home_of_user/\.local/share/thimble[, ]" bash -c 'HOME=here XDG_DATA_HOME=there "$0" doctor || true' "$thimble"

# A program without its files finds no name, and reports this.
mkdir -p alone && cp "$thimble" alone/thimble
(
  cd alone
  export XDG_DATA_DIRS=$work/none HOME=$work/none
  # Below the source it would find the source's files, so it is copied elsewhere.
  away=$(mktemp -d)
  cp thimble "$away/"
  cd "$away"
  expect_error 2 'SCENE box XDG_DATA_DIRS' ./thimble run box
  expect 0 . ./thimble run --list
  expect 1 '' bash -c './thimble run --list | grep -E "\.yaml"'
  rm -rf "$away"
  exit "$failures"
)
failures=$((failures + $?))
finish
