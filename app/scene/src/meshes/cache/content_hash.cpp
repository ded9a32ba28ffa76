#include "meshes/cache/content_hash.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "system/regular_file.h"

namespace thimble::scene {
namespace {

__extension__ using HashProduct = unsigned __int128;

constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;
constexpr std::size_t kWordBytes = 7;
constexpr std::size_t kGroupBytes = 4 * kWordBytes;  // words of one step of the sums
constexpr std::size_t kHashPieceBytes = kGroupBytes * 32768;

// Any numbers do. [chosen: the first 61 bits of the fractions of the square roots of 2 and 3]
constexpr std::array<std::uint64_t, 2> kHashConstants{0x0d413cccfe779921u, 0x176cf5d0b09954e7u};

// Returns a number below 2^124 modulo the prime.
std::uint64_t modulo_prime(HashProduct x) noexcept {
  // 2^61 is 1.
  const auto once =
      (static_cast<std::uint64_t>(x) & kPrime) + static_cast<std::uint64_t>(x >> 61);  // < 2^64
  const std::uint64_t twice = (once & kPrime) + (once >> 61);
  return twice >= kPrime ? twice - kPrime : twice;
}

// Value of a polynomial at a constant, four words per step.
class PolynomialSum {
 public:
  explicit PolynomialSum(std::uint64_t constant) noexcept {
    power_[0] = constant;
    for (std::size_t i = 1; i < power_.size(); ++i) {
      power_[i] = modulo_prime(HashProduct{power_[i - 1]} * constant);
    }
  }
  void add(const std::array<std::uint64_t, 4>& words) noexcept {
    // Each product is below 2^122.
    value_ = modulo_prime(HashProduct{value_} * power_[3] + HashProduct{words[0]} * power_[2] +
                          HashProduct{words[1]} * power_[1] + HashProduct{words[2]} * power_[0] +
                          words[3]);
  }
  std::uint64_t value() const noexcept { return value_; }

 private:
  std::array<std::uint64_t, 4> power_{};
  std::uint64_t value_ = 0;
};

// Reads `bytes` from `at`; false if the file has fewer.
bool read_hash_piece(int descriptor, std::span<std::byte> bytes, std::uint64_t at) noexcept {
  std::size_t got = 0;
  while (got < bytes.size()) {
    const ssize_t more =
        pread(descriptor, bytes.data() + got, bytes.size() - got, static_cast<off_t>(at + got));
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return false;
    got += static_cast<std::size_t>(more);
  }
  return true;
}

}  // namespace

std::optional<ContentHash> content_hash(const std::filesystem::path& file) {
  const auto opened = driver::RegularFile::open(file);
  if (!opened) return {};
  const std::uint64_t size = opened->size();
  PolynomialSum first(kHashConstants[0]), second(kHashConstants[1]);
  // One byte more, because a word is read as eight bytes.
  std::vector<std::byte> piece(kHashPieceBytes + 1);
  for (std::uint64_t at = 0; at < size;) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(size - at, kHashPieceBytes));
    if (!read_hash_piece(opened->descriptor(), std::span(piece).first(count), at)) return {};
    const std::size_t groups = (count + kGroupBytes - 1) / kGroupBytes;
    std::memset(piece.data() + count, 0, groups * kGroupBytes - count);
    for (std::size_t group = 0; group < groups; ++group) {
      std::array<std::uint64_t, 4> words;
      for (std::size_t i = 0; i < words.size(); ++i) {
        std::memcpy(&words[i], piece.data() + group * kGroupBytes + i * kWordBytes,
                    sizeof(words[i]));
        words[i] &= (std::uint64_t{1} << (8 * kWordBytes)) - 1;
      }
      first.add(words);
      second.add(words);
    }
    at += count;
  }
  return ContentHash{.bytes = size, .sums = {first.value(), second.value()}};
}

}  // namespace thimble::scene
