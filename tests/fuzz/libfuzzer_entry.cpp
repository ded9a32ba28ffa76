#include <algorithm>
#include <cstdlib>
#include <vector>

#include "fuzz/decoders.h"

namespace {

/// Is the one decoder to be fuzzed, or -1 for all (THIMBLE_DECODER=0 to kTargets - 1).
int only_decoder() {
  const char* const number = std::getenv("THIMBLE_DECODER");
  return number == nullptr ? -1 : std::atoi(number);
}

}  // namespace

// Built by clang only, with -fsanitize=fuzzer, which brings main.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int only = only_decoder();
  std::vector<std::byte> bytes(size);
  std::transform(data, data + size, bytes.begin(),
                 [](std::uint8_t value) { return static_cast<std::byte>(value); });
  if (only >= 0 && size > 0) bytes[0] = static_cast<std::byte>(only);
  thimble::fuzz::decode_anything(bytes);
  return 0;
}
