#!/usr/bin/env bash
# Small C programs in the style of public examples, under `thimble exec`. Each checks that the arm got
# the forces that it asked for. In virtual time, so that the load of the machine makes no difference.
#   exec_test.sh THIMBLE SOURCE_DIR WORK_DIR CLIENT_FOLDER LIBRARY
source "$(dirname "$0")/../../program/expect.sh" "$1" "$2" "$3"
clients=$4
library=$5

hand=$source_dir/tests/compat/dhd/late_hand.txt
expect_own 0 'hello force: PASSED' "$thimble" exec --clock virtual "$clients/dhd_client_hello_force"
expect_own 0 'spring to centre: PASSED' "$thimble" exec --clock virtual --hand "$hand" "$clients/dhd_client_spring_to_centre"
expect_own 0 'gripper: PASSED' "$thimble" exec --clock virtual --arm polhem "$clients/dhd_client_gripper"
expect 0 '^Gripper ' "$thimble" exec --clock virtual --arm polhem "$clients/dhd_client_gripper"
expect_own 0 'two devices: PASSED' "$thimble" exec --clock virtual --arm vintage_phantom --arm falcon "$clients/dhd_client_two_devices"
expect_own 0 'watchdog trip: PASSED' "$thimble" exec --clock virtual "$clients/dhd_client_watchdog_trip"
expect_own 0 'ABI of DHD: 0 failures' "$thimble" exec --clock virtual "$clients/dhd_client_abi"
expect_own 0 'headers: PASSED' "$thimble" exec --clock virtual "$clients/dhd_client_headers"
expect_own 0 'hold and move: PASSED' "$thimble" exec --clock virtual "$clients/dhd_client_hold_and_move"
# In virtual time the arm waits for the program: all ticks of two runs are bit-identical.
for run in first second; do
  expect_own 0 'PASSED' "$thimble" exec --clock virtual --hand "$hand" --record $run.h5 "$clients/dhd_client_spring_to_centre"
  expect 0 '' "$thimble" export $run.h5 --csv $run.csv
done
expect_own 0 '^same$' sh -c '[ "$(wc -l <first.csv)" -gt 2500 ] && cmp first.csv second.csv && echo same'
expect_words 2 '--view' "$thimble" exec --clock virtual --view "$clients/dhd_client_hello_force"
expect_words 2 'simulated auto' "$thimble" exec --clock virtual --device auto "$clients/dhd_client_hello_force"
# Wrong calls of a program are in the report, with the function's name.
expect 0 '^Wrong +drdMoveToPos 1 ' "$thimble" exec --clock virtual "$clients/dhd_client_hold_and_move"
# Without `thimble exec` there is no arm, and the reason is printed.
expect 1 '`thimble exec`' \
  env LD_LIBRARY_PATH="$(dirname "$library")" "$clients/dhd_client_watchdog_trip"
finish
