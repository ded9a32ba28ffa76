#include "mesh/file/read_plain_off.h"

#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "mesh/file/read_off.h"
#include "mesh/file/text_words.h"
#include "mesh/parallel_split.h"

namespace thimble::render {
namespace {

// Reads lines one after the other; each function returns false if the text has another form.
class PlainLines {
 public:
  PlainLines(const char* begin, const char* end) : at_(begin), end_(end) {}

  bool coordinate(double& number) {
    skip_spaces();
    const char* const begin = at_;
    const bool negative = at_ != end_ && *at_ == '-';
    if (negative) ++at_;
    // As plain_decimal of text_words.cpp: exact for up to 15 digits [Clinger].
    const Digits whole = take_digits();
    std::uint64_t digits = whole.value;
    std::size_t count = whole.count, decimals = 0;
    if (at_ != end_ && *at_ == '.') {
      ++at_;
      const Digits part = take_digits();
      decimals = part.count;
      count += decimals;
      if (count <= kDigitsMax)
        digits = digits * static_cast<std::uint64_t>(kWholePowers[decimals]) + part.value;
    }
    if (count > 0 && count <= kDigitsMax && ends_word()) {
      // Signed, because that conversion is one instruction.
      number = static_cast<double>(static_cast<std::int64_t>(digits)) /
               static_cast<double>(kWholePowers[decimals]);
      if (negative) number = -number;
    } else {
      while (!ends_word()) ++at_;
      const auto other = real_number({begin, static_cast<std::size_t>(at_ - begin)});
      if (!other) return false;
      number = *other;
    }
    return std::abs(number) <= kCoordinateMax;
  }

  bool number_below(std::uint32_t limit, std::int32_t& number) {
    skip_spaces();
    const Digits digits = take_digits();
    number = static_cast<std::int32_t>(digits.value);
    return digits.count > 0 && digits.count <= kIndexDigitsMax && digits.value < limit &&
           ends_word();
  }

  bool line_end() {
    skip_spaces();
    if (at_ != end_ && *at_ == '\r') ++at_;
    if (at_ == end_) return true;
    return *at_++ == '\n';
  }

 private:
  static constexpr std::size_t kDigitsMax = 15;
  static constexpr std::size_t kIndexDigitsMax = 9;  // below 2^32
  static constexpr std::array<std::int64_t, kDigitsMax + 1> kWholePowers = [] {
    std::array<std::int64_t, kDigitsMax + 1> powers{1};
    for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = 10 * powers[i - 1];
    return powers;
  }();

  // Digits in a row; of more than 19 the value is meaningless.
  struct Digits {
    std::uint64_t value = 0;
    std::size_t count = 0;
  };

  Digits take_digits() {
    Digits digits;
    if (end_ - at_ >= 8) {
      // Eight bytes at once; the first is the lowest.
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, at_, sizeof(bytes));
      bytes ^= 0x3030303030303030u;  // digits are 0 to 9 now
      // The highest bit of each byte above 9; those above the first such byte do not matter.
      const std::uint64_t other =
          ((bytes + 0x7676767676767676u) | bytes) & std::uint64_t{0x8080808080808080u};
      if (other != 0) {
        digits.count = static_cast<std::size_t>(std::countr_zero(other)) / 8;
        if (digits.count == 0) return digits;
        // Zeros before the digits; then pairs, fours and eight of them are joined.
        bytes <<= 64 - 8 * digits.count;
        bytes = (10 * bytes + (bytes >> 8)) & 0x00ff00ff00ff00ffu;
        bytes = (100 * bytes + (bytes >> 16)) & 0x0000ffff0000ffffu;
        digits.value = (10000 * bytes + (bytes >> 32)) & 0xffffffffu;
        at_ += digits.count;
        return digits;
      }
    }
    const char* at = at_;
    for (; at != end_; ++at) {
      const auto digit = static_cast<unsigned>(*at) - unsigned{'0'};
      if (digit > 9) break;
      digits.value = 10 * digits.value + digit;
    }
    digits.count = static_cast<std::size_t>(at - at_);
    at_ = at;
    return digits;
  }
  bool ends_word() const { return at_ == end_ || *at_ == ' ' || *at_ == '\n' || *at_ == '\r'; }
  void skip_spaces() {
    while (at_ != end_ && *at_ == ' ') ++at_;
  }

  const char* at_;
  const char* end_;
};

// Returns the number of line ends in a block; the compiler counts 16 bytes at a time.
constexpr std::ptrdiff_t kBlockBytes = 4096;
std::size_t line_ends_in_block(const char* at) {
  constexpr std::ptrdiff_t kRun = 128;  // fits into a byte
  std::size_t count = 0;
  for (std::ptrdiff_t run = 0; run < kBlockBytes; run += kRun) {
    std::uint8_t in_run = 0;
    for (std::ptrdiff_t i = 0; i < kRun; ++i) {
      in_run = static_cast<std::uint8_t>(in_run + (at[run + i] == '\n' ? 1 : 0));
    }
    count += in_run;
  }
  return count;
}

// Returns the place after the next `lines` line ends; null if there are fewer.
const char* after_lines(const char* at, const char* end, std::size_t lines) {
  while (end - at >= kBlockBytes) {
    const std::size_t count = line_ends_in_block(at);
    if (count >= lines) break;
    lines -= count;
    at += kBlockBytes;
  }
  for (; lines > 0; --lines) {
    const auto* const found =
        static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(end - at)));
    if (found == nullptr) return nullptr;
    at = found + 1;
  }
  return at;
}

// Reads `count` lines from `first` in two halves. `middle` is the begin of line `count` / 2.
// `read(lines, i)` reads line i; false if it has another form.
template <class Read>
bool read_lines(const char* first, const char* middle, const char* end, std::size_t count,
                const Read& read) {
  std::atomic<bool> plain = true;
  parallel_split(count, [&](std::size_t begin, std::size_t last) {
    PlainLines lines(begin == 0 ? first : middle, end);
    for (std::size_t i = begin; i < last; ++i) {
      if (read(lines, i) && lines.line_end()) continue;
      plain = false;
      return;
    }
  });
  return plain;
}

}  // namespace

std::optional<TriangleMesh> read_plain_off(std::string_view text, std::size_t vertices,
                                           std::size_t faces) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const char* const vertex_middle = after_lines(begin, end, vertices / 2);
  if (vertex_middle == nullptr) return {};
  const char* const face_begin = after_lines(vertex_middle, end, vertices - vertices / 2);
  if (face_begin == nullptr || faces == 0) return {};
  const char* const face_middle = after_lines(face_begin, end, faces / 2);
  if (face_middle == nullptr) return {};
  TriangleMesh mesh;
  mesh.vertices.resize(vertices);
  const bool has_vertices =
      read_lines(begin, vertex_middle, end, vertices, [&mesh](PlainLines& lines, std::size_t i) {
        double* const to = mesh.vertices[i].data();
        return lines.coordinate(to[0]) && lines.coordinate(to[1]) && lines.coordinate(to[2]);
      });
  if (!has_vertices) return {};
  mesh.triangles.resize(faces);
  const auto limit = static_cast<std::uint32_t>(vertices);
  const bool has_faces =
      read_lines(face_begin, face_middle, end, faces, [&](PlainLines& lines, std::size_t i) {
        std::array<std::int32_t, 3>& to = mesh.triangles[i];
        std::int32_t corners = 0;
        return lines.number_below(4, corners) && corners == 3 && lines.number_below(limit, to[0]) &&
               lines.number_below(limit, to[1]) && lines.number_below(limit, to[2]);
      });
  if (!has_faces) return {};
  return mesh;
}

}  // namespace thimble::render
