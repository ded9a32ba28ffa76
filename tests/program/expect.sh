# Shared by the tests of the program: source it with the test's three arguments.
#   source expect.sh THIMBLE SOURCE_DIR WORK_DIR
set -u
thimble=$1
source_dir=$2
work=$3
# With the arguments in another order, this would remove the sources.
if [ -e "$work/.git" ] || [ -e "$work/CMakeLists.txt" ]; then
  echo "expect.sh: $work is not a folder for a test's files; the arguments are THIMBLE SOURCE_DIR WORK_DIR" >&2
  exit 2
fi
rm -rf "$work"
mkdir -p "$work"
cd "$work"
failures=0
checks=0

# fail_check MESSAGE: counts a failed check, and prints the output.
fail_check() {
  echo "FAILED: $1"
  [ -z "${output:-}" ] || head -20 <<<"$output" | sed 's/^/    /'
  failures=$((failures + 1))
}

# ends_with CODE COMMAND...: runs COMMAND, keeps its standard output and error in output, and returns whether its exit
# code is CODE.
ends_with() {
  local code=$1 status
  shift
  checks=$((checks + 1))
  output=$("$@" 2>&1 </dev/null)
  status=$?
  [ "$status" = "$code" ] && return
  fail_check "$* : exit code $status, expected $code"
  return 1
}

# expect CODE PATTERN COMMAND...: COMMAND must exit with CODE and print a line that matches PATTERN (an
# extended regular expression) on standard output or error; it may never die from a signal. For files and structured output;
# arch.prose counts patterns that are wording of the program.
expect() {
  local code=$1 pattern=$2
  shift 2
  ends_with "$code" "$@" || return
  grep -qE -- "$pattern" <<<"$output" || fail_check "$* : no line matches: $pattern"
}

# expect_own CODE PATTERN COMMAND...: the same for output of the tests' own programs.
expect_own() { expect "$@"; }

# line_with WORDS: the Perl regular expression of a line that has each of the blank-separated WORDS.
line_with() {
  local words word pattern=^
  read -ra words <<<"$1"
  for word in "${words[@]}"; do
    word="\\Q${word//'#'/\\E[0-9]+(?:\\.[0-9]+)?\\Q}\\E"
    pattern+="(?=.*(?<![A-Za-z0-9_])(?<![0-9]\\.)$word(?![A-Za-z0-9_])(?!\\.[0-9])(?!-[A-Za-z]))"
  done
  echo "$pattern"
}

# expect_words CODE WORDS COMMAND...: COMMAND must exit with CODE and print a line with each of the blank-separated WORDS, whole
# and in any order; # in a word means a number. For messages: names of options, commands, files, keys and packages, line
# numbers, values and limits, never the sentence around them.
expect_words() {
  local code=$1 words=$2
  shift 2
  ends_with "$code" "$@" || return
  LC_ALL=C grep -qaP -- "$(line_with "$words")" <<<"$output" || fail_check "$* : no line has: $words"
}

# expect_error CODE WORDS COMMAND...: the same for the line of an error, which begins with "thimble: ".
expect_error() {
  local code=$1 words=$2
  shift 2
  ends_with "$code" "$@" || return
  grep -a '^thimble: ' <<<"$output" | LC_ALL=C grep -qaP -- "$(line_with "$words")" || fail_check "$* : no error has: $words"
}

# expect_json FILE PATH OPERATOR VALUE: the value in a JSON file; see json_value.py.
expect_json() {
  checks=$((checks + 1))
  output=$(/usr/bin/python3 "$source_dir/tests/program/json_value.py" "$@" 2>&1) || fail_check "expect_json $*"
}

# expect_ticks RECORDING OPERATOR COUNT: a recording can be exported, and OPERATOR holds for its ticks and COUNT (-eq, -ge).
expect_ticks() {
  ends_with 0 "$thimble" export "$1" --csv "$work/ticks_of.csv" || return
  local ticks
  ticks=$(grep -c '^[0-9]' "$work/ticks_of.csv")
  rm -f "$work/ticks_of.csv"
  [ "$ticks" "$2" "$3" ] || fail_check "$1 holds $ticks ticks, expected $2 $3"
}

# expect_run CODE PATH OPERATOR VALUE COMMAND...: COMMAND, `thimble run` of a scene, exits with CODE, and its report.json, which
# stays in run_report, has such a value. No pictures are drawn.
expect_run() {
  local code=$1 path=$2 operator=$3 value=$4
  shift 4
  mkdir -p "$work/quick"
  printf '#!/bin/sh\ntouch mesh.png\n' >"$work/quick/gnuplot"
  chmod +x "$work/quick/gnuplot"
  rm -rf run_report
  local -x PATH=$work/quick:$PATH
  ends_with "$code" "$@" --report run_report && expect_json run_report/report.json "$path" "$operator" "$value"
}

# expect_links PAGE COUNT: PAGE links COUNT existing files, and each page among them is below 10 MB. Without the libraries for
# pages of runs, the page says so and links fewer.
expect_links() {
  local page=$1 count=$2 links found=0 target
  links=$(grep -oE 'href="[^"#]+"' "$page" | sed 's/href="//; s/"$//' | grep -v '^data:')
  for target in $links; do
    expect 0 "^$target\$" bash -c '[ -s "$1/$2" ] && [ "$(stat -c %s "$1/$2")" -lt 10000000 ] && echo "$2"' _ "$(dirname "$page")" "$target"
    found=$((found + 1))
  done
  grep -q 'No page: .*apt install' "$page" && return
  expect 0 "^$count\$" echo "$found"
}

# expect_plot STEM...: STEM.png and STEM.svg exist and have the formats of their names.
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

# leave_out WHAT: prints that WHAT is not tested; the test then counts as skipped, or as failed if CI is set.
leave_out() {
  echo "NOT TESTED: $1" >&2
  left_out=yes
  [ -n "${CI:-}" ] || return 0
  checks=$((checks + 1))
  failures=$((failures + 1))
}
