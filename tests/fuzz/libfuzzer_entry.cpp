#include "fuzz/decoders.h"

// Built by clang only, with -fsanitize=fuzzer, which brings main.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  thimble::fuzz::decode_anything({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
