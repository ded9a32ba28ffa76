#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "fuzz/decoders.h"

namespace {

/// Decoders to fuzz.
struct Decoders {
  unsigned first = 0;
  unsigned last = thimble::fuzz::kTargets - 1;
};

/// Reads THIMBLE_DECODERS, "FIRST-LAST"; all if it is not set.
Decoders wanted_decoders() {
  Decoders wanted;
  const char* const text = std::getenv("THIMBLE_DECODERS");
  if (text == nullptr) return wanted;
  if (std::sscanf(text, "%u-%u", &wanted.first, &wanted.last) != 2 || wanted.first > wanted.last ||
      wanted.last >= thimble::fuzz::kTargets) {
    std::fprintf(stderr, "THIMBLE_DECODERS: expected FIRST-LAST, at most 0-%u, found %s\n",
                 thimble::fuzz::kTargets - 1, text);
    std::exit(2);
  }
  return wanted;
}

}  // namespace

// Built only by clang with -fsanitize=fuzzer, which provides main.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Decoders wanted = wanted_decoders();
  std::vector<std::byte> bytes(size);
  std::transform(data, data + size, bytes.begin(),
                 [](std::uint8_t value) { return static_cast<std::byte>(value); });
  if (size > 0) {
    const unsigned count = wanted.last - wanted.first + 1;
    bytes[0] = static_cast<std::byte>(wanted.first + data[0] % count);
  }
  thimble::fuzz::decode_anything(bytes);
  return 0;
}
