#include "studies/resident_memory.h"

#include <fstream>
#include <sstream>
#include <string>

namespace thimble::studies {

ResidentMemory resident_memory() {
  ResidentMemory memory;
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    std::istringstream words(line);
    std::string key;
    std::size_t kilobytes = 0;
    if (!(words >> key >> kilobytes)) continue;
    if (key == "VmRSS:") memory.now = 1024 * kilobytes;
    if (key == "VmHWM:") memory.peak = 1024 * kilobytes;
  }
  return memory;
}

}  // namespace thimble::studies
