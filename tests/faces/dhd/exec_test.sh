#!/usr/bin/env bash
# Small programs in C, written as public examples are, under `thimble exec`: each checks itself that the
# forces it asked for are those that the arm got.
#   exec_test.sh THIMBLE SOURCE_DIR WORK_DIR CLIENT_FOLDER LIBRARY
source "$(dirname "$0")/../../program/expect.sh" "$1" "$2" "$3"
clients=$4
library=$5

hand=$source_dir/tests/faces/dhd/late_hand.txt
expect 0 'hello force: PASSED' "$thimble" exec "$clients/dhd_client_hello_force"
expect 0 'spring to centre: PASSED' "$thimble" exec --hand "$hand" "$clients/dhd_client_spring_to_centre"
expect 0 'gripper: PASSED' "$thimble" exec --arm polhem "$clients/dhd_client_gripper"
expect 0 'Gripper   a force asked for' "$thimble" exec --arm polhem "$clients/dhd_client_gripper"
expect 0 'two devices: PASSED' "$thimble" exec --arm vintage_phantom --arm falcon "$clients/dhd_client_two_devices"
expect 0 'watchdog trip: PASSED' "$thimble" exec "$clients/dhd_client_watchdog_trip"
expect 0 'hold and move: PASSED' "$thimble" exec "$clients/dhd_client_hold_and_move"
# What a program did wrong stands in the report, with the function's name.
expect 0 'Wrong     drdMoveToPos 1 time: regulation does not run' "$thimble" exec "$clients/dhd_client_hold_and_move"
# Without `thimble exec` there is no arm, and the reason is told.
expect 1 'start the program by `thimble exec`' \
  env LD_LIBRARY_PATH="$(dirname "$library")" "$clients/dhd_client_watchdog_trip"
finish
