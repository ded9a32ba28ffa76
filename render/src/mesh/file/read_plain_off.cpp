#include "mesh/file/read_plain_off.h"

#include <algorithm>
#include <array>
#include <atomic>
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
    const char* const first = at_;
    std::uint64_t digits = take_digits(0);
    std::ptrdiff_t count = at_ - first, decimals = 0;
    if (at_ != end_ && *at_ == '.') {
      const char* const point = ++at_;
      digits = take_digits(digits);
      decimals = at_ - point;
      count += decimals;
    }
    if (count > 0 && count <= kDigitsMax && ends_word()) {
      // Signed, because that conversion is one instruction.
      number = static_cast<double>(static_cast<std::int64_t>(digits)) /
               kPowers[static_cast<std::size_t>(decimals)];
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
    const char* const begin = at_;
    const std::uint64_t digits = take_digits(0);
    if (at_ == begin || at_ - begin > kIndexDigitsMax || digits >= limit || !ends_word()) {
      return false;
    }
    number = static_cast<std::int32_t>(digits);
    return true;
  }

  bool line_end() {
    skip_spaces();
    if (at_ != end_ && *at_ == '\r') ++at_;
    if (at_ == end_) return true;
    return *at_++ == '\n';
  }

 private:
  static constexpr std::ptrdiff_t kDigitsMax = 15;
  static constexpr std::ptrdiff_t kIndexDigitsMax = 9;  // below 2^32
  static constexpr std::array kPowers{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                      1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

  // Digits beyond 2^64 are lost; no caller uses the result if there are so many.
  std::uint64_t take_digits(std::uint64_t before) {
    const char* at = at_;  // in a register
    for (; at != end_; ++at) {
      const auto digit = static_cast<unsigned>(*at) - unsigned{'0'};
      if (digit > 9) break;
      before = 10 * before + digit;
    }
    at_ = at;
    return before;
  }
  bool ends_word() const { return at_ == end_ || *at_ == ' ' || *at_ == '\n' || *at_ == '\r'; }
  void skip_spaces() {
    while (at_ != end_ && *at_ == ' ') ++at_;
  }

  const char* at_;
  const char* end_;
};

// Returns the place after the next `lines` line ends; null if there are fewer.
const char* after_lines(const char* at, const char* end, std::size_t lines) {
  // Blocks are counted at once, because a search for each line end takes ten times as long.
  constexpr std::ptrdiff_t kBlock = 4096;
  while (end - at >= kBlock) {
    const auto count = static_cast<std::size_t>(std::count(at, at + kBlock, '\n'));
    if (count >= lines) break;
    lines -= count;
    at += kBlock;
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
