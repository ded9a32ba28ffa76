#!/usr/bin/env bash
# Fails if a build is configured with an option under which arithmetic has other bits, or if a usual one is not.
#   tests/arch/loose_arithmetic_is_refused.sh SOURCE_DIR
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0

# configure VARIABLE=VALUE: what CMake says; it looks at options before anything else.
configure() { cmake -S "$1" -B "$folder/build" "-D$2" 2>&1 || true; }

for option in -Ofast -ffast-math -funsafe-math-optimizations -fassociative-math -freciprocal-math -ffinite-math-only \
    -fno-signed-zeros -fno-trapping-math -ffp-contract=fast -ffp-contract=on -mfpmath=387; do
  # The flags of a build type are looked at in the same way: one of them is enough.
  variables=CMAKE_CXX_FLAGS
  [ "$option" != -ffast-math ] || variables="CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_RELEASE"
  for variable in $variables; do
    rm -rf "$folder/build"
    if ! configure "$1" "$variable=-O2 $option" | tr '\n' ' ' | tr -s ' ' | grep -q "$variable has $option: forces would"; then
      echo "$variable with $option was not refused"
      bad=1
    fi
  done
done
rm -rf "$folder/build"
if configure "$1" 'CMAKE_CXX_FLAGS=-march=native -O2' | grep -q 'forces would'; then
  echo "-march=native was refused"
  bad=1
fi
exit $bad
