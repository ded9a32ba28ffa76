#include "mesh/file/stl_bytes.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace thimble::render {
namespace {

constexpr std::size_t kHead = 84;      // a comment of 80 bytes, and the number of triangles
constexpr std::size_t kTriangle = 50;  // a normal, three corners, and two bytes of colour

// Where a text has its first facet, if it is one: behind "solid NAME".
constexpr std::size_t kTextBegin = 1000;

char small(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

bool begins_with_solid(std::string_view bytes) {
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return false;
  std::string word(bytes.substr(begin, 5));
  std::transform(word.begin(), word.end(), word.begin(), small);
  return word == "solid";
}

// A binary file may begin with "solid" too: what tells a text is its first facet, or its end.
bool is_text(std::string_view bytes) {
  if (!begins_with_solid(bytes)) return false;
  std::string begin(bytes.substr(0, kTextBegin));
  if (begin.find('\0') != std::string::npos) return false;
  std::transform(begin.begin(), begin.end(), begin.begin(), small);
  return begin.find("facet") != std::string::npos || begin.find("endsolid") != std::string::npos;
}

}  // namespace

driver::Result<void> put_stl_right(std::string& bytes, std::vector<std::string>& notes) {
  if (is_text(bytes)) {
    std::transform(bytes.begin(), bytes.end(), bytes.begin(), small);
    return {};
  }
  if (bytes.size() < kHead) return {};  // for the reader to refuse
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  const std::uint64_t wanted = kHead + std::uint64_t{kTriangle} * count;
  if (count == 0) return driver::Error{"its head promises no triangles."};
  if (wanted > bytes.size()) {
    return driver::Error{"this is no STL file that can be read: its head promises " +
                         std::to_string(count) + " triangles, but it has bytes for " +
                         std::to_string((bytes.size() - kHead) / kTriangle) +
                         " only: it is truncated, or no STL file."};
  }
  if (wanted < bytes.size()) {
    notes.push_back(std::to_string(bytes.size() - wanted) +
                    " bytes after the last triangle were left out.");
    bytes.resize(wanted);
  }
  return {};
}

}  // namespace thimble::render
