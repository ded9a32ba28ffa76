#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz/decoders.h"
#include "support/long_form.h"
#include "support/noise.h"

namespace thimble::fuzz {
namespace {

std::vector<std::vector<std::byte>> corpus() {
  std::vector<std::vector<std::byte>> files;
  for (const auto& entry : std::filesystem::directory_iterator(THIMBLE_CORPUS)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    std::vector<std::byte> bytes;
    for (std::istreambuf_iterator<char> at(stream), end; at != end; ++at) {
      bytes.push_back(static_cast<std::byte>(*at));
    }
    files.push_back(std::move(bytes));
  }
  return files;
}

TEST(Decoders, PassTheirChecksOnTheCorpus) {
  const auto files = corpus();
  EXPECT_GE(files.size(), 12u);
  int understood = 0;
  for (const auto& bytes : files) understood += decode_anything(bytes) ? 1 : 0;
  EXPECT_GE(understood, 9);  // at least one valid message per decoder
}

TEST(Decoders, PassTheirChecksOnRandomAndDamagedBytes) {
  // A million takes a second here; a tenth of it under sanitizers.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  const int rounds = support::long_form() ? 1'000'000 : 100'000;
#else
  const int rounds = 1'000'000;
#endif
  const auto files = corpus();
  support::Random random(101);
  int understood = 0;
  for (int i = 0; i < rounds; ++i) {
    if (i % 4 == 0) {
      understood += decode_anything(support::any_bytes(random, random.bits() % 140)) ? 1 : 0;
    } else {
      understood +=
          decode_anything(support::damaged(random, files[random.bits() % files.size()])) ? 1 : 0;
    }
  }
  // Damage must reach the code behind the first check, or the test proves nothing.
  EXPECT_GT(understood, rounds / 50);
  EXPECT_LT(understood, rounds);
}

}  // namespace
}  // namespace thimble::fuzz
