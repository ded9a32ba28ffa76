# Shared by the tests of the program: source it with the test's three arguments.
#   source expect.sh THIMBLE SOURCE_DIR WORK_DIR
set -u
thimble=$1
source_dir=$2
work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"
failures=0
checks=0

# expect CODE PATTERN COMMAND...: COMMAND must exit with CODE and print a line matching PATTERN (an
# extended regular expression) on standard output or error; it may never die from a signal.
expect() {
  local code=$1 pattern=$2 output status
  shift 2
  checks=$((checks + 1))
  output=$("$@" 2>&1 </dev/null)
  status=$?
  if [ "$status" != "$code" ]; then
    echo "FAILED: $* : exit code $status, expected $code"
    echo "$output" | head -20 | sed 's/^/    /'
    failures=$((failures + 1))
  elif ! grep -qE -- "$pattern" <<<"$output"; then
    echo "FAILED: $* : no line matches: $pattern"
    echo "$output" | head -20 | sed 's/^/    /'
    failures=$((failures + 1))
  fi
}

# expect_links PAGE COUNT: PAGE links COUNT files, which are there, and those that are pages are below 10 MB each. Where what pages of
# runs are made of is not installed, the page says so, and links fewer.
expect_links() {
  local page=$1 count=$2 links found=0 target
  links=$(grep -oE 'href="[^"#]+"' "$page" | sed 's/href="//; s/"$//')
  for target in $links; do
    expect 0 "^$target\$" bash -c '[ -s "$1/$2" ] && [ "$(stat -c %s "$1/$2")" -lt 10000000 ] && echo "$2"' _ "$(dirname "$page")" "$target"
    found=$((found + 1))
  done
  grep -q 'No page: .*apt install' "$page" && return
  expect 0 "^$count\$" echo "$found"
}

# expect_plot STEM...: there are STEM.png and STEM.svg, and they are what their names say.
expect_plot() {
  local stem
  for stem; do
    expect 0 'PNG' head -c 4 "$stem.png"
    expect 0 '<svg' head -c 2000 "$stem.svg"
  done
}

finish() {
  echo "$((checks - failures)) passed, $failures failed"
  [ "$failures" = 0 ] || exit 1
  [ -z "${left_out:-}" ] || exit 77
  exit 0
}

# leave_out WHAT: says that WHAT is not tested, so that the test ends as skipped; where CI is set, as failed.
leave_out() {
  echo "NOT TESTED: $1" >&2
  left_out=yes
  [ -n "${CI:-}" ] || return 0
  checks=$((checks + 1))
  failures=$((failures + 1))
}
