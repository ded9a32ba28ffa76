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
  /usr/bin/python3 -m zipfile -e ./thimble-*.whl inside
  cp inside/*.dist-info/METADATA metadata
  requirement=numpy
  [ "$(printf '%s\n' 2.12 "$(pkg-config --modversion pybind11)" | sort -V | head -n 1)" = 2.12 ] || requirement='numpy<2'
  grep -E '^Requires-Dist: numpy' metadata | tr -d ' ()' | grep -qx "Requires-Dist:$requirement" || fail "the wheel does not require $requirement: $(grep Requires metadata)"
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

# The bundled wheel: no library of Debian besides those of every desktop Linux.
bundled="no bundled wheel: install patchelf"
if [ -z "$isolated" ] && command -v patchelf >/dev/null; then
  cd "$work"
  /usr/bin/python3 "$source/app/install/bundle_wheel.py" ./thimble-*-linux_*.whl bundled >said 2>errors || fail "bundle_wheel.py: $(cat errors)"
  [ ! -s errors ] || fail "bundle_wheel.py: $(cat errors)"                  # a library without a licence text
  wheel=$(ls bundled/*.whl)
  [[ $wheel == *-manylinux_2_[0-9]*_$(uname -m).whl ]] || fail "the bundled wheel has the name $wheel"
  /usr/bin/python3 -m venv --system-site-packages --without-pip apart
  /usr/bin/python3 -m pip --python apart install --no-deps --no-index "$wheel" >log 2>&1 || fail "pip install of the bundled wheel: $(tail -n 20 log)"
  cat >loaded.py <<'END'
import re
import sys
from pathlib import Path

import numpy

sys.path.insert(0, sys.argv[1])
from bundle_wheel import OUTSIDE


def loaded():
    return {Path(one) for one in re.findall(r"(/\S+\.so\S*)$", Path("/proc/self/maps").read_text(), re.MULTILINE)}


before = loaded()
sys.argv[1] = sys.argv[2]
exec(Path("elsewhere/touch.py").read_text())
from_system = [str(one) for one in loaded() - before if not str(one).startswith(place) and not OUTSIDE.fullmatch(one.name)]
own = [one for one in from_system if "/lib-dynload/" not in one]
assert not own, own
END
  apart/bin/python -B loaded.py "$source/app/install" "$work/apart" >said 2>&1 || fail "touching from the bundled wheel: $(cat said)"
  program=$(echo apart/lib/python3*/site-packages/thimble/bin/thimble)
  ldd "$program" | grep -E 'spdlog|hdf5|not found' | grep -v "$work/apart" && fail "the program of the bundled wheel uses Debian's libraries"
  apart/bin/thimble run box --duration 0.1 >said 2>&1 || fail "the bundled wheel's program: $(cat said)"
  bundled="$(basename "$wheel"): $(ls apart/lib/python3*/site-packages/thimble.libs | wc -l) libraries"
fi
echo "$bundled"
echo "$made: module, program and $(ls "$work"/place/lib/python3*/site-packages/thimble/share/thimble/scenes/*.yaml | wc -l) scenes."
