#!/usr/bin/env bash
# The programs of this folder under `thimble exec`, in virtual time: check.py compares what each read and requested with the
# recordings.
#   proof_test.sh THIMBLE SOURCE_DIR WORK_DIR CLIENT_FOLDER
source "$(dirname "$0")/../../program/expect.sh" "$1" "$2" "$3"
clients=$4
proof=$source_dir/tests/compat/proof

# prove NAME.KIND: runs a program with a log, and compares the log with the recordings of its arms.
prove() {
  local name=${1%.*} arms=1 options=() program
  case $1 in
    *.py) program=(python3 -B "$proof/$1") ;;
    *) program=("$clients/$name") ;;
  esac
  case $name in
    two_arms_*) arms=2 options=(--arm vintage_phantom --arm falcon) ;;
    anchored_spring_hd) options=(--button-at 0.3:1:0.8) ;;
  esac
  rm -f run*.h5
  expect 0 '' "$thimble" exec --clock virtual --hand "$proof/hand.txt" "${options[@]}" --record run.h5 "${program[@]}" "$1.log"
  [ $arms = 1 ] || mv run-arm2.h5 run2.h5
  mv run.h5 run1.h5
  local arm recordings=()
  for ((arm = 1; arm <= arms; ++arm)); do
    expect 0 '' "$thimble" export run$arm.h5 --csv "run$arm.csv"
    recordings+=("run$arm.csv")
  done
  expect_own 0 ' 0 positions not recorded' python3 -B "$proof/check.py" "$1.log" "${recordings[@]}"
  echo "$output"
}

programs=0
for file in "$proof"/*_*.{c,cpp,py}; do
  prove "$(basename "$file")"
  programs=$((programs + 1))
done
expect_own 0 '^30$' echo "$programs"

# The comparison finds a position and a force that are wrong by 2 %.
prove sphere_hd.c
for column in 4 7; do
  awk -v column=$column '{ $column *= 1.02; print }' sphere_hd.c.log >wrong.log
  expect_own 1 'wrong.log' python3 -B "$proof/check.py" wrong.log run1.csv
done
finish
