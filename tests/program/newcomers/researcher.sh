#!/usr/bin/env bash
# A researcher: a study and its figures, a series over a parameter, a recording as a table, a figure.
source "$(dirname "$0")/follow.sh"

says guide/commands.md 'measures accuracy, cost, stability, friction and more, with figures and pictures'
study=box
[ -z "${THIMBLE_LONG:-}" ] || study=texture
see 'goal .*: met' thimble study $study --output study
see '"met": true' cat study/figures.json

says guide/recording.md 'It is HDF5 with a unit on every column, so Python, MATLAB and Julia open it.'
see '^Force' thimble run rubber --record rubber.h5
if has h5dump; then see 'unit' h5dump -A rubber.h5; fi
says guide/recording.md '`--verify` reports whether every force is bit-identical'
see 'bit-identical' thimble replay rubber.h5 --verify

says guide/commands.md 'prints the result as one JSON'
thimble run rubber --no-view --json >rubber.json 2>said || fail "$(cat said)"
see '^[0-9.]+$' python3 -c 'import json; print(json.load(open("rubber.json"))["arms"][0]["report"]["force_N"]["max"])'

if ! python3 -c 'import thimble' 2>/dev/null; then
  echo "  NOT TESTED: the series in Python; the package or python3-numpy is missing."
  exit 0
fi
says guide/python.md '`set` changes values of any scene.'
says guide/python.md '`run.to_pandas()` gives all columns as a DataFrame (Debian: python3-pandas), `run.plot()` force and depth as a matplotlib figure'
cat >series.py <<'END'
import importlib.util
import json
import thimble

depths = []
for stiffness in (200, 400, 800):
    run = thimble.run("rubber", set={"ball.stiffness": stiffness}, seconds=1.5)
    depths.append(run.depth.max())
assert depths[0] > depths[1] > depths[2] > 0, depths

# The guide compares runs and draws them with an own signal.
stiff = thimble.run("rubber", seconds=1.5)
soft = thimble.run("rubber", seconds=1.5, set={"ball.stiffness": 200})
assert stiff.compare(soft)["force"].max > 0
assert stiff.compare(thimble.run("rubber", seconds=1.5)).bit_identical

recording = thimble.read_recording("rubber.h5")
assert recording.complete and len(recording) == 6000, len(recording)
goals = {figure["name"]: figure for figure in json.load(open("study/figures.json"))}
assert goals, "the study has no figures"
there = importlib.util.find_spec
if there("pandas"):
    table = recording.to_pandas()
    assert len(table) == 6000 and table["depth"].max() > 0, table.columns
else:
    print("  NOT TESTED: a table; python3-pandas is missing.")
if there("h5py"):
    import h5py
    with h5py.File("rubber.h5") as file:
        assert len(file["depth"]) == 6000, list(file)
if there("matplotlib"):
    import matplotlib
    matplotlib.use("Agg")
    recording[recording.in_contact].plot().savefig("felt.png")
else:
    print("  NOT TESTED: a figure; python3-matplotlib is missing.")
END
python3 series.py || fail "the series in Python"
[ ! -e felt.png ] || see PNG head -c 4 felt.png
