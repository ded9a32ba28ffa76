#!/usr/bin/env bash
# Redraws the guide's pictures with the program's own commands (needs gnuplot, ffmpeg, chromium, xvfb, xauth and python3-websockets).
#   app/guide/pictures.sh [PROGRAM]
# The three pictures accuracy_* come from `thimble study accuracy`, which takes minutes; they are kept.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${1:-build/release/app/thimble}")
pictures=$here/pages/pictures
scenes=$here/../scenes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

shot() {  # NAME SCENE [OPTION...]: a moment of a scene, 480 by 320
  "$program" shot "$scenes/$2.yaml" --output "$pictures/$1.png" --size 480x320 --no-caption "${@:3}" >/dev/null
}
figure() {  # NAME FILE: a figure that the program wrote
  cp "$2" "$pictures/$1.png"
}

# First touch, with force and depth over time.
"$program" shot "$scenes/elephant.yaml" --plots --size 720x540 --output "$pictures/first_touch.png" >/dev/null

# The example scene of scenes.md.
awk '/^```yaml$/ { inside = 1; next } /^```/ { inside = keep = 0 } inside && /^name: / { keep = $2 == "my_ball" } inside && keep' \
  "$here/pages/scenes.md" >my_ball.yaml
"$program" shot my_ball.yaml --output "$pictures/my_ball.png" --size 480x320 --no-caption >/dev/null

# Some scenes of the gallery.
for scene in elephant water_balloon tin_can two_hands dominoes clay_tablet; do
  "$program" shot "$scenes/$scene.yaml" --size 320x213 --no-caption --output "$work/card_$scene.png" >/dev/null
done
ffmpeg -loglevel error -y $(printf -- '-i card_%s.png ' elephant water_balloon tin_can two_hands dominoes clay_tablet) \
  -filter_complex 'xstack=inputs=6:layout=0_0|w0_0|w0+w0_0|0_h0|w0_h0|w0+w0_h0' -frames:v 1 "$pictures/gallery.png"

# Arms, each on the same ball.
for arm in vintage_phantom polhem falcon; do
  "$program" shot my_ball.yaml --arm "$here/../arms/$arm.yaml" --output "$pictures/arm_$arm.png" --size 320x320 --camera 35 18 0.35 --no-caption >/dev/null
done

# Effects: dents, prints that stay, moving objects.
shot effect_dent water_balloon
shot effect_clay clay
shot effect_field charges
"$program" shot "$scenes/clay_tablet.yaml" --at 5.8 --edges on --camera 25 45 --size 640x420 --no-caption --output "$pictures/clay_tablet.png" >/dev/null
"$program" study friction --output friction >/dev/null || [ $? = 5 ]
figure friction friction/overview.png
"$program" study stability --arm vintage_phantom --coarse --output stability >/dev/null || [ $? = 5 ]
figure stability_map stability/kb_map.png
figure stability_drive_train stability/drive_train.png

# Several objects, and a tip with a radius.
"$program" study world --output world >/dev/null
for name in seam block groove; do
  figure "world_$name" "world/$name.png"
done

# A recording, as a plot.
"$program" run "$scenes/tin_can.yaml" --report can >/dev/null
figure recording can/force_and_depth.png

# The page that plays a run, in a browser.
"$program" run "$scenes/water_balloon.yaml" --report balloon >/dev/null
/usr/bin/python3 "$here/../../tests/program/page_browser.py" chromium balloon/index.html "$pictures/page.png" 1 >/dev/null

# The start window with a mesh, on a virtual screen.
cp "$scenes/water_balloon.off" my_part.off
XDG_STATE_HOME=$work XDG_DATA_HOME=$work XDG_CACHE_HOME=$work xvfb-run -a -s "-screen 0 1280x800x24" \
  "$program" view --start "$work/my_part.off" --for 30 --picture start_all.png 2>/dev/null
ffmpeg -loglevel error -y -i start_all.png -filter_complex "scale=960:-1,split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none" \
  -frames:v 1 "$pictures/start_window.png"

# Two recordings and a signal in one window.
"$program" run "$scenes/rubber.yaml" --record stiff.h5 >/dev/null
sed -e 's/stiffness: 400/stiffness: 200/' -e 's/^duration: 6/duration: 5/' -e 's/press: 0.006/press: 0.012/' "$scenes/rubber.yaml" >soft.yaml
"$program" run soft.yaml --record soft.h5 >/dev/null
awk 'BEGIN { print "time, muscle [mV]"; srand(1); for (i = 0; i < 6000; ++i) { t = i / 1000; print t ", " 0.4 * (rand() - 0.5) * (0.3 + (t > 0.9 && t < 4.9)) } }' >muscle.csv
xvfb-run -a -s "-screen 0 1280x800x24" "$program" view stiff.h5 soft.h5 --signals muscle.csv --at 1.9 --for 5 \
  --picture compare_all.png 2>/dev/null
ffmpeg -loglevel error -y -i compare_all.png -filter_complex "scale=960:-1,split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none" \
  -frames:v 1 "$pictures/compare.png"

# The page of an identified arm, down to its first plot.
"$program" identify --device sim --arm woodenhaptics --known-mass 0.03 --report my_arm >/dev/null
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=900,1490 \
  --screenshot="$pictures/identify.png" "file://$work/my_arm/index.html" >/dev/null 2>&1

# The guide's own table of peers, as a plot.
awk -F'|' '/^\| 10\^[0-9]/ && NF == 7 { sub(/.*\^/, "", $2); print 10 ^ $2, $3, $4, $5, $6 }' \
  "$here/pages/compare.md" >peers.dat
gnuplot <<PLOT
set terminal pngcairo size 720,400 font "sans,11" rounded
set output "$pictures/peers.png"
set logscale xy
set xlabel "triangles"
set ylabel "one tick [ns]"
set format x "10^{%L}"
set key top left
set grid lc rgb "#dddddd"
set xrange [700:1.5e7]
plot "peers.dat" using 1:2 with linespoints pt 7 lw 2 lc rgb "#1f6f8b" title "Thimble compact, stroke", \
     "" using 1:3 with linespoints pt 6 lw 2 lc rgb "#b3541e" title "god-object over Embree, stroke", \
     "" using 1:4 with linespoints pt 7 lw 2 dt 2 lc rgb "#1f6f8b" title "Thimble compact, fast slide", \
     "" using 1:5 with linespoints pt 6 lw 2 dt 2 lc rgb "#b3541e" title "god-object over Embree, fast slide"
PLOT
ls -s "$pictures"
