#!/usr/bin/env bash
# An arm that is recorded while it is identified, and its twin: output, files, exit codes.
source "$(dirname "$0")/expect.sh" "$@"
arm=$source_dir/app/arms/vintage_phantom.yaml

expect_words 0 'free.h5' \
  "$thimble" identify --device sim --arm vintage_phantom --duration 10 --places 0 --record free.h5 --output same.yaml
expect_words 0 'free.csv # identify 1000' "$thimble" export free.h5 --csv free.csv
expect 0 '' \
  "$thimble" twin free.h5 --arm vintage_phantom --min-fit 95 --output same
expect 0 '^x +99\.' "$thimble" twin free.h5 --arm vintage_phantom
expect 0 'True True True$' /usr/bin/python3 -c '
import json
figures = {one["name"]: one for one in json.load(open("same/figures.json"))}
print(*(figures["fit_" + axis]["met"] for axis in "xyz"))
assert figures["error"]["value"] < 1.1 * figures["error_of_encoders"]["value"], figures'
if command -v gnuplot >/dev/null; then
  expect_plot same/twin_motion same/twin_error same/twin_spectrum
fi
# gain ARGUMENTS...: the constant whose change reduces the error most, and its new value, if the reduction is 1 % or more.
gain() {
  "$thimble" twin "$@" | awk '!n && / % +[-0-9.]+ %$/ { ++n; print (($(NF - 3) <= -1 || $(NF - 3) >= 1) ? $1 " " $3 : "none") }'
}
expect 0 '' "$thimble" twin free.h5 --arm same.yaml
expect 0 '^none$' gain free.h5 --arm same.yaml
expect 0 '^none$' gain free.h5 --arm vintage_phantom

# An arm file with too high a mass.
sed 's/mass: 0\.075 /mass: 0.0975 /' "$arm" >heavy.yaml
expect 5 '' \
  "$thimble" twin free.h5 --arm heavy.yaml --min-fit 95 --from 2 --until 8
expect 5 'fit_x' "$thimble" twin free.h5 --arm heavy.yaml --min-fit 95 --window 0.1
# The old name of the option still works, with a warning, and is not in the help.
expect_words 5 '--fit-least --min-fit' "$thimble" twin free.h5 --arm heavy.yaml --fit-least 95 --window 0.1
expect 1 '^0$' bash -c '"$0" twin --help | grep -c fit-least' "$thimble"
expect 0 '^simulation\.tip\.mass 0\.07[45]' gain free.h5 --arm heavy.yaml --from 2 --until 8
expect 0 '^simulation\.tip\.mass ' gain free.h5 --arm heavy.yaml

expect_error 2 'polhem vintage_phantom' "$thimble" twin free.h5 --arm polhem
expect_error 2 'twin' "$thimble" twin free.h5 --arm falcon
expect_error 2 '--until 2 --from 5' "$thimble" twin free.h5 --arm vintage_phantom --from 5 --until 2
expect_error 2 '--until 5 --from 5' "$thimble" twin free.h5 --arm vintage_phantom --from 5 --until 5
expect_error 2 '# s' "$thimble" twin free.h5 --arm vintage_phantom --until 1
expect_words 2 'recording' "$thimble" twin "$arm" --arm vintage_phantom
expect_words 2 'none.h5' "$thimble" twin none.h5 --arm vintage_phantom
expect 2 '--window' "$thimble" twin free.h5 --arm vintage_phantom --window 0.001
expect 2 '--arm' "$thimble" twin free.h5
head -c 20000 free.h5 >half.h5
expect 2 'half\.h5' "$thimble" twin half.h5 --arm vintage_phantom
expect_words 2 "$arm/x" "$thimble" twin free.h5 --arm vintage_phantom --output "$arm/x"
expect_words 2 'nowhere' "$thimble" identify --device sim --arm vintage_phantom --duration 10 --places 0 \
  --record nowhere/free.h5 --output other.yaml
finish
