#!/usr/bin/env bash
# Builds the reference, and fails for each undocumented public member and each installed header that it
# does not name. Then a header with such a member must be detected.
#   reference_test.sh DOXYFILE SOURCE_FOLDER WORK_FOLDER
set -euo pipefail
doxyfile=$1 source=$2 work=$3
command -v doxygen >/dev/null || {
  echo "NOT TESTED: the reference of the public headers; install doxygen."
  exit 77
}
rm -rf "$work"
mkdir -p "$work"
cd "$work"
write() {  # FOLDER [SETTING...]: the warnings of doxygen if the reference is written there
  mkdir -p "$1"
  { cat "$doxyfile"; echo "OUTPUT_DIRECTORY = $1"; echo "WARN_LOGFILE = $1/warnings.txt"; printf '%s\n' "${@:2}"; } >"$1/Doxyfile"
  doxygen "$1/Doxyfile" >"$1/log" 2>&1 || { cat "$1/log" >&2; exit 1; }
}

write "$work/whole"
if [ -s whole/warnings.txt ]; then
  sort -u whole/warnings.txt >&2
  echo "FAILED: the lines above name what has no words, or wrong ones." >&2
  exit 1
fi
for page in index.html classthimble_1_1driver_1_1SafetyGate.html; do
  [ -s "whole/$page" ] || { echo "FAILED: no $page" >&2; exit 1; }
done
# Each installed header is named; those of other makers' APIs (thimble/compat) do not belong to Thimble's reference.
for header in $(cd "$source" && find driver/include device_sim/include render/include app/*/include -name '*.h' \
    -not -path '*/thimble/compat/*'); do
  grep -qF "$(basename "$header")</" whole/files.html || { echo "FAILED: $header is not in the reference" >&2; exit 1; }
done
grep -q '>THIMBLE_VERSION_AT_LEAST<' whole/version_8h.html || { echo "FAILED: no page of thimble/version.h" >&2; exit 1; }
# The include line of each page can be included by a program.
grep -rhoE '#include &lt;<a[^>]*>[^<]*' whole/*.html | sed 's/.*>//' | sort -u >included
[ "$(wc -l <included)" -gt 50 ] || { echo "FAILED: only $(wc -l <included) headers are named for #include" >&2; exit 1; }
if grep -v '^thimble/' included >&2; then
  echo "FAILED: the lines above are shown for #include, and no compiler finds them" >&2
  exit 1
fi
grep -qx 'thimble/session/session.h' included || { echo "FAILED: no page says #include <thimble/session/session.h>" >&2; exit 1; }
grep -q 'Force requested by the force law' whole/structthimble_1_1driver_1_1TickRecord.html || { echo "FAILED: an empty page" >&2; exit 1; }

cat >wordless.h <<'EOF'
#pragma once
/// Is a thing.
struct Thing {
  double told = 0;    ///< m
  double untold = 0;
};
EOF
write "$work/gap" "INPUT = $work/wordless.h" "USE_MDFILE_AS_MAINPAGE ="
grep -q 'untold.*not documented' gap/warnings.txt && ! grep -q ' told' gap/warnings.txt || {
  echo "FAILED: a member without a word was not found" >&2
  exit 1
}
echo "$(find whole -name '*.html' | wc -l) pages without a gap."
