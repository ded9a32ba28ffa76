#!/usr/bin/env bash
# Makes the wheel of a build with pip, and touches from it in a virtual environment without any other file of Thimble.
# With THIMBLE_LONG it is built from the sources by `pip install .`: isolated, as pip does by default, with its build
# dependencies from Debian's wheels instead of an index.
#   wheel_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
[ -d "$build/app/python/thimble" ] || { echo "NOT TESTED: the wheel; the Python package was not built." && exit 77; }
/usr/bin/python3 -c 'import setuptools, wheel, pip, numpy, venv' 2>/dev/null || {
  echo "NOT TESTED: the wheel; install python3-pip python3-setuptools python3-wheel python3-venv python3-numpy."
  exit 77
}
# setuptools writes next to the sources, so it gets a copy.
mkdir "$work/source"
tar -C "$source" --exclude=./build --exclude=./.git -c . | tar -C "$work/source" -x
cd "$work"
/usr/bin/python3 -m venv --system-site-packages --without-pip place
wheels=/usr/share/python-wheels
isolated=
if [ -n "${THIMBLE_LONG:-}" ]; then
  if compgen -G "$wheels/setuptools-*.whl" >/dev/null && compgen -G "$wheels/wheel-*.whl" >/dev/null; then
    isolated=1
  else
    echo "NOT TESTED: an isolated pip install; install python3-setuptools-whl python3-wheel-whl."
  fi
else
  export THIMBLE_BUILD_FOLDER=$build
fi
if [ -n "$isolated" ]; then
  (cd source && PIP_NO_INDEX=1 PIP_FIND_LINKS=$wheels /usr/bin/python3 -m pip --python "$work/place" install .) >log 2>&1 ||
    fail "pip install .: $(tail -n 20 log)"
  made="pip install ."
else
  /usr/bin/python3 -m pip wheel --no-build-isolation --no-deps --no-index -w . "$work/source" >log 2>&1 ||
    fail "pip wheel: $(tail -n 20 log)"
  /usr/bin/python3 -m pip --python place install --no-deps --no-index ./thimble-*.whl >log 2>&1 ||
    fail "pip install: $(tail -n 20 log)"
  made=$(ls -- *.whl)
fi

unset THIMBLE_BUILD_FOLDER THIMBLE_PROGRAM PYTHONPATH
mkdir elsewhere && cd elsewhere
cat >touch.py <<'END'
import sys
from pathlib import Path

import thimble
import thimble.experiment
import thimble.gym

place = sys.argv[1]
for path in (thimble.__file__, thimble.gym.__file__, thimble.experiment.__file__, thimble._study.program(), *(one.path for one in thimble.scenes() + thimble.arms())):
    assert str(path).startswith(place), path
touch = thimble.run("water_balloon", seconds=3)
assert touch.end == "done" and touch.depth.max() > 1e-3, touch.summary()
print(thimble.__version__, len(touch), "ticks")
END
"$work/place/bin/python" touch.py "$work/place" >said 2>&1 || fail "touching from the wheel: $(cat said)"
grep -qx "$(sed -nE 's/^project\(thimble VERSION ([0-9.]+).*/\1/p' "$source/CMakeLists.txt") 3000 ticks" said ||
  fail "the wheel said: $(cat said)"
"$work/place/bin/thimble" run box --duration 0.1 >said 2>&1 || fail "the wheel's program: $(cat said)"
grep -qE '^Loop +100 ' said || fail "the wheel's program said: $(cat said)"
"$work/place/bin/python" -m thimble run nothing >said 2>&1 && fail "a scene that is not there was run"
grep -q water_balloon said || fail "python3 -m thimble said: $(cat said)"
echo "$made: module, program and $(ls "$work"/place/lib/python3*/site-packages/thimble/share/thimble/scenes/*.yaml | wc -l) scenes."
