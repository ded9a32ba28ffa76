#!/usr/bin/env bash
# The page that plays a touch, in a real browser: it plays, scrubs, shows the recorded forces, prints nothing on the console
# and makes no requests. Without Chromium only its files are checked, and the test counts as skipped; if
# CI is set in the environment, as on CI services, a missing tool is a failure.
source "$(dirname "$0")/expect.sh" "$@"
here=$source_dir/tests/program
scenes=$source_dir/app/scenes

# Without its libraries there is no page; the run and its report continue.
expect_words 0 'none/index.html apt install libjs-three libjs-dygraphs' \
  env XDG_DATA_DIRS=/nowhere "$thimble" run "$scenes/box.yaml" --duration 0.5 --report none
expect_json none/report.json .ticks == 500
expect 1 '' test -e none/index.html
expect 0 '' "$thimble" run "$scenes/box.yaml" --duration 0.5 --record box.h5
expect_words 1 'box.html apt install' env XDG_DATA_DIRS=/nowhere "$thimble" replay box.h5 --page box.html
expect 1 '' test -e box.html

# leave_out WHAT PACKAGES: ends the test here with a message.
leave_out() {
  echo "NOT TESTED: $1; install $2."
  if [ -n "${CI:-}" ]; then
    echo "FAILED: CI is set, and there nothing may be left out"
    failures=$((failures + 1))
  fi
  [ "$failures" = 0 ] && exit 77
  finish
}
dpkg-query -W -f='${db:Status-Status}\n' libjs-three libjs-dygraphs 2>/dev/null | grep -c '^installed$' >there
[ "$(cat there)" = 2 ] || leave_out "the page that plays a touch" "libjs-three libjs-dygraphs"

# A run and its recording: a floating body, and clay that keeps its print.
expect_words 0 'float/index.html' \
  "$thimble" run "$scenes/floating_block.yaml" --report float --record float.h5
expect_words 0 'float.html' "$thimble" replay float.h5 --page float.html
expect_words 0 'clay/index.html' "$thimble" run "$scenes/clay.yaml" --report clay --record clay.h5
expect_words 0 'tissue/index.html' "$thimble" run "$scenes/tissue.yaml" --report tissue --record tissue.h5
expect_words 0 'two/index.html' "$thimble" run "$scenes/two_hands.yaml" --report two
expect 0 '^MIT|Permission ' cat float/index.html
expect 0 '^thimble: .*--page' bash -c '"$0" replay "$1" --page x.html --scene box; [ $? = 2 ]' "$thimble" "$scenes/box.yaml"

# A minute at 1 kHz is below 10 MB, with the largest shipped scan.
scene=water_balloon
[ -f "${THIMBLE_MESHES:-}/elephant.off" ] && scene=elephant
expect 0 '' "$thimble" run "$scenes/$scene.yaml" --duration 60 --report minute
expect 0 '^[0-9]{6,7}$' stat -c %s minute/index.html

# The gallery: a page and a thumbnail for each scene, each page below 3 MB; a scene that does not run is an error.
expect_words 0 'scenes gallery/index.html' bash "$source_dir/app/guide/gallery.sh" "$thimble" gallery tin_can clay_tablet two_hands
expect_links gallery/index.html 3
expect 0 '^[12][0-9]{6}$' bash -c 'stat -c %s gallery/tin_can.html'
expect 0 '' test -s gallery/tin_can.png
expect_words 1 'gallery.sh nonesuch' bash "$source_dir/app/guide/gallery.sh" "$thimble" gallery nonesuch

if ! command -v chromium >/dev/null || ! /usr/bin/python3 -c 'import websockets' 2>/dev/null; then
  leave_out "the page in a real browser" "chromium python3-websockets"
fi

# browse PAGE RECORDING TIME...: drives the page, and compares its forces with the recorded ticks.
browse() {
  local page=$1 recording=$2
  shift 2
  "$thimble" export "$recording" --csv ticks.csv >/dev/null
  /usr/bin/python3 "$here/page_browser.py" "$(command -v chromium)" "$page" "${page%.html}.png" "$@" >found.json || {
    echo "FAILED: the browser did not get through $page"
    failures=$((failures + 1))
    return
  }
  expect 0 '^as it should be$' /usr/bin/python3 "$here/page_check.py" found.json ticks.csv "$@"
}
browse float/index.html float.h5 0.8005 3.6004 5.8006
browse float.html float.h5 0.8005 3.6004 5.8006
browse clay/index.html clay.h5 0.9003 1.8001 3.6008
# A map of stiffness colours the surface, with its range.
browse tissue/index.html tissue.h5 1.8002 2.6004 5.0003
expect 0 'pad: stiffness.*250.*800 N/m' cat found.json
# Layout and colours: all on one screen of a laptop, one time axis, a timeline on a phone, light and dark, readable values.
expect 0 '^as it should be$' /usr/bin/python3 "$here/page_layout.py" "$(command -v chromium)" two/index.html layout
# The appearance; after an intended change THIMBLE_WRITE_SHOTS=1 stores the new pictures.
kept() {
  local stored=$source_dir/tests/data/shots/$1.png
  [ -z "${THIMBLE_WRITE_SHOTS:-}" ] || cp "$2" "$stored"
  expect 0 '^the same' /usr/bin/python3 "$here/picture_near.py" "$stored" "$2"
}
kept page_float float/index_small.png
kept page_clay clay/index_small.png
kept page_tissue tissue/index_small.png

# serve RUN: serves the run's page; sets $address, its address, and $viewer, the serving process.
serve() {
  timeout 300 "$thimble" view "$1" --web >view.txt 2>&1 &
  viewer=$!
  for _ in $(seq 300); do grep -q '^Watching' view.txt && break; sleep 0.1; done
  address=$(sed -n 's/^Open //p' view.txt)
}

# The live appearance: a run that is paused at a fixed tick.
"$thimble" run "$scenes/tin_can.yaml" --clock paced --speed 4 --duration 60 --name "stands_$$" --no-view >stands.txt 2>&1 &
run=$!
for _ in $(seq 300); do "$thimble" view "stands_$$" --pause >/dev/null 2>&1 && break; sleep 0.1; done
ticks() { timeout 60 "$thimble" view "stands_$$" --text --for 0.2 | grep ' paused: ' | grep -oE '[0-9]+ ticks' | tail -1; }
for _ in $(seq 100); do at=$(ticks) && [ -n "$at" ] && break; sleep 0.1; done
expect 0 '' "$thimble" view "stands_$$" --step $((7500 - ${at% ticks}))
for _ in $(seq 300); do [ "$(ticks)" = '7500 ticks' ] && break; sleep 0.1; done
expect_own 0 '^7500 ticks$' ticks
serve "stands_$$"
expect 0 '' /usr/bin/python3 "$here/live_page_browser.py" "$(command -v chromium)" "$address" live_small.png
kept page_live live_small.png
expect 0 '#theme=dark$' "$thimble" view "stands_$$" --web --theme dark --for 0.5
expect 0 '' "$thimble" view "stands_$$" --stop
wait "$run" "$viewer"

# The live page: it steers the run, follows it, pauses, ends with it, and its forces are ticks of the run.
# The hand stays in the clay, so that there is a force however slow the browser is. It sways there, because an
# arm that does not move for long looks like a faulty one.
sed "/t: 8.0/d; s#arm: .*#arm: vintage_phantom#; s#clay_ball.off#$scenes/clay_ball.off#" "$scenes/clay.yaml" >pressed.yaml
for second in $(seq 9 2 299); do
  echo "    - {t: $second.0, on: ball, near: [$((second / 2 % 2 * 4 + 6)).0e-3, 0.01, 0.0], press: 0.006}" >>pressed.yaml
done
"$thimble" run pressed.yaml --clock wall --duration 300 --name "page_$$" --no-view --record live.h5 >run.txt 2>&1 &
run=$!
serve "page_$$"
expect 0 '^http://127\.0\.0\.1:[0-9]+/\?token=[0-9a-f]{32}$' echo "$address"
if /usr/bin/python3 "$here/live_page_browser.py" "$(command -v chromium)" "$address" live.png \
  "$thimble" view "page_$$" --stop >live.json; then
  wait "$run"
  "$thimble" export live-2.h5 --csv live.csv >/dev/null
  expect 0 '^as it should be$' /usr/bin/python3 "$here/live_page_check.py" live.json live.csv "$address"
else
  echo "FAILED: the browser did not get through the live page"
  failures=$((failures + 1))
  kill -INT "$run"
fi
wait "$viewer"
expect 0 '^0$' echo $?
finish
