#!/usr/bin/env bash
# A run that restarts continues with its last good scene while the scene or a picture is spoiled, and ends with an error if a
# mesh is.
source "$(dirname "$0")/expect.sh" "$@"
export XDG_STATE_HOME=$work/state
unset DISPLAY WAYLAND_DISPLAY

# wait_for COMMAND...: waits until COMMAND succeeds; fails if the run ends first, or after 60 s.
wait_for() {
  checks=$((checks + 1))
  for _ in $(seq 600); do
    "$@" && return
    kill -0 $pid 2>/dev/null || break
    sleep 0.1
  done
  output=$(cat out)
  fail_check "the run ended, or 60 s passed, before: $*"
}
another_recording() { [ "$(ls run*.h5 | wc -l)" -gt "$recordings" ]; }
restarts() { # waits for a restart of the run
  recordings=$(ls run*.h5 | wc -l)
  wait_for another_recording
}

cp "$source_dir"/app/scenes/tissue* .
sed -i 's/^duration:.*/duration: 0.4/' tissue.yaml
# Options of `run`, and the files that it spoils.
for clock in paced wall; do
  for spoiled in tissue.yaml tissue_lumps.png tissue.obj; do
    rm -f run*.h5
    cp $spoiled good
    "$thimble" run tissue.yaml --clock $clock --loop --reload --record run.h5 --name loop$$ >out 2>&1 </dev/null &
    pid=$!
    wait_for test -e run-2.h5
    echo spoiled >$spoiled
    wait_for grep -q "^thimble: .*$spoiled" out
    if [ $spoiled = tissue.obj ]; then # a mesh is read again for each run, so the loop ends
      wait $pid
      status=$?
      expect 0 '^2$' echo $status
      cp good $spoiled
      continue
    fi
    restarts
    restarts
    # Reported once.
    expect 0 "^1$" grep -c "^thimble: .*$spoiled" out
    cp good $spoiled
    restarts
    kill -INT $pid
    wait $pid
    status=$?
    expect 0 '^130$' echo $status
    last=$(ls -t run*.h5 | head -1)
    ends_with 0 "$thimble" replay "$last" --verify
  done
done
finish
