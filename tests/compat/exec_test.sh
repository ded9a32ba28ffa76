#!/usr/bin/env bash
# Programs written for other arms, under `thimble exec`: they run unmodified, their forces reach the simulated
# motors, and faults are reported by name.
#   exec_test.sh THIMBLE SOURCE_DIR WORK_DIR CLIENTS_DIR
source "$(dirname "$0")/../program/expect.sh" "$1" "$2" "$3"
clients=$4
export TMPDIR=$work
run() { "$thimble" exec "$@"; }

# A hand that presses 8 mm deep into the sphere of hello_sphere, and out again.
printf '0 0 0 0.03\n1 0 0 0.012\n2 0.003 0 0.012\n3 0.003 0 0.03\n' >press.txt
# In virtual time: on a busy machine a program may get no time for 20 ms, and the gate would reopen.
expect_own 0 'vintage_phantom by Thimble' run --clock virtual --hand press.txt --record sphere.h5 "$clients/hello_sphere" 2 asked.txt
expect 0 'hello_sphere .*HDAPI.* [0-9]{4} ' run --hand press.txt "$clients/hello_sphere"
[ -s sphere.h5 ] || { echo "FAILED: no recording"; failures=$((failures + 1)); }
# In the recording: the gate got exactly the force that the program asked for (its axes: right, up, to the user), and the
# motors got that force.
expect 0 '' "$thimble" export sphere.h5 --csv sphere.csv
expect 0 '^[0-9]{3,} ticks with force, 0 not requested, at most 0\.0' awk '
  NR == FNR { asked[sprintf("%.9f %.9f %.9f", $3, $1, $2)] = 1; next }
  FNR == 1 { FS = ","; $0 = $0; for (i = 1; i <= NF; ++i) { if ($i ~ /^f_wanted_W.x/) w = i; if ($i ~ /^f_sent_W.z/) s = i } next }
  $(w + 2) > 0.5 {
    ++n; d = $(w + 2) - $s; if (d < 0) d = -d
    if (n > 100 && d > most) most = d
    if (!(sprintf("%.9f %.9f %.9f", $w, $(w + 1), $(w + 2)) in asked)) ++unknown
  }
  END { printf "%d ticks with force, %d not requested, at most %.3f N\n", n, unknown, most }' asked.txt sphere.csv

expect_own 0 'calibrated after 1, 200 x 200 x 200 mm, 5 N, 3 in' run "$clients/calibration"
expect_own 0 'calibrated after 1, 160 x 160 x 160 mm, 5 N, 6 in' run --arm polhem "$clients/calibration"
expect_own 0 ' 0 out of order, 0 torn' run "$clients/two_callbacks"
expect_own 0 'vintage_phantom and falcon' run --arm vintage_phantom --arm falcon "$clients/two_devices"
expect 2 '^Wrong +hdInitDevice 1 ' run "$clients/two_devices"
expect_own 0 '0\.[23][0-9]+ N at the end' run "$clients/force_ramp"
expect_own 0 '0 presses in' run "$clients/buttons"
expect_own 0 '2 presses in' run --button-at 0.05:1:0.1 --button-at 0.25 --button-at 0.3:2 "$clients/buttons" 2
expect_error 2 '--button-at 17' run --button-at 1:17 "$clients/buttons"
expect_own 0 'errors by value: right' run --arm vintage_phantom --arm falcon "$clients/wrong_calls"

# A program that knows only the makers' headers.
expect_own 0 'ABI of HDAPI: 0 failures' run --clock virtual "$clients/hd_abi"

# The helpers of the headers, in C and in C++.
libraries=$(dirname "$thimble")/compat/lib
expect_own 0 '0 failures' env LD_LIBRARY_PATH="$libraries" "$clients/hdu"
expect_own 0 '0 failures' env LD_LIBRARY_PATH="$libraries" "$clients/hdu_cxx"

# A program that uses HL beside HDAPI.
expect_own 0 'HL beside HDAPI: 0 failures' run --clock virtual "$clients/hl"
expect_words 0 'hlCreateContext HDAPI' run --clock virtual "$clients/hl"
expect_words 0 'hlCreateContext 1' run --clock virtual "$clients/hl"

# Two libraries in one program: each arm is listed once, and a refused opening takes nothing from the owner.
expect_own 0 'listed again 0, opened -1, 0.300 N before, 0.300 N after' run --clock virtual "$clients/two_libraries"
expect_own 0 'listed again 0, opened -1, 0.300 N before, 0.300 N after' run --clock virtual "$clients/two_libraries" second

# A copy of a library that a program brings with it is reported, and wrappers find ours where the vendor's SDK is expected.
mkdir own
cp "$(dirname "$thimble")/compat/lib/libHD.so" own/
expect_words 0 'loaded own/libHD.so' run --hand press.txt sh -c "LD_PRELOAD='$work/own/libHD.so' '$clients/hello_sphere' 1"
expect_words 0 'loaded own/libHD.so' run --hand press.txt python3 -c "
import ctypes, time
ctypes.CDLL('$work/own/libHD.so')
time.sleep(0.3)"
expect_own 0 'libdrd.so.3' run sh -c 'ls "$FDSDK/lib/release/lin-$(uname -m)-gcc/"'
expect 0 '^Program +two_libraries \(DRD\)' run --clock virtual "$clients/two_libraries"

# A loop paced by its set-force calls. Its rate is printed but not checked: a program that waits for a tick has
# fewer cycles than there were ticks.
seconds=${THIMBLE_LONG:+60}
run "$clients/chai_loop" "${seconds:-2}000" >loop.log 2>&1
grep -E 'turns in|^Program' loop.log
expect_own 0 "^${seconds:-2}000 turns in" cat loop.log
expect_words 0 'chai_loop hdPhantom # #' cat loop.log

# In Python, with ctypes.
expect_own 0 'both libraries: right' run --hand press.txt python3 "$source_dir/tests/compat/clients/hello_sphere.py"

# With a scene: its own objects push as well where the program asks for nothing.
expect 0 '' run --scene rubber --record rubber.h5 "$clients/chai_loop"
expect 0 '' "$thimble" export rubber.h5 --csv rubber.csv
expect_own 0 '^touched$' awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /^depth/) d = i; next } $d > 0 { print "touched"; exit }' rubber.csv

# A program that hangs is named, and its force is removed.
expect_words 0 'hangs HDAPI vintage_phantom 20 ms' run "$clients/hangs"
expect 0 '^Stalls +hangs .* [1-9]' run "$clients/hangs"
expect 0 'accepted zero force' run "$clients/hangs" and_leaves

# Without `thimble exec`, and other errors.
expect 2 'hdInitDevice.*`thimble exec' \
  env -u THIMBLE_EXEC LD_LIBRARY_PATH="$(dirname "$thimble")/compat/lib" "$clients/hello_sphere"
expect_words 2 './nowhere' run ./nowhere
expect_error 2 'exec PROGRAM ARGUMENTS' run
expect_error 7 'sh ldd' run sh -c 'exit 7'
expect_words 137 'signal 9' run sh -c 'kill -9 $$'
expect_words 2 'nonesuch vintage_phantom' run --arm nonesuch "$clients/calibration"
echo 'zero 0 0' >bad.txt
expect_words 2 'bad.txt:1 "t x y z"' run --hand bad.txt "$clients/calibration"
# Input is checked before the program starts, even if it opens no arm.
: >empty.yaml
expect_error 2 '--arm nonesuch' run --arm nonesuch true
expect_error 2 'empty.yaml' run --arm ./empty.yaml true
expect_error 2 'empty.yaml' run --arm polhem --arm ./empty.yaml true
expect_error 2 '--scene nonesuch' run --scene nonesuch true
expect_error 2 'empty.yaml' run --scene ./empty.yaml true
expect_error 2 '--hand nofile' run --hand nofile true
expect_error 2 'bad.txt:1 --hand' run --hand bad.txt true
expect_error 2 '--port 0 65535 "70000"' run --serve haply --port 70000
# No files and processes remain.
expect 1 '^$' sh -c 'ls "${TMPDIR:-/tmp}"/thimble-free-* 2>/dev/null || { echo; exit 1; }'
finish
