// Recordings with all kinds of damage, also in the tables of HDF5: each is read or rejected with an
// error. HDF5 1.10 crashes on some of them, which must not end this program.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "support/long_form.h"
#include "support/noise.h"
#include "support/scratch.h"
#include "support/seed.h"
#include "thimble/session/recording.h"

namespace thimble::session {
namespace {

using support::Random;

std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns a recording of eight ticks in which all bytes are equal.
std::string recording_of(int byte) {
  std::vector<driver::TickRecord> ticks(8);
  std::memset(static_cast<void*>(ticks.data()), byte, ticks.size() * sizeof ticks[0]);
  session::RecordingInfo info;
  info.scene = "mutated";
  info.arm_in_scene = "left";
  info.rate = 1000;
  const auto path = support::scratch_folder() / "sound.h5";
  std::filesystem::remove(path);
  EXPECT_TRUE(session::write_recording(path, info, ticks));
  return file_bytes(path);
}

/// Damages recordings. The damage depends only on the seed.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed), sound_(recording_of(0)) {
    // Bytes that are equal in two recordings belong to tables of HDF5, names and texts.
    const std::string other = recording_of(0xff);
    for (std::size_t i = 0; i < sound_.size(); ++i) {
      if (sound_[i] == other[i] && sound_[i] != 0) tables_.push_back(i);
    }
  }

  const std::string& sound() const { return sound_; }
  std::size_t table_bytes() const { return tables_.size(); }

  std::string next() {
    std::string file = sound_;
    for (std::uint64_t edits = 1 + below(6); edits > 0; --edits) edit(file);
    return file;
  }

 private:
  std::uint64_t below(std::uint64_t end) { return random_.bits() % end; }

  /// Three of four edits are in a table.
  std::size_t place(const std::string& file) {
    const std::size_t at = below(4) > 0 ? tables_[below(tables_.size())] : below(file.size());
    return std::min(at, file.size() - 1);
  }

  void edit(std::string& file) {
    const std::size_t at = place(file);
    switch (below(8)) {
      case 0:
      case 1:
        file[at] = static_cast<char>(random_.bits());
        return;
      case 2:
        file[at] = static_cast<char>(file[at] ^ (1 << below(8)));
        return;
      case 3:  // a wrong length or address
      case 4: {
        const std::array<std::uint64_t, 8> values{
            0,
            ~std::uint64_t{0},
            file.size(),
            below(file.size()),
            tables_[below(tables_.size())] & ~std::uint64_t{7},
            at,
            std::uint64_t{1} << below(64),
            0x7fffffffffffffff};
        const std::uint64_t value = values[below(values.size())];
        const std::size_t from = at & ~std::size_t{below(2) * 7};
        const std::size_t width = std::size_t{1} << below(4);
        for (std::size_t i = 0; i < width && from + i < file.size(); ++i) {
          file[from + i] = static_cast<char>(value >> (8 * i));
        }
        return;
      }
      case 5: {  // a table in the position of another
        const std::size_t from = tables_[below(tables_.size())];
        const std::size_t size = 1 + below(64);
        for (std::size_t i = 0; i < size && at + i < file.size() && from + i < sound_.size(); ++i) {
          file[at + i] = sound_[from + i];
        }
        return;
      }
      case 6:
        for (std::uint64_t i = 1 + below(16); i > 0 && at + i <= file.size(); --i) {
          file[at + i - 1] = static_cast<char>(below(2) == 0 ? 0 : 0xff);
        }
        return;
      default:
        if (below(4) == 0) file.resize(1 + below(file.size()));
    }
  }

  Random random_;
  std::string sound_;
  std::vector<std::size_t> tables_;
};

TEST(RecordingMutations, AreReadOrRefused) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "no threads meet here, and damaged files ask for more memory than it can give";
#endif
  // Each file is read in a separate process, which takes most of the time of this test.
  const int rounds = support::long_form() ? 2000 : 150;
  Mutator mutator(support::seed_of(7364));
  ASSERT_GT(mutator.table_bytes(), 2000U);
  const auto path = support::scratch_folder() / "mutated.h5";
  int read = 0, refused = 0, broke = 0;
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE(round);
    std::ofstream(path, std::ios::binary) << mutator.next();
    const auto recording = session::read_recording(path);
    if (recording) {
      ++read;
      EXPECT_LE(recording->ticks.size(), 1000U);
      continue;
    }
    ++refused;
    EXPECT_TRUE(recording.error().message.starts_with(path.string())) << recording.error().message;
    if (recording.error().message.find("is damaged (it ") != std::string::npos) ++broke;
  }
  RecordProperty("read", read);
  RecordProperty("refused", refused);
  RecordProperty("broke", broke);
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace thimble::session
