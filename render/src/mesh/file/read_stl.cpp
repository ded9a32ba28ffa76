#include "mesh/file/read_stl.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "mesh/file/read_off.h"  // kCoordinateMax
#include "mesh/file/single_precision.h"
#include "mesh/file/text_words.h"
#include "mesh/file/triangulate_polygon.h"

namespace thimble::render {
namespace {

using driver::Error;

constexpr std::size_t kHead = 84;      // a comment of 80 bytes, and the number of triangles
constexpr std::size_t kTriangle = 50;  // a normal, three corners, and two bytes of colour

// Maximum position of the first facet of a text: after "solid NAME".
constexpr std::size_t kTextBegin = 1000;

// Maximum number of vertices that numbers can represent.
constexpr std::size_t kVerticesMax = std::numeric_limits<std::int32_t>::max();

char small_letter(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

// Returns whether a word is `wanted`, which is in lower case.
bool is_word(std::string_view word, std::string_view wanted) {
  return word.size() == wanted.size() &&
         std::equal(word.begin(), word.end(), wanted.begin(),
                    [](char a, char b) { return small_letter(a) == b; });
}

// Returns the file length implied by the head of a binary file.
std::uint64_t promised_bytes(std::string_view bytes, std::uint32_t& triangles) {
  std::memcpy(&triangles, bytes.data() + kHead - sizeof triangles, sizeof triangles);
  return kHead + std::uint64_t{kTriangle} * triangles;
}

// Reads the solids of a text.
class StlText {
 public:
  StlText(std::string_view text, const std::string& name) : words_(text, name) {}

  std::optional<Error> read();
  TriangleMesh take() { return std::move(mesh_); }
  bool ended() const { return ended_; }

 private:
  std::optional<Error> read_facet();
  std::optional<Error> read_corner();
  std::optional<Error> expect(std::string_view wanted);
  void skip_name();

  TextWords words_;
  TriangleMesh mesh_;
  std::string_view word_;  // current word
  std::vector<std::int32_t> corners_;
  bool ended_ = false;  // by endsolid
};

// Skips the name of a solid: the rest of its line, or up to a facet if all is on one line. A name
// may contain any words.
void StlText::skip_name() {
  for (word_ = words_.next_on_line(); !word_.empty(); word_ = words_.next_on_line()) {
    if (!is_word(word_, "facet")) continue;
    TextWords ahead = words_;
    const std::string_view after = ahead.next_on_line();
    if (is_word(after, "normal") || is_word(after, "outer")) return;
  }
  word_ = words_.next();
}

std::optional<Error> StlText::read() {
  word_ = words_.next();
  while (!word_.empty()) {
    if (is_word(word_, "facet")) {
      ended_ = false;
      if (auto error = read_facet()) return error;
    } else if (is_word(word_, "solid") || is_word(word_, "endsolid")) {
      ended_ = is_word(word_, "endsolid");
      skip_name();
    } else {
      return words_.error("expected facet, endsolid or solid, found " + shown_word(word_) + ".");
    }
  }
  return std::nullopt;
}

std::optional<Error> StlText::expect(std::string_view wanted) {
  if (word_.empty()) return words_.error("the file ends in a facet: it is truncated.");
  if (!is_word(word_, wanted)) {
    return words_.error("expected " + std::string(wanted) + ", found " + shown_word(word_) + ".");
  }
  return std::nullopt;
}

std::optional<Error> StlText::read_facet() {
  // The normal is computed from the corners. At most three words follow "normal", any of which may
  // be missing or not a number.
  constexpr int kNormalWords = 4;
  word_ = words_.next();
  for (int i = 0; i < kNormalWords && !word_.empty() && !is_word(word_, "outer"); ++i) {
    word_ = words_.next();
  }
  if (auto error = expect("outer")) return error;
  word_ = words_.next();
  if (auto error = expect("loop")) return error;
  const std::size_t line = words_.line();
  corners_.clear();
  for (word_ = words_.next(); is_word(word_, "vertex"); word_ = words_.next()) {
    if (auto error = read_corner()) return error;
  }
  if (auto error = expect("endloop")) return error;
  if (corners_.size() < 3) return words_.error("a facet has fewer than three corners.");
  word_ = words_.next();
  if (auto error = expect("endfacet")) return error;
  if (!triangulate_polygon(mesh_.vertices, corners_, mesh_.triangles)) {
    return words_.error_at(line, too_many_corners("the facet", corners_.size()));
  }
  word_ = words_.next();
  return std::nullopt;
}

std::optional<Error> StlText::read_corner() {
  Eigen::Vector3d corner;
  for (double& x : corner) {
    const std::string_view word = words_.next();
    if (word.empty()) return words_.error("the file ends in a corner: it is truncated.");
    const auto number = real_number(word);
    if (!number || !(std::abs(*number) <= kCoordinateMax)) {
      return words_.error(shown_word(word) +
                          " in a corner is not a number between -1e15 and 1e15.");
    }
    x = *number;
  }
  if (mesh_.vertices.size() >= kVerticesMax) {
    return words_.error("more than 2^31 - 1 corners are not supported.");
  }
  corners_.push_back(static_cast<std::int32_t>(mesh_.vertices.size()));
  mesh_.vertices.push_back(corner);
  return std::nullopt;
}

driver::Result<TriangleMesh> read_text(std::string_view text, const std::string& name,
                                       std::vector<std::string>& notes) {
  StlText reader(text, name);
  if (auto error = reader.read()) return *error;
  TriangleMesh mesh = reader.take();
  if (mesh.triangles.empty()) return Error{"it has no facet."};
  if (!reader.ended()) notes.push_back("It has no endsolid: it may be truncated.");
  return mesh;
}

driver::Result<TriangleMesh> read_binary(std::string_view bytes, std::vector<std::string>& notes) {
  if (bytes.size() < kHead) {
    return Error{"not a readable STL file: it has neither a facet nor a header of 84 bytes."};
  }
  std::uint32_t count = 0;
  const std::uint64_t wanted = promised_bytes(bytes, count);
  if (count == 0) return Error{"its header declares no triangles."};
  if (wanted > bytes.size()) {
    return Error{"not a readable STL file: its header declares " + std::to_string(count) +
                 " triangles, but it has bytes for only " +
                 std::to_string((bytes.size() - kHead) / kTriangle) +
                 ". It is truncated or not an STL file."};
  }
  if (3 * std::uint64_t{count} > kVerticesMax) return Error{"it has more than 2^31 - 1 corners."};
  TriangleMesh mesh;
  mesh.vertices.resize(3 * std::size_t{count});
  mesh.triangles.resize(count);
  SinglePrecision precision;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> corners{};
    std::memcpy(corners.data(), bytes.data() + kHead + kTriangle * t + 3 * sizeof(float),
                sizeof corners);
    for (std::size_t i = 0; i < 9; ++i) {
      if (!(std::abs(corners[i]) <= kCoordinateMax)) {
        return Error{"triangle " + std::to_string(t) +
                     " has a coordinate that is not a number between -1e15 and 1e15."};
      }
      mesh.vertices[3 * t + i / 3][static_cast<Eigen::Index>(i % 3)] = double{corners[i]};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      precision.add(mesh.vertices[3 * t + i]);
      mesh.triangles[t][i] = static_cast<std::int32_t>(3 * t + i);
    }
  }
  if (auto kept = precision.judge(mesh, notes); !kept) return kept.error();
  if (wanted < bytes.size()) {
    notes.push_back(std::to_string(bytes.size() - wanted) +
                    " bytes after the last triangle were ignored.");
  }
  return mesh;
}

}  // namespace

bool is_stl_text(std::string_view bytes) {
  if (is_stl_binary(bytes)) return false;
  std::string begin(bytes.substr(0, kTextBegin));
  std::transform(begin.begin(), begin.end(), begin.begin(), small_letter);
  const std::size_t first = begin.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || begin.find('\0') != std::string::npos) return false;
  return begin.compare(first, 5, "solid") == 0 &&
         (begin.find("facet") != std::string::npos || begin.find("endsolid") != std::string::npos);
}

bool is_stl_binary(std::string_view bytes) {
  if (bytes.size() <= kHead) return false;
  std::uint32_t count = 0;
  return promised_bytes(bytes, count) == bytes.size();
}

driver::Result<TriangleMesh> read_stl(std::string_view bytes, const std::string& name,
                                      std::vector<std::string>& notes) {
  if (bytes.empty()) return Error{"the file is empty."};
  return is_stl_text(bytes) ? read_text(bytes, name, notes) : read_binary(bytes, notes);
}

}  // namespace thimble::render
