#!/usr/bin/env bash
# The cost of ROS 2 topics for a tick of the servo thread, in instructions: nothing if they only publish the run, at
# most 60 of about 5,000 if a force is subscribed.
#   topics_cost.sh TOPICS_TICKS SOURCE_DIR
set -euo pipefail
program=$1 source=$2
command -v valgrind >/dev/null || {
  echo "NOTE: valgrind is not installed; nothing was counted (Debian: valgrind)."
  exit 0
}
if ! grep -q '127\.0\.0\.1' /proc/net/fib_trie 2>/dev/null; then
  echo "NOT COUNTED: the interface lo is down; as root: ip link set lo up"
  exit 77
fi
export CYCLONEDDS_URI='<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces></General></Domain></CycloneDDS>'
. "$source/tests/arch/tick_calls.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
declare -A cost
for part in none publish force; do
  export TOPICS=$part
  tick_calls "$program" "$source/tests/data/scenes/plain_ball.yaml" "$folder" "$part"
  cost[$part]=$(instructions_of "$folder/$part.calls" 'session::Session::step(')
  echo "$part: ${cost[$part]} instructions per tick"
done
[ "${cost[none]}" -gt 1000 ] || { echo "nothing was counted"; exit 1; }
[ "${cost[publish]}" = "${cost[none]}" ] || { echo "publishing costs a tick something"; exit 1; }
[ $((cost[force] - cost[none])) -le 60 ] || { echo "listening for a force costs more than 60 instructions"; exit 1; }
