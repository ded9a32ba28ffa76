#!/usr/bin/env bash
# Tests words.py with each kind of fault in a generated tree.
#   words_catches.sh
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree/tests/arch" "$tree/src"
cd "$tree"

list() { printf '%s\n' "$@" >tests/arch/words.list; }
check() { python3 "$here/words.py" "$tree" >"$tree/log" 2>&1; }
must_pass() { check || { echo "words.py reported a fault in $1:" >&2; cat log >&2; exit 1; }; }
must_fail() {
  ! check || { echo "words.py did not report $1" >&2; exit 1; }
  grep -qF -- "$2" log || { echo "words.py reported $1 without \"$2\":" >&2; cat log >&2; exit 1; }
}

list '*.md' 'src/*'
echo 'The program prints the force. It uses `goes on` as a name.' >page.md
printf 'int told = 0;  // Number of messages.\nconst char* text = "ready";\n' >src/a.cpp
must_pass "plain text, an identifier and code in a document"
echo 'The program tells the force.' >page.md && must_fail "a banned word of a document" "page.md:1: 'tells'"
printf '```\nthe run goes on\n```\nWhoever asks.\n' >page.md && must_fail "a banned word below code" "page.md:4: 'Whoever'"
echo 'A plain sentence of few words.' >page.md
printf '\nint x;  // Reads the file anew.\n' >src/a.cpp && must_fail "a banned word of a comment" "src/a.cpp:2: 'anew'"
printf 'const char* text = "the run goes on";\n' >src/a.cpp && must_fail "a banned word of a string" "src/a.cpp:1: 'goes on'"
printf '/* One.\n   Mended by the caller. */\n' >src/a.cpp && must_fail "a banned word of a long comment" "src/a.cpp:2: 'Mended'"
printf '# Nobody reads it.\n' >src/b.sh && printf 'int x;\n' >src/a.cpp && must_fail "a banned word of a script" "src/b.sh:1: 'Nobody'"
list '*.md' 'src/*' 'allow | src/b.sh | nobody | the name of a system user'
must_pass "an exception with its reason"
printf 'true\n' >src/b.sh && must_fail "an unused exception" "unused"
list '*.md' 'gone/*' && must_fail "a pattern that matches no file" "no file matches gone/*"
list '*.md' 'allow | src/b.sh | nobody' && must_fail "an exception without a reason" "words.list:2"
list '*.md'
printf 'One two three four five six seven eight nine ten one two three four five six seven eight nine ten.\n' >page.md
must_fail "long sentences" "20.0 words a sentence"
{ echo '*.md'; for i in $(seq 41); do echo "allow | a | w$i | reason"; done; } >tests/arch/words.list
must_fail "too many exceptions" "41 exceptions"
echo "words.py reports all faults."
