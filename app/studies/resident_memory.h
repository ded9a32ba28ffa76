#pragma once

#include <cstddef>

namespace thimble::studies {

/// Memory of this process, bytes; all 0 if the kernel does not report it.
struct ResidentMemory {
  std::size_t now = 0;   ///< Resident memory now, including the program's code and mapped files.
  std::size_t peak = 0;  ///< The maximum so far.
};

/// Reads /proc/self/status. The kernel's page cache of read files is not included: the kernel frees
/// it when needed. Real-time: never from the servo thread.
ResidentMemory resident_memory();

}  // namespace thimble::studies
