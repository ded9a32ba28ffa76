#!/usr/bin/env bash
# Tests arm_test.sh with a program instead of thimble that records its arguments and how it ends.
#   limits_test.sh ARM_TEST WORK_DIR CTEST_TIMEOUT
set -u
arm_test=$1 work=$2 ctest_timeout=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"
cat >thimble <<'END'
#!/usr/bin/env bash
[ "$1" = hil ] || exit 0
echo "$*" >>calls
trap 'echo SIGTERM >>ended; exit 130' TERM
[ ! -e hangs ] || { for _ in $(seq 300); do sleep 0.1; done; }
exit "$(cat code)"
END
chmod +x thimble
failures=0
check() { # WHAT EXPECTED FOUND
  [ "$2" = "$3" ] && return
  echo "FAILED: $1: expected $2, found $3"
  failures=$((failures + 1))
}
run() { bash "$arm_test" "$work/thimble" "$work" >output 2>&1; }
export THIMBLE_ARM=app/arms/any.yaml

# The test ends with the result of the suite.
for code in 0 3 4 5; do
  echo $code >code
  run
  check "exit code of the suite" $code $?
done
# Both suites end by themselves, after more than their usual time (150 s, 70 minutes) and long before CTest kills them.
for suite in "quick 150" "full 4200"; do
  set -- $suite
  rm -f calls
  echo 0 >code
  THIMBLE_SUITE=$1 run
  limit=$(sed -nE 's/.* --timeout ([0-9]+).*/\1/p' calls)
  check "the limit of $1 is above $2 s" yes "$([ "${limit:-0}" -gt "$2" ] && echo yes)"
  check "the limit of $1 is 10 minutes below CTest's" yes "$([ $((limit + 600)) -lt "$ctest_timeout" ] && echo yes)"
done
check "a real arm is required" 1 "$(grep -c -- '--require-device' calls)"
# A suite that does not end gets SIGTERM, and can answer with zero force.
touch hangs
THIMBLE_LIMIT=1 THIMBLE_GRACE=1 run
check "a suite that hangs fails" yes "$([ $? -ne 0 ] && echo yes)"
check "signal to a suite that hangs" SIGTERM "$(cat ended 2>/dev/null)"
rm -f hangs ended
# Without an arm file nothing is tested.
(unset THIMBLE_ARM; run)
check "without an arm file" 77 $?
[ $failures = 0 ] && echo "All limits hold."
exit $failures
