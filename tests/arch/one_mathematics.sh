#!/usr/bin/env bash
# Fails if code that moves an arm, a hand or an object, or decides about it, calls a sine, an exponential or a similar
# function of the C library, whose last bit depends on the processor, or uses long double, whose size depends on it.
# math/elementary.h has all of these functions. Pictures, reports, studies and windows may call any function.
#   one_mathematics.sh SOURCE_DIR
set -euo pipefail
cd "$1"
folders=(driver device_sim render app/bringup app/scene app/session app/stability app/twin)
functions='a?(sin|cos|tan)h?|atan2|exp2?|expm1|log(2|10|1p)?|pow|hypot|cbrt'
bad=0
look() {  # look PATTERN WHAT: in code, not in comments
  local found
  found=$(find "${folders[@]}" \( -name '*.h' -o -name '*.cpp' -o -name '*.inc' \) -not -path 'driver/src/math/*' -print0 |
    xargs -0 awk -v pattern="$1" '{ code = $0; sub(/\/\/.*/, "", code) } code ~ pattern { print "  " FILENAME ":" FNR ":" $0 }')
  [ -n "$found" ] || return 0
  printf '%s:\n%s\n' "$2" "$found"
  bad=1
}
look "std::($functions|polar|erf|tgamma|lgamma)[fl]?[(]|(^|[^:_a-zA-Z0-9.>])(sin|cos|tan|acos|asin|atan2|exp|expm1|pow|hypot|cbrt)f?[(]" \
  'A function of the C library, which has other bits on other processors (math/elementary.h has it)'
look 'AngleAxis|[.]slerp[(]|angularDistance|eulerAngles' \
  'A rotation by the C library, through Eigen (driver::rotation_about has the same bits everywhere)'
look 'long double' 'Other bits on other processors (math/wide.h has more than a double everywhere)'
look 'std::[a-z_]*(normal|exponential|gamma|poisson|student_t|cauchy)_distribution' \
  "A distribution of the C++ library, which calls the C library's logarithm"
exit $bad
