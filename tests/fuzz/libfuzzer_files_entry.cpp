#include <cstdio>
#include <cstdlib>
#include <span>
#include <string_view>

#include "fuzz/file_readers.h"

namespace {

/// Returns the kind of file as which the bytes are read (THIMBLE_FILE_KIND).
std::string_view wanted_kind() {
  const char* const wanted = std::getenv("THIMBLE_FILE_KIND");
  for (const std::string_view kind : thimble::fuzz::kFileKinds) {
    if (wanted != nullptr && kind == wanted) return kind;
  }
  std::fprintf(stderr, "THIMBLE_FILE_KIND must be one of:");
  for (const std::string_view kind : thimble::fuzz::kFileKinds) {
    std::fprintf(stderr, " %s", kind.data());
  }
  std::fputc('\n', stderr);
  std::exit(2);
}

}  // namespace

// Built only by clang with -fsanitize=fuzzer, which provides main.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string_view kind = wanted_kind();
  thimble::fuzz::read_any_file(kind, std::as_bytes(std::span(data, size)));
  return 0;
}
