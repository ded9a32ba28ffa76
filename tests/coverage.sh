#!/usr/bin/env bash
# Prints the share of lines of each module that the tests reach, and the files with the lowest shares.
# Builds everything again with counters and runs every test: half an hour. (Debian: gcovr.)
#   tests/coverage.sh [--target NAME] [CTEST_OPTIONS...]    NAME: only this test program, to save time
set -euo pipefail
cd "$(dirname "$0")/.."
command -v gcovr >/dev/null || {
  echo "tests/coverage.sh needs gcovr: apt-get install gcovr" >&2
  exit 3
}
if [ "${1:-}" = --target ]; then
  target=$2
  shift 2
  app/setup.sh coverage "$target"
  find build/coverage -name '*.gcda' -delete
  failed=0
  "$(find build/coverage/tests -name "$target" -type f -perm -u+x)" --gtest_brief=1 "$@" || failed=1
else
  app/setup.sh coverage
  find build/coverage -name '*.gcda' -delete
  failed=0
  ctest --preset coverage "$@" || failed=1
fi
gcovr --root . --filter '(driver|device_sim|render|app)/' --exclude-throw-branches \
  --gcov-ignore-parse-errors -j 2 --csv build/coverage/lines.csv build/coverage >build/coverage/gcovr.log 2>&1 || {
  tail -n 20 build/coverage/gcovr.log >&2
  exit 1
}
awk -F, '
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  {
    lines = $column["line_total"]; reached = $column["line_covered"]
    if (lines == 0) next
    split($column["filename"], part, "/")
    module[part[1]] += lines; of_module[part[1]] += reached; all += lines; of_all += reached
    printf "%6.1f %% %5d  %s\n", 100 * reached / lines, lines - reached, $column["filename"] >"build/coverage/files.txt"
  }
  END {
    printf "%-12s %7s %7s\n", "module", "lines", "reached"
    order = split("driver device_sim render app", name, " ")
    for (i = 1; i <= order; ++i) {
      if (module[name[i]] > 0)
        printf "%-12s %7d %6.1f %%\n", name[i], module[name[i]], 100 * of_module[name[i]] / module[name[i]]
    }
    printf "%-12s %7d %6.1f %%\n", "all", all, 100 * of_all / all
  }' build/coverage/lines.csv
echo
echo "Most lines that no test reaches (share reached, lines not reached):"
sort -k3,3nr build/coverage/files.txt >build/coverage/least.txt
head -n 10 build/coverage/least.txt
exit "$failed"
