#!/usr/bin/env bash
# thimble study friction: a table, a CSV, figures that meet their goals, and a picture per friction.
source "$(dirname "$0")/expect.sh" "$@"

expect 0 'bristle .* 0\.0000 +0\.00 +0 +0\.3' "$thimble" study friction --output out
expect 0 '"name": "bristle.worst_of_160_stops.force"' cat out/figures.json
expect 1 '' grep -q '"met": false' out/figures.json
expect 0 '^friction,delay_ticks,' head -1 out/friction.csv
expect 0 '^bristle,3,' cat out/friction.csv
expect 0 '^49 ' wc -l out/friction.csv
if command -v gnuplot >/dev/null; then
  expect_plot out/{naive,naive_hold,paper_direction,paper_velocity,paper_twice,stiction_point,bristle,dahl} \
    out/{lugre,karnopp,implicit_coulomb,bristle_one_count,overview}
else
  expect 0 'NO PICTURES' "$thimble" study friction --output out
fi
: >a_file
expect 2 'a_file' "$thimble" study friction --output a_file/out
expect 2 'a_file' "$thimble" study friction --output a_file
finish
