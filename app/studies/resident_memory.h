#pragma once

#include <cstddef>

namespace thimble::studies {

/// Returns how much memory this process holds, bytes; all 0 where the kernel does not say.
struct ResidentMemory {
  std::size_t now = 0;   ///< In memory now, the program's own code and mapped files included.
  std::size_t most = 0;  ///< The most there ever was.
};

/// Reads /proc/self/status. What the kernel keeps of files that were read is not counted: it gives
/// that up by itself. Real-time: never from the servo thread.
ResidentMemory resident_memory();

}  // namespace thimble::studies
