# Shared by the newcomers' scripts: each follows the installed documents and nothing else.
# From the environment: DOCUMENTS, the folder of README.md and guide/; THIMBLE_LONG, for the whole script.
set -euo pipefail

fail() {
  echo "FAILED: $(basename "$0" .sh): $*" >&2
  exit 1
}

# says PAGE SENTENCE: the page still has this sentence, with any line breaks.
says() {
  tr -s ' \n' '  ' <"$DOCUMENTS/$1" | grep -qF -- "$2" || fail "$1 does not say: $2"
}

# see PATTERN COMMAND...: the command succeeds and prints a matching line.
see() {
  local pattern=$1 said
  shift
  said=$("$@" 2>&1 </dev/null) || fail "$*: $said"
  grep -qE -- "$pattern" <<<"$said" || fail "$*: no line matches '$pattern': $said"
}

# refused PATTERN COMMAND...: the command fails with bad input (2) and a matching line.
refused() {
  local pattern=$1 said status=0
  shift
  said=$("$@" 2>&1 </dev/null) || status=$?
  [ "$status" = 2 ] || fail "$*: exit code $status: $said"
  grep -qE -- "$pattern" <<<"$said" || fail "$*: no line matches '$pattern': $said"
}

# wait_for PATTERN FILE: waits until a line matches, a minute at most.
wait_for() {
  for _ in $(seq 600); do
    if grep -qE -- "$1" "$2" 2>/dev/null; then return; fi
    sleep 0.1
  done
  fail "nothing in $2 matches '$1': $(cat "$2")"
}

has() { command -v "$1" >/dev/null; }
