#!/usr/bin/env bash
# A run as ROS 2 topics, with a program of another vendor's DDS: it finds the run, receives every topic, requests
# a force, is killed, and sends invalid messages.
#   ros2_test.sh THIMBLE PEER WORK_DIR
source "$(dirname "$0")/../program/expect.sh" "$1" "$(cd "$(dirname "$0")/../.." && pwd)" "$3"
peer=$2
if ! grep -q '127\.0\.0\.1' /proc/net/fib_trie 2>/dev/null; then
  echo "ROS 2 TEST SKIPPED: the interface lo is down; as root: ip link set lo up"
  exit 77
fi
# No message leaves this machine.
export CYCLONEDDS_URI='<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces></General></Domain></CycloneDDS>'
cat >lo.xml <<'X'
<?xml version="1.0" encoding="UTF-8"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <transport_descriptors><transport_descriptor><transport_id>lo</transport_id><type>UDPv4</type>
    <interfaceWhiteList><address>127.0.0.1</address></interfaceWhiteList></transport_descriptor></transport_descriptors>
  <participant profile_name="lo" is_default_profile="true"><rtps>
    <userTransports><transport_id>lo</transport_id></userTransports><useBuiltinTransports>false</useBuiltinTransports>
  </rtps></participant>
</profiles>
X
export FASTRTPS_DEFAULT_PROFILES_FILE=$work/lo.xml
# A hand that waits above the ball, and sways so that the encoders count: the only force is that of the topic.
cat >rest.yaml <<Y
name: rest
description: A hand rests above a ball.
arm: $source_dir/app/arms/vintage_phantom.yaml
duration: 6
objects:
  - name: ball
    sphere: {radius: 0.02}
    position: [0, 0, -0.06]
    stiffness: 400
hand:
  path:
    - {t: 0, at: [0, 0, 0.02]}
Y
for second in $(seq 2 2 100); do
  echo "    - {t: $second, at: [0, $((second / 2 % 2 * 4)).0e-3, 0.02]}" >>rest.yaml
done
domain=$((100 + $$ % 100))
seconds=${THIMBLE_LONG:+60}
seconds=${seconds:-3}

# play SECONDS OPTIONS...: a run with topics.
play() { "$thimble" run rest.yaml --no-view --ros2 --ros-domain "$domain" --duration "$@"; }

# Receives topics and requests a force.
play $((seconds + 2)) --ros-force replace --ros-limit 2 --record asked.h5 >run.log 2>&1 &
run=$!
"$peer" "$domain" "$seconds" 0.7 >peer.log
wait "$run"
cat run.log peer.log
for topic in joint_states pose twist wrench button tf; do
  # Of 1000 per second: the loss on a busy machine is not checked.
  expect 0 heard awk -v topic="rt/$topic" -v least=$((seconds * 20)) '$1 == topic && $2 >= least { print "heard" }' peer.log
done
expect_own 0 '^rt/robot_description 1$' cat peer.log # published before the peer joined
expect_own 0 '^rt/diagnostics [1-9]' cat peer.log
expect_own 0 '^bad 0$' cat peer.log
expect_own 0 '^object ball in world$' cat peer.log # as a marker, also for late subscribers
expect_own 0 '^triangles [1-9][0-9]+$' cat peer.log
for topic in pose wrench tf objects; do
  expect_own 0 "^rt/$topic says typehash=RIHS01_[0-9a-f]{64};\$" cat peer.log
done
expect_words 0 '# ms median' cat run.log
expect_own 0 '^force [0-9.]+ most 0\.(69|70)' cat peer.log
expect 0 '^ROS 2 +[0-9]+ .* [1-9][0-9]+ ' cat run.log

# The peer is killed: the force ends within its time of validity, and stays zero.
play 5 --ros-force replace --record killed.h5 >killed.log 2>&1 &
run=$!
"$peer" "$domain" 20 0.7 >/dev/null &
asks=$!
sleep 3
kill -KILL "$asks"
wait "$run"
expect 0 '^ROS 2 +[1-9][0-9]* .*renewed' cat killed.log
# The recorded force, N along x: present once, never above the request, and permanently zero by the last second.
force() {
  "$thimble" export "$1" --csv force.csv >/dev/null &&
    awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^f_sent_W.x/) x = i; next }
      { f[++n] = $x; if ($x > most) most = $x; if ($x != 0) last = n }
      END { printf "%d ticks, most %.3f N, off for the last %d\n", n, most, n - last }' force.csv
}
expect_own 0 'ticks, most 0\.(69|70)[0-9]* N, off for the last [0-9]{4}$' force killed.h5

# Invalid messages: named, counted; no force above the limit.
play 4 --ros-force replace --ros-limit 1 --record garbage.h5 >garbage.log 2>&1 &
run=$!
"$peer" "$domain" 3 garbage >peer.log
wait "$run"
cat garbage.log
expect 0 '[1-9][0-9]* .* finite' cat garbage.log
expect 0 '[1-9][0-9]* .* world' cat garbage.log
expect 0 '[1-9][0-9]* .* torque' cat garbage.log
expect 0 '[1-9][0-9]* .*skipped' cat garbage.log
expect 0 '[1-9][0-9]* .*limit' cat garbage.log
expect_own 0 'ticks, most (1\.000|0\.9[0-9]+) N' force garbage.h5

# A moving body has a moving frame: a block that the hand pushes.
"$thimble" run held_block --no-view --ros2 --ros-domain "$domain" --duration 4 --clock wall >block.log 2>&1 &
run=$!
"$peer" "$domain" 5 0 >peer.log
wait "$run"
expect_own 0 '^frame object_[a-z_]+ moved 0\.0*[1-9]' cat peer.log

# Of several bodies that meet, each has its frame: dominoes, which fall one after the other.
"$thimble" run dominoes --no-view --ros2 --ros-domain "$domain" --duration 4 --clock wall >dominoes.log 2>&1 &
run=$!
"$peer" "$domain" 5 0 >peer.log
wait "$run"
for i in $(seq 8); do
  expect_own 0 "^frame object_domino_$i moved 0\.0*[1-9]" cat peer.log
  expect_own 0 "^object domino_$i in object_domino_$i\$" cat peer.log
done

# Several arms: each under its name.
"$thimble" run two_hands --no-view --ros2 --ros-domain "$domain" --duration 3 --clock wall >two.log 2>&1 &
run=$!
"$peer" "$domain" 4 0 >peer.log
wait "$run"
expect 0 '^2$' grep -cE '^ROS 2 +[1-9]' two.log
for hand in left right; do expect_own 0 "^rt/$hand/pose says typehash" cat peer.log; done

# Programs of other arms as topics: here one of an Inverse3.
timeout -s INT 4 "$thimble" exec --serve haply --port 0 --ros2 --ros-domain "$domain" --ros-namespace /other >/dev/null 2>exec.log &
run=$!
"$peer" "$domain" 3 0 >peer.log
wait "$run" || true
expect 0 '^ROS 2 +[1-9][0-9]+ ' cat exec.log
expect_own 0 '^rt/other/pose says typehash' cat peer.log
expect_words 2 '--ros-force' "$thimble" exec --ros2 --ros-force add true
expect_words 2 '--clock virtual' "$thimble" exec --ros2 --clock virtual true

# A topic leads the simulated hand.
play 5 --hand topic >hand.log 2>&1 &
run=$!
"$peer" "$domain" 4 hand >peer.log
wait "$run"
cat hand.log peer.log
expect 0 '[1-9][0-9]+ .* hand ' cat hand.log
expect_own 0 'off 0\.00' cat peer.log
expect_words 2 '--hand topic --ros2' "$thimble" run rest.yaml --no-view --hand topic

# As with the drivers of the Omni: 20 mm above the origin is z, a force along their y is along -x here.
play 5 --ros-names omni --ros-force replace --record omni.h5 >omni.log 2>&1 &
run=$!
"$peer" "$domain" 3 omni >peer.log
wait "$run"
cat peer.log
for topic in pose joint_states state; do
  expect 0 heard awk -v topic="rt/phantom/$topic" '$1 == topic && $2 > 60 { print "heard" }' peer.log
done
expect_own 0 '^bad 0$' cat peer.log
expect_own 0 '^apart 0\.000' cat peer.log
least() {
  "$thimble" export "$1" --csv force.csv >/dev/null &&
    awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^f_sent_W.x/) x = i; next }
      $x < least { least = $x } END { printf "least %.3f N\n", least }' force.csv
}
expect_own 0 'least -0\.(59|60)' least omni.h5

# The cost of the delay over the topics for the stiffest wall of another program.
expect_words 0 '# ms median 99 %' \
  "$thimble" tune rest.yaml --ros2 --ros-domain "$domain"

# Stepped: each step is answered, bit-identically each time, and faster than real time.
step() { # step SCENE SECONDS PART OPTIONS...
  for run in one two; do
    timeout 80 "$thimble" run "$1" --no-view --ros2 --ros-domain "$domain" --clock virtual --duration "$2" "${@:4}" \
      --record "$1_$run.h5" >"$1.log" 2>&1 &
    local pid=$!
    "$peer" "$domain" $(($2 * 100)) "$3" >"$1_$run.log" || break
    wait "$pid"
  done
  cat "$1_one.log"
  expect_own 0 "^stepped $(($2 * 1000))\$" cat "$1_one.log"
  expect_own 0 '^bad 0$' cat "$1_one.log"
  expect 0 '' cmp "$1_one.log" "$1_two.log"
}
same() { # same RECORDING RECORDING
  for f in "$@"; do "$thimble" export "$f.h5" --csv "$f.csv" >/dev/null; done && cmp "$1.csv" "$2.csv"
}
step rubber 1 step --ros-force replace
expect 0 '^clock 0\.999$' cat rubber_one.log
expect 0 '' same rubber_one rubber_two
# With two arms the topics of both have the time of the run.
step two_hands 1 step_two
for hand in left right; do expect 0 '' same "two_hands_one_$hand" "two_hands_two_$hand"; done
finish
