#include "mesh/file/read_off.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "mesh/file/read_plain_off.h"
#include "mesh/file/text_words.h"
#include "mesh/file/triangulate_polygon.h"

namespace thimble::render {
namespace {

using driver::Error;

struct Header {
  std::int64_t vertices = 0;
  std::int64_t faces = 0;
  bool vertex_per_line = false;  // positions are followed by normals, colours or texture
};

driver::Result<Header> read_header(TextWords& words) {
  const std::string_view keyword = words.next();
  if (keyword.empty()) return words.error("the file is empty.");
  if (keyword.size() < 3 || keyword.substr(keyword.size() - 3) != "OFF" || keyword.size() > 8) {
    return words.error("an OFF file begins with OFF, not with " + shown_word(keyword) + ".");
  }
  const std::string_view prefix = keyword.substr(0, keyword.size() - 3);
  if (prefix.find_first_of("4n") != std::string_view::npos) {
    return words.error(std::string(keyword) +
                       " has vertices that are not three numbers. Save the mesh as plain OFF.");
  }
  if (prefix.find_first_not_of("STCN") != std::string_view::npos) {
    return words.error("unknown kind of OFF file " + shown_word(keyword) + ".");
  }
  std::string_view word = words.next();
  if (word == "BINARY") return words.error("binary OFF is not supported. Save the mesh as text.");
  Header header;
  header.vertex_per_line = !prefix.empty();
  for (std::int64_t* count : {&header.vertices, &header.faces}) {
    if (count == &header.faces) word = words.next();
    if (word.empty()) return words.error("the file ends before the counts of vertices and faces.");
    const auto number = whole_number(word);
    if (!number) return words.error("expected a count, found " + shown_word(word) + ".");
    if (*number < 0) return words.error("the count " + shown_word(word) + " is negative.");
    // The shortest vertex is "0 0 0 ", the shortest face "1 0 ". A larger count cannot be true, and
    // memory must not be reserved for it.
    const std::size_t shortest = count == &header.vertices ? 6 : 4;
    if (static_cast<std::uint64_t>(*number) > (words.left() + 2) / shortest) {
      return words.error("the file declares " + std::to_string(*number) +
                         (count == &header.vertices ? " vertices" : " faces") + " but has only " +
                         std::to_string(words.left()) + " bytes left: it is truncated.");
    }
    *count = *number;
  }
  words.skip_line();  // the count of edges, often 0
  return header;
}

std::optional<Error> read_vertices(TextWords& words, const Header& header, TriangleMesh& mesh) {
  mesh.vertices.reserve(static_cast<std::size_t>(header.vertices));
  for (std::int64_t i = 0; i < header.vertices; ++i) {
    Eigen::Vector3d vertex;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words.next();
      if (word.empty()) {
        return words.error("the file ends in vertex " + std::to_string(i) + " of " +
                           std::to_string(header.vertices) + ": it is truncated.");
      }
      const auto number = real_number(word);
      if (!number || !(std::abs(*number) <= kCoordinateMax)) {
        return words.error(shown_word(word) + " in vertex " + std::to_string(i) +
                           " is not a number between -1e15 and 1e15.");
      }
      vertex[axis] = *number;
    }
    mesh.vertices.push_back(vertex);
    if (header.vertex_per_line) words.skip_line();
  }
  return std::nullopt;
}

std::optional<Error> read_faces(TextWords& words, const Header& header, TriangleMesh& mesh) {
  mesh.triangles.reserve(static_cast<std::size_t>(header.faces));
  std::vector<std::int32_t> corners;
  for (std::int64_t face = 0; face < header.faces; ++face) {
    // Most faces of most files: about a third of the time of the words below.
    std::array<std::int32_t, 3> plain;
    if (words.next_plain_line(3, static_cast<std::uint32_t>(header.vertices), plain)) {
      mesh.triangles.push_back(plain);
      continue;
    }
    const std::string name = "face " + std::to_string(face);
    const std::string_view size_word = words.next();
    const auto size = whole_number(size_word);
    if (size_word.empty()) {
      return words.error("the file ends before " + name + " of " + std::to_string(header.faces) +
                         ": it is truncated.");
    }
    if (!size || *size < 1) {
      return words.error("expected the number of corners of " + name + ", found " +
                         shown_word(size_word) + ".");
    }
    corners.clear();
    for (std::int64_t corner = 0; corner < *size; ++corner) {
      const std::string_view word = words.next();
      if (word.empty()) return words.error("the file ends in " + name + ": it is truncated.");
      const auto vertex = whole_number(word);
      if (!vertex || *vertex < 0 || *vertex >= header.vertices) {
        return words.error(name + " refers to vertex " + shown_word(word) +
                           "; the vertices are 0 to " + std::to_string(header.vertices - 1) + ".");
      }
      corners.push_back(static_cast<std::int32_t>(*vertex));
    }
    words.skip_line();  // colours of the face
    // Points and lines have no area and cannot be touched.
    if (corners.size() >= 3 && !triangulate_polygon(mesh.vertices, corners, mesh.triangles)) {
      return words.error(too_many_corners(name, corners.size()));
    }
  }
  return std::nullopt;
}

}  // namespace

driver::Result<TriangleMesh> read_off(std::string_view text, const std::string& name) {
  TextWords words(text, name);
  const auto header = read_header(words);
  if (!header) return header.error();
  if (header->vertices > std::numeric_limits<std::int32_t>::max()) {
    return words.error("more than 2^31 - 1 vertices are not supported.");
  }
  if (!header->vertex_per_line) {
    // From the line end of the counts.
    const std::string_view rest = text.substr(text.size() - words.left());
    const std::size_t line_end = rest.find('\n');
    if (line_end != std::string_view::npos) {
      auto plain =
          read_plain_off(rest.substr(line_end + 1), static_cast<std::size_t>(header->vertices),
                         static_cast<std::size_t>(header->faces));
      if (plain) return *std::move(plain);
    }
  }
  TriangleMesh mesh;
  if (auto error = read_vertices(words, *header, mesh)) return *error;
  if (auto error = read_faces(words, *header, mesh)) return *error;
  if (mesh.triangles.empty()) return words.error("the file has no face with three corners.");
  return mesh;
}

}  // namespace thimble::render
