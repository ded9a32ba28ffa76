#!/usr/bin/env bash
# Fails if a build accepts an option that changes results of arithmetic, or rejects a common one.
#   tests/arch/loose_arithmetic_is_refused.sh SOURCE_DIR
set -euo pipefail
source=$1 folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0

# look VARIABLE=VALUE: the message about an option, from the file that the project includes before it declares targets.
look() { cmake -DCMAKE_SYSTEM_PROCESSOR=x86_64 -DCMAKE_BUILD_TYPE=Release "-D$1" -P "$source/driver/src/math/refuse_loose_arithmetic.cmake" 2>&1 || true; }

for option in -Ofast -ffast-math -funsafe-math-optimizations -fassociative-math -freciprocal-math -ffinite-math-only \
    -fno-signed-zeros -fno-trapping-math -ffp-contract=fast -ffp-contract=on -fsingle-precision-constant -mrecip \
    -mfpmath=387 -march=native -march=x86-64-v3 -mfma -mavx2 -msse4.2 -ffp-model=fast -fapprox-func -fdenormal-fp-math=preserve-sign; do
  for variable in CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_RELEASE CMAKE_EXE_LINKER_FLAGS; do
    if ! look "$variable=-O2 $option" | tr '\n' ' ' | tr -s ' ' | grep -q "$variable has $option: forces would"; then
      echo "$variable with $option was not refused"
      bad=1
    fi
  done
done
for options in '-O2 -g' '-march=x86-64 -mtune=native -O2' '-O3 -DNDEBUG'; do
  if look "CMAKE_CXX_FLAGS=$options" | grep -q .; then
    echo "$options was refused: $(look "CMAKE_CXX_FLAGS=$options")"
    bad=1
  fi
done
# The project must include that file.
if ! { cmake -S "$source" -B "$folder/build" -DCMAKE_CXX_FLAGS=-ffast-math 2>&1 || true; } | grep -q 'forces would'; then
  echo "the project accepts -ffast-math"
  bad=1
fi

# Options outside of CMake's variables are rejected by the compiler.
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
