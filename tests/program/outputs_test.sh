#!/usr/bin/env bash
# No output destroys anything: one table has every output option of every command (`file` and `folder` below). It is refused
# before the work begins if it names an input, a file of another kind, a missing or read-only folder, or a file that another
# process writes. At the end, every output option of the program must be in the table.
source "$(dirname "$0")/expect.sh" "$@"
scenes=$source_dir/app/scenes
sed "s#^arm: .*#arm: $source_dir/app/arms/vintage_phantom.yaml#" "$scenes/box.yaml" >scene.yaml
cp "$source_dir/app/arms/vintage_phantom.yaml" arm.yaml
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n' >mesh.off
printf 't x y z\n0 0 0 0.03\n1 0 0 0.02\n' >probe.traj
"$thimble" run scene.yaml --duration 0.05 --record in.h5 >/dev/null 2>&1 || { echo "FAILED: no recording" && exit 1; }
"$thimble" identify --device sim --arm vintage_phantom --duration 10 --places 0 --record free.h5 --output free.yaml >/dev/null 2>&1 ||
  { echo "FAILED: no motion" && exit 1; }
printf 'precious\n# a, b\nname: kept\n' >precious
table=" "

# refused FILE PATTERN COMMAND...: the command exits with 2 and a matching sentence, too early for any work, and FILE is
# unchanged.
refused() {
  local file=$1 pattern=$2 before
  shift 2
  before=$(md5sum "$file" 2>&1)
  expect 2 "$pattern" timeout 20 "$@"
  checks=$((checks + 1))
  [ "$(md5sum "$file" 2>&1)" = "$before" ] && return
  echo "FAILED: $* changed $file"
  failures=$((failures + 1))
}
# with OUT COMMAND...: prints the words of the command, one per line, with OUT instead of its word OUT.
with() {
  local out=$1 word
  shift
  for word; do printf '%s\n' "${word/#OUT/$out}"; done
}
# file OPTION ENDING INPUTS COMMAND...: an option that writes a file. INPUTS: files that the command reads (words in one argument).
file() {
  local option=$1 ending=$2 inputs=$3 input link words
  shift 3
  table="$table$1:$option "
  mapfile -t words < <(with "none/out$ending" "$@")
  refused precious 'none' "$thimble" "${words[@]}"
  cp precious "kept$ending"
  mapfile -t words < <(with "kept$ending" "$@")
  refused "kept$ending" "kept$ending" "$thimble" "${words[@]}"
  for input in $inputs; do
    rm -f "soft$ending" "hard$ending"
    ln -s "$input" "soft$ending"
    ln "$input" "hard$ending"
    for link in "soft$ending" "hard$ending"; do
      mapfile -t words < <(with "$link" "$@")
      refused "$input" "$link" "$thimble" "${words[@]}"
    done
  done
  mapfile -t words < <(with "locked$ending" "$@")
  refused precious 'locked' flock "locked.thimble-part$ending" "$thimble" "${words[@]}"
  rm -f "locked.thimble-part$ending" "soft$ending" "hard$ending"
}
# folder OPTION COMMAND...: an option that writes a folder.
folder() {
  local option=$1 words
  shift
  table="$table$1:$option "
  mapfile -t words < <(with "precious" "$@")
  refused precious 'precious' "$thimble" "${words[@]}"
  mapfile -t words < <(with "/proc/none/out" "$@")
  refused precious '/proc/none' "$thimble" "${words[@]}"
  mkdir -p locked
  mapfile -t words < <(with "locked" "$@")
  refused precious 'locked' flock locked "$thimble" "${words[@]}"
  rm -rf kept
  mkdir kept
  cp precious kept/figures.json
  mapfile -t words < <(with "kept" "$@")
  refused kept/figures.json 'figures\.json|kept' "$thimble" "${words[@]}"
}
# plots OPTION COMMAND...: as folder, for a folder in which plots are drawn: their data need a subfolder.
plots() {
  local words
  folder "$@"
  rm -rf kept
  mkdir kept
  cp precious kept/data
  mapfile -t words < <(with "kept" "${@:2}")
  refused kept/data 'kept/data' "$thimble" "${words[@]}"
}

run=(run scene.yaml --duration 0.05)
file --record .h5 "scene.yaml" "${run[@]}" --record OUT
file --save-mesh .off "scene.yaml" "${run[@]}" --save-mesh OUT
plots --report "${run[@]}" --report OUT
file --csv .csv in.h5 export in.h5 --csv OUT
file --sound .wav in.h5 export in.h5 --sound OUT
folder --bag export in.h5 --bag OUT
file --record .h5 "in.h5" replay in.h5 --record OUT
file --record .h5 "in.h5" replay in.h5 --force --record OUT
file --page .html in.h5 replay in.h5 --page OUT
file --csv .csv in.h5 replay in.h5 --csv OUT
file OUT .pages mesh.off mesh page mesh.off OUT
file OUT .pages "" mesh generate OUT --triangles 5000
file --repair .off mesh.off mesh mesh.off --repair OUT
file --picture .png mesh.off mesh mesh.off --picture OUT
file --output .json mesh.off mesh mesh.off --output OUT
file --output .png scene.yaml shot scene.yaml --at 0.1 --size 64x64 --output OUT
file --animate .png scene.yaml shot scene.yaml --at 0.1 --until 0.2 --size 64x64 --animate OUT
folder --output tune scene.yaml --output OUT
folder --output bench scene.yaml --duration 1 --output OUT
plots --output twin free.h5 --arm vintage_phantom --output OUT
plots --report identify --device sim --arm vintage_phantom --duration 10 --output new.yaml --report OUT
file --record .h5 arm.yaml identify --device sim --arm arm.yaml --duration 10 --output new.yaml --record OUT
file --output .yaml arm.yaml identify --device sim --arm arm.yaml --duration 10 --output OUT
file --output .json arm.yaml hil --device sim --arm arm.yaml --output OUT
file --junit .xml arm.yaml hil --device sim --arm arm.yaml --junit OUT
file --record .h5 "scene.yaml arm.yaml" exec --device sim --scene scene.yaml --arm arm.yaml --record OUT true
file --trace .txt "" plug woodenhaptics --port 0 --trace OUT
plots --output study friction --output OUT
folder --output study gating scene.yaml --output OUT
plots --output study accuracy --no-count --output OUT
file --table .inc "" study accuracy --table OUT
plots --output study stability --arm vintage_phantom --coarse --output OUT
folder --output study trouble --arm vintage_phantom --count 10 --output OUT
file --picture .png in.h5 view in.h5 --for 1 --picture OUT
for log in scene.yaml precious in.h5 mesh.off; do
  refused $log "--log: $log|^thimble: $log: " "$thimble" "${run[@]}" --log $log
done
table="$table all:--log "
# The report of several arms has a folder per arm.
mkdir -p arms/left
cp precious arms/left/data
refused arms/left/data 'arms/left/data' "$thimble" run two_hands --duration 0.05 --report arms

# Options that take a file or folder in the manual are in the table. --firmware, --faults, --root, --signals and --scene-of are
# inputs, --save-as only creates new files, and --record of view sends a request to the run.
# Each program has a manual page of its own commands.
for program in "$thimble" "$thimble-studies" "$thimble-viewer"; do "$program" manual; done >manual
awk '/^\.SS/ { command = $2; next } /^\.TP/ { getline; option = $0; getline
    if (option ~ /\\fI(FILE|DIR)/ || /[Tt]o write$/) print (command == "" ? "all" : command), option }' manual |
  sed -E 's/\\fB|\\fR.*//g; s/\\-/-/g' >writes
checks=$((checks + 1))
while read -r command option; do
  option=${option##*,}
  case "$table" in *":$option "*) continue ;; esac
  case $option in --firmware | --faults | --root | --save-as | --signals | --scene-of) continue ;; esac
  echo "FAILED: $command $option is not in the table of this test"
  failures=$((failures + 1))
done <writes
checks=$((checks + 1))
[ "$(wc -l <writes)" -ge 25 ] || { echo "FAILED: the manual names too few outputs" && failures=$((failures + 1)); }

# Two outputs with one name, and through a link.
refused in.h5 '--csv.*--sound' "$thimble" export in.h5 --csv same --sound same
ln -sf new_name link_to_new
refused in.h5 '--csv.*--sound' "$thimble" export in.h5 --csv new_name --sound link_to_new

# Recordings are measurements: they are replaced only with --force, and links stay.
"$thimble" run scene.yaml --duration 0.05 --record once.h5 >/dev/null 2>&1
refused once.h5 'once\.h5.*--force' "$thimble" "${run[@]}" --record once.h5
expect 0 '' "$thimble" "${run[@]}" --record once.h5 --force
ln -s once.h5 linked.h5
expect 0 '' "$thimble" "${run[@]}" --record linked.h5 --force
expect 0 '' test -L linked.h5
# An HDF5 file of another program is not replaced, even with --force.
printf '\x89HDF\r\n\x1a\n of another program' >other.h5
refused other.h5 'other\.h5' "$thimble" "${run[@]}" --record other.h5 --force
# Other outputs of the same kind are replaced, and their mode is kept.
expect 0 '' "$thimble" export in.h5 --csv table.csv
chmod 640 table.csv
expect 0 '' "$thimble" export in.h5 --csv table.csv
expect 0 '^640$' stat -c %a table.csv

# Two runs at once: with one recording, and with one folder.
"$thimble" run scene.yaml --clock wall --duration 20 --no-view --record busy.h5 --report busy >busy.txt 2>&1 &
pid=$!
for _ in $(seq 500); do [ -e busy.h5 ] && break; sleep 0.02; done
expect_words 2 "busy.h5 $pid" "$thimble" "${run[@]}" --record busy.h5 --force
expect_words 2 "busy $pid" "$thimble" "${run[@]}" --report busy
# The file exists before the first tick; on a busy machine that tick comes later than the two refusals.
for _ in $(seq 100); do
  "$thimble" export busy.h5 --csv live.csv >/dev/null 2>&1 && [ "$(wc -l <live.csv)" -gt 1 ] && break
  sleep 0.1
done
kill -INT $pid
wait $pid
expect_ticks busy.h5 -ge 1

# Only their owner can read recordings, logs and black boxes, for any umask.
(umask 0 && XDG_STATE_HOME=$PWD/state "$thimble" run scene.yaml --duration 0.05 --record secret.h5 --log secret.log) >/dev/null 2>&1
(umask 0 && XDG_STATE_HOME=$PWD/state "$thimble" run scene.yaml --duration 0.05) >/dev/null 2>&1
for secret in secret.h5 secret.log state/thimble/log/thimble.log; do expect 0 '^600$' stat -c %a $secret; done

# Closed standard streams: no output gets their descriptors.
expect 0 '' bash -c 'exec 2>&-; "$0" run scene.yaml --duration 0.05 --record closed.h5 --log /dev/stderr' "$thimble"
expect_ticks closed.h5 -eq 50
for closed in '0<&-' '1>&-' '2>&-' '0<&- 1>&- 2>&-'; do
  rm -f closed.h5
  bash -c "'$thimble' run scene.yaml --duration 0.05 --record closed.h5 -vv $closed" >/dev/null 2>&1
  expect_ticks closed.h5 -eq 50
done

# Killed while it creates a recording: there is none, or one that can be opened.
unreadable=0
[ -n "${THIMBLE_LONG:-}" ] && tries=300 || tries=40
for _ in $(seq $tries); do
  rm -f killed*.h5
  "$thimble" run scene.yaml --clock wall --duration 20 --no-view --record killed.h5 >/dev/null 2>&1 &
  pid=$!
  # Until its first bytes exist, under either name.
  for _ in $(seq 2000); do [ -e killed.h5 ] || [ -e killed.thimble-part.h5 ] && break; done
  kill -9 $pid
  wait $pid 2>/dev/null
  [ -e killed.h5 ] && ! "$thimble" export killed.h5 --csv killed.csv >/dev/null 2>&1 && unreadable=$((unreadable + 1))
done
expect 0 '^0$' echo $unreadable
# The next run reuses the rest.
expect 0 '' "$thimble" "${run[@]}" --record killed.h5 --force
expect 1 '' test -e killed.thimble-part.h5

# A full or read-only disk is detected before the run; nothing remains.
cat >disks.sh <<'END'
mkdir -p full readonly
mount -t tmpfs -o size=64k tmpfs full && mount -t tmpfs -o ro tmpfs readonly || exit 77
head -c 1m /dev/zero >full/all 2>/dev/null
"$1" run scene.yaml --duration 1 --record full/run.h5; echo "full: $?"
ls full
"$1" run scene.yaml --duration 1 --report readonly/out; echo "readonly: $?"
"$1" run scene.yaml --duration 1 --save-mesh readonly/out.off; echo "readonly mesh: $?"
END
# Mounts of our own: by a user namespace, or by root where none exists (a changed root).
own_mounts=(unshare -rm)
"${own_mounts[@]}" true 2>/dev/null || own_mounts=(unshare -m --propagation unchanged)
if "${own_mounts[@]}" true 2>/dev/null; then
  "${own_mounts[@]}" bash disks.sh "$thimble" >disks.txt 2>&1
  if [ $? = 77 ]; then
    leave_out "full and read-only disks: no file system in memory may be mounted"
  else
    expect_own 0 '^full: 2$' cat disks.txt
    expect 1 '' grep -E 'part' disks.txt
    expect_own 0 '^readonly: 2$' cat disks.txt
    expect_own 0 '^readonly mesh: 2$' cat disks.txt
    expect_words 0 'Read-only' cat disks.txt
  fi
else
  leave_out "full and read-only disks: no file system may be mounted here"
fi
finish
