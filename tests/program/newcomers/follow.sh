# Shared by the ways of newcomers: each follows what is installed with the program and nothing else.
# Taken from the environment: DOCUMENTS, the folder of README.md and guide/; THIMBLE_LONG, for the whole way.
set -euo pipefail

fail() {
  echo "FAILED: $(basename "$0" .sh): $*" >&2
  exit 1
}

# says PAGE SENTENCE: the page still says what is followed here, however its lines are broken.
says() {
  tr -s ' \n' '  ' <"$DOCUMENTS/$1" | grep -qF -- "$2" || fail "$1 does not say: $2"
}

# see PATTERN COMMAND...: the command ends well and prints a line that matches.
see() {
  local pattern=$1 said
  shift
  said=$("$@" 2>&1 </dev/null) || fail "$*: $said"
  grep -qE -- "$pattern" <<<"$said" || fail "$*: no line matches '$pattern': $said"
}

# refused PATTERN COMMAND...: the command ends with bad input (2), and says so in a line that matches.
refused() {
  local pattern=$1 said status=0
  shift
  said=$("$@" 2>&1 </dev/null) || status=$?
  [ "$status" = 2 ] || fail "$*: exit code $status: $said"
  grep -qE -- "$pattern" <<<"$said" || fail "$*: no line matches '$pattern': $said"
}

# wait_for PATTERN FILE: until a line of it matches, a minute at most.
wait_for() {
  for _ in $(seq 600); do
    if grep -qE -- "$1" "$2" 2>/dev/null; then return; fi
    sleep 0.1
  done
  fail "nothing in $2 matches '$1': $(cat "$2")"
}

has() { command -v "$1" >/dev/null; }
