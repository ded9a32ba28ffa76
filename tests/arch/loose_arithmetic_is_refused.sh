#!/usr/bin/env bash
# Fails if a build is configured with an option under which arithmetic has other bits, or if a usual one is not.
#   tests/arch/loose_arithmetic_is_refused.sh SOURCE_DIR
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0

# configure VARIABLE=VALUE: what CMake says; it looks at options before anything else.
configure() { cmake -S "$1" -B "$folder/build" "-DCMAKE_CXX_COMPILER=${compiler:-c++}" "-D$2" 2>&1 || true; }

for option in -Ofast -ffast-math -funsafe-math-optimizations -fassociative-math -freciprocal-math -ffinite-math-only \
    -fno-signed-zeros -fno-trapping-math -ffp-contract=fast -ffp-contract=on -fsingle-precision-constant -mrecip \
    -mfpmath=387 -march=native -march=x86-64-v3 -mfma -mavx2 -msse4.2 -ffp-model=fast -fapprox-func -fdenormal-fp-math=preserve-sign; do
  compiler=c++
  case $option in -ffp-model=* | -fapprox-func | -fdenormal-fp-math=*)  # clang's own: GCC knows none of them
    compiler=clang++
    command -v clang++ >/dev/null || continue
    ;;
  esac
  # The flags of a build type are looked at in the same way: one of them is enough.
  variables=CMAKE_CXX_FLAGS
  [ "$option" != -ffast-math ] || variables="CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_RELEASE CMAKE_EXE_LINKER_FLAGS"
  for variable in $variables; do
    rm -rf "$folder/build"
    if ! configure "$1" "$variable=-O2 $option" | tr '\n' ' ' | tr -s ' ' | grep -q "$variable has $option: forces would"; then
      echo "$variable with $option was not refused"
      bad=1
    fi
  done
done
rm -rf "$folder/build"
if configure "$1" 'CMAKE_CXX_FLAGS=-march=x86-64 -mtune=native -O2' | grep -q 'forces would'; then
  echo "-march=x86-64 was refused"
  bad=1
fi

# What comes in beside CMake's variables is refused by the compiler.
for option in -ffast-math -Ofast -ffinite-math-only -march=haswell -mfma -mavx -msse4; do
  said=$(echo '#include "math/double_double.h"' | c++ -std=c++20 -O2 $option -I"$1/driver/src" -fsyntax-only -x c++ - 2>&1 || true)
  if ! grep -q 'forces would have other bits' <<<"$said"; then
    echo "the compiler with $option was not refused"
    bad=1
  fi
done
if echo '#include "math/double_double.h"' | c++ -std=c++20 -mno-sse2 -mfpmath=387 -I"$1/driver/src" -fsyntax-only -x c++ - 2>/dev/null; then
  echo "the compiler with -mfpmath=387 was not refused"
  bad=1
fi
exit $bad
