#!/usr/bin/env bash
# thimble study texture, box and world, with --long also integrators and cost (100 s): tables, figures that meet
# their goals, pictures.
source "$(dirname "$0")/expect.sh" "$@"

plots() {  # plots STEM...: they exist, if gnuplot is installed
  ! command -v gnuplot >/dev/null || expect_plot "$@"
}

expect 0 '' "$thimble" study texture --output texture
expect_json texture/figures.json '[name=sines_line_error].value' '<=' 0.1
expect 1 '' grep -q '"met": false' texture/figures.json
expect 0 '.' head -1 texture/spectra.csv
expect 0 '.' head -1 texture/lines.csv
plots texture/texture_spectra

# A plate of 2 mm and 1 N/mm lets a tip through at 1 N with contact by wedges, and never with contact by
# the entry face.
expect 0 '' "$thimble" study box --output box
expect_json box/figures.json '[name=plate_2mm_pops_at_in_wedges].value' '>=' 0.9999995
expect_json box/figures.json '[name=plate_2mm_pops_at_in_wedges].value' '<' 1.0012
expect 1 '' grep -q '"met": false' box/figures.json
expect 0 '^# x mm, z mm' head -1 box/box.csv
plots box/box

# One proxy for all objects: a seam is not felt, a block stops the tip; a ball rests in a groove.
expect 0 '^seam_together_force_error .*: met' "$thimble" study world --output world
expect 1 '' grep -q '"met": false' world/figures.json
expect_json world/figures.json '[name=seam_alone_force_error].value' '>' 3
expect_json world/figures.json '[name=block_alone_sideways].value' '<' 1e-9
for table in seam block groove; do
  expect 0 '^# tip x mm' head -1 world/$table.csv
done
plots world/seam world/block world/groove

[ -n "${THIMBLE_LONG:-}" ] || finish

expect 0 ' <= 0\.2: met' "$thimble" study integrators --output integrators
expect 1 '' grep -q '"met": false' integrators/figures.json
expect 0 '.' head -1 integrators/integrators.csv
plots integrators/integrators_membrane

# The time of a tick is printed and never checked; instructions are counted if valgrind is installed.
expect 0 ': .* [0-9.e-]+ %' "$thimble" study cost --output cost
expect 0 ': memory' cat cost/figures.json
expect 0 '.' head -1 cost/cost.csv
plots cost/cost_of_contact cost/cost_of_effects
finish
