#!/usr/bin/env bash
# Runs one file of tests with pytest, in a separate folder.
#   pytest.sh PYTHON FILE WORK_FOLDER
set -euo pipefail
python=$1 file=$2 work=$3
"$python" -c 'import numpy, pytest' 2>/dev/null || {
  echo "NOT TESTED: the Python package; install python3-numpy and python3-pytest."
  exit 77
}
mkdir -p "$work"
cd "$work"
"$python" -B -m pytest -q -rs -p no:cacheprovider -W error::pytest.PytestUnhandledThreadExceptionWarning "$file"
