#!/usr/bin/env bash
# A student without an arm: a first touch, a new scene from a shipped one, a plot.
source "$(dirname "$0")/follow.sh"

says guide/index.md 'Without an arm on the desk you use a simulated one'
says guide/index.md 'thimble run elephant --report out'
says guide/index.md 'The summary lists contacts, forces and how regular the loop'
scene=water_balloon  # needs no scan
[ -z "${THIMBLE_LONG:-}" ] || scene=elephant
see '^Force +[0-9.]+ N maximum' thimble run $scene --report out
says guide/index.md 'The folder `out/` holds pictures, `report.json` and `index.html`'
see '"force_N"' cat out/report.json
! has gnuplot || see PNG head -c 4 out/path_on_mesh.png

says guide/scenes.md 'So a copy of a scene that came with Thimble runs wherever you put it'
says guide/index.md 'thimble run --list'
came=$(thimble run --list | awk '$1 == "tin_can" { print $2 }')
cp "$came" my_can.yaml
sed -i 's/^name: .*/name: my_can/; s/stiffness: 600 /stiffness: 400 /' my_can.yaml
see 'bit-identical in every run' thimble run my_can.yaml --record can.h5
says guide/scenes.md 'If the file has an error, the message names the file, the line, the'
sed 's/stiffness: 400 /stifness: 400 /' my_can.yaml >wrong.yaml
refused 'wrong\.yaml:[0-9]+: .*stifness' thimble run wrong.yaml
says guide/scenes.md 'thimble run my_ball.yaml'
awk '/^```yaml$/ { inside = 1; next } /^```/ { if (inside) exit } inside' "$DOCUMENTS/guide/scenes.md" >my_ball.yaml
see ': [1-9][0-9]* contacts?,' thimble run my_ball.yaml

# A force by a formula, on the mesh that the student drew.
says guide/index.md 'A mesh must be watertight: each edge joins two triangles.'
begin=$SECONDS
printf 'OFF\n4 4 0\n0 0 0\n60 0 0\n0 60 0\n0 0 60\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n' >my_part.off
see 'watertight|closed|no fault' thimble mesh my_part.off
says guide/effects.md 'A formula defines your own force, without C++.'
cat >my_part.yaml <<'END'
name: my_part
arm: vintage_phantom
duration: 2
objects:
  - name: part
    mesh: my_part.off
    size: 0.06
    stiffness: 500
    effects:
      - law: "-b * speed"
        direction: sliding
        parameters:
          - {name: b, value: 4, unit: N s/m, min: 0, max: 10}
hand:
  path:
    - {t: 0, at: [0, 0, 0.06]}
    - {t: 1, on: part, near: [0, 0, 0.03], press: 0.004}
    - {t: 2, on: part, near: [0.01, 0.01, 0.02], press: 0.004}
END
see ': [1-9][0-9]* contacts?,' thimble run my_part.yaml
echo "  From a mesh to its first touch: $((SECONDS - begin)) s of computing."
sed 's/speed"/speed + b"/' my_part.yaml >wrong_law.yaml
refused 'wrong_law\.yaml:[0-9]+' thimble run wrong_law.yaml

says guide/recording.md 'The table has one line per tick, in SI units. Its header names columns and units.'
see '9000 ticks of my_can' thimble export can.h5 --csv can.csv
if has gnuplot; then
  gnuplot -e "set terminal png; set output 'mine.png'; set datafile separator ','; set xlabel 'time [s]';
    plot 'can.csv' using (1e-9*column('time [ns]')):(1e3*column('depth [m]')) with lines title 'depth [mm]'" 2>said ||
    fail "gnuplot: $(cat said)"
  see PNG head -c 4 mine.png
else
  echo "  NOT TESTED: a plot of one's own, for want of gnuplot."
fi
