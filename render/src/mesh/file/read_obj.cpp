#include "mesh/file/read_obj.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "mesh/file/corner_values.h"
#include "mesh/file/read_off.h"  // kCoordinateMax
#include "mesh/file/text_words.h"
#include "mesh/file/triangulate_polygon.h"

namespace thimble::render {
namespace {

using driver::Error;

// Statements that do not affect the polygons of a mesh.
constexpr std::array<std::string_view, 31> kWithoutShape{
    "vn",     "vt",     "vp",     "g",     "o",     "s",         "mg",        "usemtl",
    "mtllib", "usemap", "maplib", "bevel", "lod",   "c_interp",  "d_interp",  "ctech",
    "stech",  "cstype", "deg",    "bmat",  "step",  "parm",      "trim",      "hole",
    "scrv",   "sp",     "end",    "con",   "curv2", "trace_obj", "shadow_obj"};

// Statements whose shape cannot be touched.
constexpr std::array<std::string_view, 3> kLines{"l", "p", "curv"};

// Statements whose shape would be missing.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kRefused{
    {{"surf", "free-form surfaces"},
     {"bzp", "Bezier patches"},
     {"bsp", "B-spline patches"},
     {"cdc", "Cardinal curves"},
     {"cdp", "Cardinal patches"},
     {"call", "included files"},
     {"csh", "shell commands"}}};

// A face that names vertices defined after it.
struct EarlyFace {
  std::size_t line = 0;
  std::size_t begin = 0;  // of its corners
  std::size_t size = 0;
};

// Numbers of the vertex and of the texture coordinate in a corner of a face; 0: none.
struct ObjCorner {
  std::int64_t vertex = 0, texture = 0;
};

// Returns the numbers in a corner of a face: V, V/T, V//N or V/T/N, of which T and N may be omitted
// after their slashes; the vertex is 0 for any other word.
ObjCorner corner_of(std::string_view word) {
  ObjCorner corner;
  for (int part = 0; part < 3; ++part) {
    const std::size_t slash = word.find('/');
    const std::string_view number = word.substr(0, slash);
    const std::int64_t value = whole_number(number).value_or(0);
    if (value == 0 && (part == 0 || !number.empty())) return {};
    if (part == 0) corner.vertex = value;
    if (part == 1) corner.texture = value;
    if (slash == std::string_view::npos) return corner;
    word.remove_prefix(slash + 1);
  }
  return word.empty() ? corner : ObjCorner();
}

// Vertex with 7 numbers: the last four of them.
struct Seven {
  std::size_t line = 0, vertex = 0;
  std::array<double, 4> rest{};
};

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& name, MeshAttributes* attributes)
      : words_(text, name, true), attributes_(attributes) {}

  std::optional<Error> read();
  TriangleMesh take() { return std::move(mesh_); }
  bool has_lines() const { return has_lines_; }

 private:
  std::optional<Error> read_statement(std::string_view keyword);
  std::optional<Error> read_vertex();
  std::optional<Error> set_colour(std::size_t line, std::size_t vertex,
                                  const Eigen::Vector3d& colour);
  std::optional<Error> set_colours_of_sevens();
  std::optional<Error> read_texture_coordinate();
  std::optional<Error> read_face();
  // `textures`: numbers of the texture coordinates of the corners, -1 for none; empty if they are
  // not read.
  std::optional<Error> add_face(std::size_t line, std::span<const std::int32_t> corners,
                                std::span<const std::int32_t> textures);

  TextWords words_;
  TriangleMesh mesh_;
  bool has_lines_ = false;
  std::vector<std::int32_t> corners_;  // of the face being read
  std::vector<EarlyFace> early_;
  std::vector<std::int32_t> early_corners_;
  // Below: only if attributes are read.
  MeshAttributes* attributes_;
  std::vector<Eigen::Vector2d> texture_;  // texture coordinates
  std::vector<Eigen::Vector3d> colours_;  // of vertices; NaN: none
  std::vector<Seven> sevens_;
  bool coloured_ = false;
  std::vector<std::int32_t> textures_;  // of the face being read
  std::vector<std::int32_t> early_textures_;
};

std::optional<Error> ObjReader::read() {
  while (!words_.at_end()) {
    const std::string_view keyword = words_.next_on_line();
    if (!keyword.empty()) {
      if (auto error = read_statement(keyword)) return error;
    }
    words_.next_line();
  }
  for (const EarlyFace& face : early_) {
    const std::span<const std::int32_t> corners(early_corners_.data() + face.begin, face.size);
    for (const std::int32_t corner : corners) {
      if (static_cast<std::size_t>(corner) < mesh_.vertices.size()) continue;
      return words_.error_at(
          face.line, "the face refers to vertex " + std::to_string(std::int64_t{corner} + 1) +
                         "; the file has " + std::to_string(mesh_.vertices.size()) + ".");
    }
    std::span<const std::int32_t> textures;
    if (attributes_ != nullptr) textures = {early_textures_.data() + face.begin, face.size};
    if (auto error = add_face(face.line, corners, textures)) return error;
  }
  if (attributes_ == nullptr) return std::nullopt;
  if (auto error = set_colours_of_sevens()) return error;
  if (coloured_) {
    append_values<Eigen::Vector3d>(
        mesh_.triangles, 0,
        [this](std::int32_t vertex) { return colours_[static_cast<std::size_t>(vertex)]; },
        attributes_->colours);
  }
  complete(mesh_.triangles.size(), *attributes_);
  return std::nullopt;
}

std::optional<Error> ObjReader::read_statement(std::string_view keyword) {
  if (keyword == "v") return read_vertex();
  if (keyword == "f" || keyword == "fo") return read_face();
  if (keyword == "vt" && attributes_ != nullptr) return read_texture_coordinate();
  if (std::find(kWithoutShape.begin(), kWithoutShape.end(), keyword) != kWithoutShape.end()) {
    // A backslash also joins these lines.
    while (!words_.next_on_line().empty()) {
    }
    return std::nullopt;
  }
  if (std::find(kLines.begin(), kLines.end(), keyword) != kLines.end()) {
    has_lines_ = true;
    while (!words_.next_on_line().empty()) {
    }
    return std::nullopt;
  }
  for (const auto& [refused, what] : kRefused) {
    if (keyword == refused) {
      return words_.error(shown_word(keyword) + ": " + std::string(what) +
                          " are not supported. Save the mesh as polygons in one file.");
    }
  }
  return words_.error(shown_word(keyword) + " is not a statement of an OBJ file.");
}

std::optional<Error> ObjReader::read_vertex() {
  constexpr int kNumbersMax = 7;  // with a colour and its opacity
  std::array<double, kNumbersMax> numbers{};
  int count = 0;
  for (std::string_view word = words_.next_on_line(); !word.empty(); word = words_.next_on_line()) {
    if (count == kNumbersMax) return words_.error("a vertex has at most 7 numbers.");
    const auto number = real_number(word);
    if (!number || (count < 3 && !(std::abs(*number) <= kCoordinateMax))) {
      return words_.error(shown_word(word) + " in vertex " +
                          std::to_string(mesh_.vertices.size() + 1) +
                          " is not a number between -1e15 and 1e15.");
    }
    numbers[static_cast<std::size_t>(count++)] = *number;
  }
  // Three for a position; one for a weight, three for a colour, four for both or with opacity.
  if (count < 3 || count == 5) {
    return words_.error("a vertex has " + std::to_string(count) +
                        " numbers; it needs 3, 4, 6 or 7.");
  }
  if (count == 4 && numbers[3] != 1) {
    return words_.error("vertex weights other than 1 are not supported.");
  }
  if (mesh_.vertices.size() >= std::numeric_limits<std::int32_t>::max()) {
    return words_.error("more than 2^31 - 1 vertices are not supported.");
  }
  mesh_.vertices.emplace_back(numbers[0], numbers[1], numbers[2]);
  if (attributes_ == nullptr) return std::nullopt;
  colours_.push_back(no_value<Eigen::Vector3d>());
  if (count < 6) return std::nullopt;
  if (count == 7) {
    sevens_.push_back({words_.line(),
                       mesh_.vertices.size() - 1,
                       {numbers[3], numbers[4], numbers[5], numbers[6]}});
    return std::nullopt;
  }
  return set_colour(words_.line(), mesh_.vertices.size() - 1,
                    Eigen::Vector3d(numbers[3], numbers[4], numbers[5]));
}

std::optional<Error> ObjReader::set_colour(std::size_t line, std::size_t vertex,
                                           const Eigen::Vector3d& colour) {
  // Written so that NaN is refused.
  if (!(colour.minCoeff() >= 0 && colour.maxCoeff() <= 1) || colour.hasNaN()) {
    return words_.error_at(line, "the colour of vertex " + std::to_string(vertex + 1) +
                                     " is not three numbers from 0 to 1. If the colours of the "
                                     "file are from 0 to 255, divide them by 255, or export the "
                                     "mesh as PLY.");
  }
  colours_[vertex] = colour;
  coloured_ = true;
  return std::nullopt;
}

// Some programs write `x y z w r g b` with a weight of 1, others `x y z r g b a` with the opacity.
// Which one it is follows from the column that is 1 in all vertices.
std::optional<Error> ObjReader::set_colours_of_sevens() {
  const auto always_one = [this](std::size_t k) {
    return std::all_of(sevens_.begin(), sevens_.end(),
                       [k](const Seven& seven) { return seven.rest[k] == 1; });
  };
  const bool weight = always_one(0), opacity = always_one(3);
  if (!sevens_.empty() && weight == opacity) {
    return words_.error_at(
        sevens_.front().line,
        "vertices with 7 numbers may be x y z w r g b (w = 1) or x y z r g b a (a = 1), and here " +
            std::string(weight ? "both fit" : "neither fits") +
            ". Write the colours as v x y z r g b, or export the mesh as PLY.");
  }
  for (const auto& [line, vertex, rest] : sevens_) {
    const std::size_t first = weight ? 1 : 0;
    const Eigen::Vector3d colour(rest[first], rest[first + 1], rest[first + 2]);
    if (auto error = set_colour(line, vertex, colour)) return error;
  }
  return std::nullopt;
}

std::optional<Error> ObjReader::read_texture_coordinate() {
  constexpr int kNumbersMax = 3;  // the third is a depth, which pictures do not have
  Eigen::Vector2d uv(0, 0);
  int count = 0;
  for (std::string_view word = words_.next_on_line(); !word.empty(); word = words_.next_on_line()) {
    const auto number = real_number(word);
    if (count == kNumbersMax || !number || !(std::abs(*number) <= kTextureCoordinateMax)) {
      return words_.error(shown_word(word) + " in texture coordinate " +
                          std::to_string(texture_.size() + 1) +
                          " is not one of at most 3 numbers between -1e6 and 1e6.");
    }
    if (count < 2) uv[count] = *number;
    ++count;
  }
  if (count == 0) return words_.error("a texture coordinate has no number.");
  if (texture_.size() >= std::numeric_limits<std::int32_t>::max()) {
    return words_.error("more than 2^31 - 1 texture coordinates are not supported.");
  }
  texture_.push_back(uv);
  return std::nullopt;
}

std::optional<Error> ObjReader::read_face() {
  corners_.clear();
  textures_.clear();
  const auto known = static_cast<std::int64_t>(mesh_.vertices.size());
  const std::size_t line = words_.line();
  bool early = false;
  for (std::string_view word = words_.next_on_line(); !word.empty(); word = words_.next_on_line()) {
    const auto [vertex, texture] = corner_of(word);
    if (vertex == 0) {
      return words_.error("the face has a corner " + shown_word(word) +
                          "; a corner is V, V/T, V//N or V/T/N.");
    }
    if (vertex < -known || vertex > std::numeric_limits<std::int32_t>::max()) {
      return words_.error("the face refers to vertex " + std::to_string(vertex) +
                          "; so far there are " + std::to_string(known) + ".");
    }
    early = early || vertex > known;
    corners_.push_back(static_cast<std::int32_t>(vertex > 0 ? vertex - 1 : known + vertex));
    if (attributes_ == nullptr) continue;
    const auto known_textures = static_cast<std::int64_t>(texture_.size());
    if (texture < -known_textures || texture > std::numeric_limits<std::int32_t>::max()) {
      return words_.error("the face refers to texture coordinate " + std::to_string(texture) +
                          "; so far there are " + std::to_string(known_textures) + ".");
    }
    early = early || texture > known_textures;
    textures_.push_back(
        static_cast<std::int32_t>(texture >= 0 ? texture - 1 : known_textures + texture));
  }
  if (corners_.empty()) return words_.error("the face has no corners.");
  if (!early) return add_face(line, corners_, textures_);
  early_.push_back({line, early_corners_.size(), corners_.size()});
  early_corners_.insert(early_corners_.end(), corners_.begin(), corners_.end());
  early_textures_.insert(early_textures_.end(), textures_.begin(), textures_.end());
  return std::nullopt;
}

std::optional<Error> ObjReader::add_face(std::size_t line, std::span<const std::int32_t> corners,
                                         std::span<const std::int32_t> textures) {
  if (corners.size() < 3) {
    has_lines_ = true;
    return std::nullopt;
  }
  const std::size_t first = mesh_.triangles.size();
  if (!triangulate_polygon(mesh_.vertices, corners, mesh_.triangles)) {
    return words_.error_at(line, too_many_corners("the face", corners.size()));
  }
  bool named = false;
  for (const std::int32_t texture : textures) {
    named = named || texture >= 0;
    if (texture < static_cast<std::int64_t>(texture_.size())) continue;
    return words_.error_at(line, "the face refers to texture coordinate " +
                                     std::to_string(std::int64_t{texture} + 1) + "; the file has " +
                                     std::to_string(texture_.size()) + ".");
  }
  if (!named) return std::nullopt;
  const PolygonCorners places(corners);
  append_values<Eigen::Vector2d>(
      mesh_.triangles, first,
      [&](std::int32_t vertex) {
        const std::int32_t texture = textures[places.of(vertex)];
        return texture < 0 ? no_value<Eigen::Vector2d>()
                           : texture_[static_cast<std::size_t>(texture)];
      },
      attributes_->uv);
  return std::nullopt;
}

}  // namespace

driver::Result<TriangleMesh> read_obj(std::string_view text, const std::string& name,
                                      std::vector<std::string>& notes, MeshAttributes* attributes) {
  if (text.empty()) return Error{"the file is empty."};
  ObjReader reader(text, name, attributes);
  if (auto error = reader.read()) return *error;
  TriangleMesh mesh = reader.take();
  if (mesh.triangles.empty()) return Error{"it has no face with three corners."};
  if (reader.has_lines()) {
    notes.push_back("Lines and points were ignored: only faces can be touched.");
  }
  return mesh;
}

}  // namespace thimble::render
