#!/usr/bin/env bash
# Shows that an effect that a scene does not name costs nothing: the same scene executes the same
# instructions per tick and allocates the same bytes in a program with all effects and in one that was
# built without them.
#   unused_effects_cost_nothing.sh ALL NONE ONLY_BRISTLE SOURCE_DIR
# The first three are effect_ticks, linked with all effects, with none, and with friction: bristle only.
# Without valgrind, only the bytes are compared, and the includes are checked.
set -euo pipefail
all=$1 none=$2 only_bristle=$3 source=$4
bad=0

# Only the table and an effect itself may include an effect.
known=$(grep -rlE '#include "(thimble/render/)?surface/(friction|texture)/' "$source/render" |
  grep -vE '/surface/(friction|texture)/|/effect/effect_table.cpp$' || true)
if [ -n "$known" ]; then
  echo "These sources include an effect; only render/src/effect/effect_table.cpp may:"
  echo "$known" | sed 's/^/  /'
  bad=1
fi

# instructions PROGRAM SUBJECT: per tick, from two runs that differ by two strokes of 1000 ticks.
instructions() {
  local one three
  one=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null "$1" "$2" 1 2>&1 >/dev/null |
    sed -n 's/.*Collected : //p')
  three=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null "$1" "$2" 3 2>&1 >/dev/null |
    sed -n 's/.*Collected : //p')
  echo $(((three - one) / 2000))
}

# compare SUBJECT FULL LEAN: both programs on the same scene.
compare() {
  local subject=$1 full=$2 lean=$3 bytes_full bytes_lean
  bytes_full=$("$full" "$subject" 1 2>/dev/null)
  bytes_lean=$("$lean" "$subject" 1 2>/dev/null)
  echo "$subject: $bytes_full bytes with all effects, $bytes_lean without"
  if [ "$bytes_full" != "$bytes_lean" ]; then bad=1; fi
  if command -v valgrind >/dev/null; then
    local count_full count_lean
    count_full=$(instructions "$full" "$subject")
    count_lean=$(instructions "$lean" "$subject")
    echo "$subject: $count_full instructions per tick with all effects, $count_lean without"
    if [ "$count_lean" -lt 50 ]; then
      echo "  too few for a tick in contact"
      bad=1
    fi
    # Within 0.5 %.
    local difference=$((count_full - count_lean))
    if [ $((200 * ${difference#-})) -gt "$count_lean" ]; then bad=1; fi
  fi
}

command -v valgrind >/dev/null ||
  echo "NOTE: valgrind is not installed; instructions are not counted (Debian: valgrind)."
compare bare "$all" "$none"
compare compact "$all" "$none"
compare friction:bristle "$all" "$only_bristle"
[ $bad = 0 ] && ! command -v valgrind >/dev/null && exit 77
exit $bad
