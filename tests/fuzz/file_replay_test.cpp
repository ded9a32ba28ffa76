#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "fuzz/file_readers.h"
#include "support/long_form.h"
#include "support/noise.h"

namespace thimble::fuzz {
namespace {

using File = std::vector<std::byte>;

std::map<std::string, File> corpus(std::string_view kind) {
  std::map<std::string, File> files;  // ordered by name, so that every machine has the same order
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(THIMBLE_FILE_CORPUS) / kind)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    File bytes;
    for (std::istreambuf_iterator<char> at(stream), end; at != end; ++at) {
      bytes.push_back(static_cast<std::byte>(*at));
    }
    files[entry.path().filename().string()] = std::move(bytes);
  }
  return files;
}

class FileReaders : public testing::TestWithParam<std::string_view> {};

TEST_P(FileReaders, PassTheirChecksOnTheCorpus) {
  const auto files = corpus(GetParam());
  int taken = 0;
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    taken += read_any_file(GetParam(), bytes) ? 1 : 0;
  }
  EXPECT_GE(taken, 1) << "the corpus needs at least one valid file";
}

TEST_P(FileReaders, PassTheirChecksOnDamagedFiles) {
  // A few milliseconds each for the slowest; the search itself is left to the fuzzer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  int rounds = 40;
#else
  int rounds = 200;
#endif
  if (support::long_form()) rounds *= 20;
  std::vector<File> files;
  for (auto& [name, bytes] : corpus(GetParam())) files.push_back(std::move(bytes));
  support::Random random(202);
  int taken = 0;
  for (int i = 0; i < rounds; ++i) {
    const File file = i % 4 == 0 ? support::any_bytes(random, random.bits() % 140)
                                 : support::damaged(random, files[random.bits() % files.size()]);
    taken += read_any_file(GetParam(), file) ? 1 : 0;
  }
  EXPECT_LT(taken, rounds);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FileReaders, testing::ValuesIn(kFileKinds),
                         [](const auto& param_info) { return std::string(param_info.param); });

}  // namespace
}  // namespace thimble::fuzz
