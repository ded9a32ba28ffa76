# Rejects compiler options under which forces are not bit-identical on all machines. Included by the project; as a script
# (cmake -P) it checks the variables passed to it.
string(TOUPPER "CMAKE_CXX_FLAGS_${CMAKE_BUILD_TYPE}" flags_of_type)
# Also checks the linker: -ffast-math there flushes denormal numbers to 0 in the whole program.
foreach(variable CMAKE_CXX_FLAGS ${flags_of_type} CMAKE_EXE_LINKER_FLAGS CMAKE_SHARED_LINKER_FLAGS CMAKE_MODULE_LINKER_FLAGS)
  if(" ${${variable}} " MATCHES
     " (-Ofast|-ffast-math|-funsafe-math-optimizations|-fassociative-math|-freciprocal-math|-ffinite-math-only|-fno-signed-zeros|-fno-trapping-math|-ffp-contract=(fast|on|fast-honor-pragmas)|-ffp-model=(fast|aggressive|precise)|-fapprox-func|-fno-honor-(nans|infinities)|-fdenormal-fp-math=[^ ]*|-mdaz-ftz|-fsingle-precision-constant|-mrecip[^ ]*|-mfpmath=[^ ]*387[^ ]*|-m32|-mx32) ")
    message(FATAL_ERROR
      "${variable} has ${CMAKE_MATCH_1}: forces would have other bits than those that the tests store, and a force that is "
      "no number might pass as one. Leave it out; what runs in a tick is built with -O3 by itself.")
  endif()
  # With these, Eigen uses wider vectors, which add in another order, and its own fused operations.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$" AND " ${${variable}} " MATCHES
     " (-march=[^ ]*|-mfma4?|-mavx[^ ]*|-msse3|-mssse3|-msse4[^ ]*) " AND NOT CMAKE_MATCH_1 STREQUAL "-march=x86-64")
    message(FATAL_ERROR
      "${variable} has ${CMAKE_MATCH_1}: forces would have other bits than those that the tests store. Leave it out; contact "
      "looks for AVX2 as it runs and is built for both.")
  endif()
endforeach()
