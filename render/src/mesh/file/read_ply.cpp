#include "mesh/file/read_ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mesh/file/corner_values.h"
#include "mesh/file/read_off.h"  // kCoordinateMax
#include "mesh/file/single_precision.h"
#include "mesh/file/text_words.h"
#include "mesh/file/triangulate_polygon.h"

namespace thimble::render {
namespace {

using driver::Error;

enum class Form { kText, kLittle, kBig };

// The types of PLY, by their first names and by those with their size [Turk, the PLY format].
struct NumberType {
  std::string_view name, other_name;
  std::size_t size;
  char kind;  // i: signed, u: unsigned, f: floating
};
constexpr std::array<NumberType, 8> kTypes{{{"char", "int8", 1, 'i'},
                                            {"uchar", "uint8", 1, 'u'},
                                            {"short", "int16", 2, 'i'},
                                            {"ushort", "uint16", 2, 'u'},
                                            {"int", "int32", 4, 'i'},
                                            {"uint", "uint32", 4, 'u'},
                                            {"float", "float32", 4, 'f'},
                                            {"double", "float64", 8, 'f'}}};

const NumberType* type_of(std::string_view name) {
  const auto* found = std::find_if(kTypes.begin(), kTypes.end(), [&](const NumberType& type) {
    return type.name == name || type.other_name == name;
  });
  return found == kTypes.end() ? nullptr : found;
}

struct Property {
  std::string_view name;
  const NumberType* type = nullptr;
  const NumberType* count = nullptr;  // of a list
};

struct Element {
  std::string_view name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::optional<Form> form;
  std::vector<Element> elements;
};

std::string shown(std::string_view word) {
  std::string text = "\"";
  for (const char c : word.substr(0, 40)) text += c >= ' ' && c < 127 ? c : '?';
  return text + '"';
}

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

std::string_view next_word(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && is_space(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_space(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

std::optional<Error> take_line(std::string_view line, std::size_t bytes, Header& header) {
  const std::string_view whole = line;
  const std::string_view keyword = next_word(line);
  if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return std::nullopt;
  if (keyword == "format") {
    const std::string_view form = next_word(line);
    if (form == "ascii") header.form = Form::kText;
    if (form == "binary_little_endian") header.form = Form::kLittle;
    if (form == "binary_big_endian") header.form = Form::kBig;
    if (!header.form) return Error{"its header has an unknown format " + shown(form) + "."};
    return std::nullopt;
  }
  if (keyword == "element") {
    const std::string_view name = next_word(line);
    const auto count = whole_number(next_word(line));
    if (!count || *count < 0) {
      return Error{"its header has no valid count in " + shown(whole) + "."};
    }
    // The smallest element is a byte.
    if (static_cast<std::uint64_t>(*count) > bytes) {
      return Error{"its header declares " + std::to_string(*count) + " of " + shown(name) +
                   " but the file has only " + std::to_string(bytes) + " bytes: it is truncated."};
    }
    header.elements.push_back({name, *count, {}});
    return std::nullopt;
  }
  if (keyword == "property" && !header.elements.empty()) {
    Property property;
    std::string_view type = next_word(line);
    if (type == "list") {
      property.count = type_of(next_word(line));
      type = next_word(line);
      if (property.count == nullptr || property.count->kind == 'f') {
        return Error{"its header has a list without a count in " + shown(whole) + "."};
      }
    }
    property.type = type_of(type);
    property.name = next_word(line);
    if (property.type == nullptr || property.name.empty()) {
      return Error{"its header has an unknown property " + shown(whole) + "."};
    }
    header.elements.back().properties.push_back(property);
    return std::nullopt;
  }
  return Error{"its header has an unknown line: " + shown(whole) + "."};
}

// Reads the header and returns the remaining bytes in `rest`.
driver::Result<Header> read_header(std::string_view& rest) {
  const std::size_t bytes = rest.size();
  Header header;
  bool first = true;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (first && line != "ply") break;
    if (line == "end_header" && header.form) return header;
    if (!first) {
      if (auto error = take_line(line, bytes, header)) return *error;
    }
    first = false;
  }
  return Error{"not a readable PLY file: its header has no end_header."};
}

// Returns numbers one by one; empty at the end of the file or for other contents.
class Numbers {
 public:
  Numbers(std::string_view rest, Form form) : rest_(rest), form_(form) {}

  std::optional<double> next(const NumberType& type) {
    if (form_ == Form::kText) return real_number(next_word(rest_));
    if (rest_.size() < type.size) return std::nullopt;
    std::array<unsigned char, 8> bytes{};
    std::memcpy(bytes.data(), rest_.data(), type.size);
    rest_.remove_prefix(type.size);
    const bool little = std::endian::native == std::endian::little;
    if ((form_ == Form::kLittle) != little) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.size));
    }
    if (type.kind == 'f') return type.size == 8 ? as<double>(bytes) : as<float>(bytes);
    const bool with_sign = type.kind == 'i';
    if (type.size == 1) return with_sign ? as<std::int8_t>(bytes) : as<std::uint8_t>(bytes);
    if (type.size == 2) return with_sign ? as<std::int16_t>(bytes) : as<std::uint16_t>(bytes);
    return with_sign ? as<std::int32_t>(bytes) : as<std::uint32_t>(bytes);
  }

  // Returns whether `count` more numbers are possible.
  bool may_hold(double count) const { return count <= static_cast<double>(rest_.size()); }

 private:
  template <class Number>
  static double as(const std::array<unsigned char, 8>& bytes) {
    Number number;
    std::memcpy(&number, bytes.data(), sizeof number);
    return static_cast<double>(number);
  }

  std::string_view rest_;
  Form form_;
};

Error ends_in(const Element& element, std::int64_t number) {
  return Error{"the file ends or has a value that is not a number in " +
               std::string(element.name.substr(0, 20)) + " " + std::to_string(number) + " of " +
               std::to_string(element.count) + ": it is truncated or damaged."};
}

// Reads one property and hands each of its numbers to `take`.
template <class Take>
bool read_property(const Property& property, Numbers& numbers, Take&& take) {
  std::size_t count = 1;
  if (property.count != nullptr) {
    const auto counted = numbers.next(*property.count);
    if (!counted || !(*counted >= 0 && *counted == std::floor(*counted))) return false;
    if (!numbers.may_hold(*counted)) return false;
    count = static_cast<std::size_t>(*counted);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = numbers.next(*property.type);
    if (!value) return false;
    take(*value);
  }
  return true;
}

// Texture coordinates and colours of the vertices of a file.
class VertexValues {
 public:
  // Finds the properties of the vertices.
  explicit VertexValues(const Header& header) {
    for (const Element& element : header.elements) {
      if (element.name != "vertex") continue;
      for (const auto& [u, v] : kCoordinates) {
        if (uv_[0] == nullptr) uv_ = {property(element, u), property(element, v)};
        if (uv_[0] == nullptr || uv_[1] == nullptr) uv_ = {};
      }
      colour_ = {property(element, "red"), property(element, "green"), property(element, "blue")};
      if (colour_[0] == nullptr || colour_[1] == nullptr || colour_[2] == nullptr) colour_ = {};
    }
  }

  // Begins the next vertex.
  void begin() {
    if (uv_[0] != nullptr) uv_values_.emplace_back(0, 0);
    if (colour_[0] != nullptr) colour_values_.emplace_back(0, 0, 0);
  }
  // Receives a number of the vertex.
  void take(const Property& property, double value) {
    for (std::size_t k = 0; k < uv_.size(); ++k) {
      if (&property == uv_[k]) uv_values_.back()[static_cast<Eigen::Index>(k)] = value;
    }
    for (std::size_t k = 0; k < colour_.size(); ++k) {
      if (&property != colour_[k]) continue;
      colour_values_.back()[static_cast<Eigen::Index>(k)] = value / full(*property.type);
    }
  }
  // Returns what is wrong with the values of the last vertex; empty if nothing is.
  std::string_view wrong() const {
    // Written so that NaN is wrong.
    if (!uv_values_.empty()) {
      const Eigen::Vector2d& uv = uv_values_.back();
      if (!(std::abs(uv[0]) <= kTextureCoordinateMax && std::abs(uv[1]) <= kTextureCoordinateMax)) {
        return "a texture coordinate that is not a number between -1e6 and 1e6";
      }
    }
    if (!colour_values_.empty()) {
      for (const double share : colour_values_.back()) {
        if (!(share >= 0 && share <= 1)) {
          return "a colour that is not three numbers from 0 to 1. Write colours as uchar from 0 to "
                 "255, or as float from 0 to 1";
        }
      }
    }
    return {};
  }
  // Hands the values out to the corners of a mesh. Faces with coordinates of their own keep them.
  void give(const TriangleMesh& mesh, MeshAttributes& attributes) const {
    const auto of = [](const auto& values) {
      return [&values](std::int32_t vertex) { return values[static_cast<std::size_t>(vertex)]; };
    };
    if (!uv_values_.empty() && attributes.uv.empty()) {
      append_values(mesh.triangles, 0, of(uv_values_), attributes.uv);
    }
    if (!colour_values_.empty()) {
      append_values(mesh.triangles, 0, of(colour_values_), attributes.colours);
    }
  }

 private:
  // Names used by Blender, MeshLab and others. [S exporters of Blender 3.4 and MeshLab 2022.02]
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kCoordinates{
      {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};

  static const Property* property(const Element& element, std::string_view name) {
    const auto found = std::find_if(
        element.properties.begin(), element.properties.end(),
        [name](const Property& one) { return one.name == name && one.count == nullptr; });
    return found == element.properties.end() ? nullptr : &*found;
  }
  // Returns the value of a colour at full brightness: the largest integer, or 1.
  static double full(const NumberType& type) {
    if (type.kind == 'f') return 1;
    const int bits = static_cast<int>(8 * type.size) - (type.kind == 'i' ? 1 : 0);
    return std::ldexp(1, bits) - 1;
  }

  std::array<const Property*, 2> uv_{};
  std::array<const Property*, 3> colour_{};
  std::vector<Eigen::Vector2d> uv_values_;
  std::vector<Eigen::Vector3d> colour_values_;
};

// `values` is null if texture coordinates and colours are not read.
std::optional<Error> read_vertex(const Element& element, std::int64_t number, Numbers& numbers,
                                 TriangleMesh& mesh, VertexValues* values) {
  Eigen::Vector3d vertex(0, 0, 0);
  if (values != nullptr) values->begin();
  for (const Property& property : element.properties) {
    const std::size_t axis = std::string_view("xyz").find(property.name);
    const bool wanted = property.name.size() == 1 && axis != std::string_view::npos;
    const auto take = [&](double value) {
      if (wanted) vertex[static_cast<Eigen::Index>(axis)] = value;
      if (values != nullptr) values->take(property, value);
    };
    if (!read_property(property, numbers, take)) return ends_in(element, number);
  }
  for (const double x : vertex) {
    if (!(std::abs(x) <= kCoordinateMax)) {
      return Error{"vertex " + std::to_string(number) +
                   " has a coordinate that is not a number between -1e15 and 1e15."};
    }
  }
  if (values != nullptr && !values->wrong().empty()) {
    return Error{"vertex " + std::to_string(number) + " has " + std::string(values->wrong()) + "."};
  }
  mesh.vertices.push_back(vertex);
  return std::nullopt;
}

// Texture coordinates in a list of each face, u and v per corner, as MeshLab writes them. [S
// MeshLab 2022.02, wedge coordinates]
constexpr std::string_view kFaceCoordinates = "texcoord";

// Appends the texture coordinates `list` of the corners of a face to its triangles, from `first`
// on.
std::optional<Error> add_face_coordinates(std::int64_t number,
                                          const std::vector<std::int32_t>& corners,
                                          const std::vector<double>& list, std::size_t first,
                                          const TriangleMesh& mesh, MeshAttributes& attributes) {
  const std::string face = "face " + std::to_string(number);
  if (list.size() != 2 * corners.size()) {
    return Error{face + " has " + std::to_string(list.size()) + " texture coordinates for " +
                 std::to_string(corners.size()) +
                 " corners; texcoord needs two for each. Export the mesh again, or as OBJ."};
  }
  for (const double one : list) {
    // Written so that NaN is refused.
    if (std::abs(one) <= kTextureCoordinateMax) continue;
    return Error{face + " has a texture coordinate that is not a number between -1e6 and 1e6."};
  }
  const PolygonCorners places(corners);
  append_values<Eigen::Vector2d>(
      mesh.triangles, first,
      [&](std::int32_t vertex) {
        const std::size_t k = places.of(vertex);
        return Eigen::Vector2d(list[2 * k], list[2 * k + 1]);
      },
      attributes.uv);
  return std::nullopt;
}

// `attributes` is null if texture coordinates are not read.
std::optional<Error> read_face(const Element& element, std::int64_t number, Numbers& numbers,
                               std::vector<std::int32_t>& corners, TriangleMesh& mesh,
                               MeshAttributes* attributes) {
  corners.clear();
  std::vector<double> coordinates;
  bool there = true;
  const auto most = static_cast<double>(mesh.vertices.size());
  for (const Property& property : element.properties) {
    const bool wanted = property.name == "vertex_indices" || property.name == "vertex_index";
    const bool placed = attributes != nullptr && property.name == kFaceCoordinates;
    const auto take = [&](double value) {
      if (placed) coordinates.push_back(value);
      if (!wanted) return;
      const bool whole = value >= 0 && value < most && value == std::floor(value);
      there = there && whole;
      corners.push_back(whole ? static_cast<std::int32_t>(value) : 0);
    };
    if (!read_property(property, numbers, take)) return ends_in(element, number);
  }
  if (!there) {
    return Error{"face " + std::to_string(number) + " refers to a vertex that does not exist."};
  }
  const std::size_t first = mesh.triangles.size();
  if (corners.size() >= 3 && !triangulate_polygon(mesh.vertices, corners, mesh.triangles)) {
    return Error{too_many_corners("face " + std::to_string(number), corners.size())};
  }
  if (coordinates.empty() || corners.size() < 3) return std::nullopt;
  return add_face_coordinates(number, corners, coordinates, first, mesh, *attributes);
}

// Refuses elements whose data would be missing or wrong in the mesh.
std::optional<Error> check_elements(const Header& header) {
  for (const Element& element : header.elements) {
    if (element.name == "tristrips" && element.count > 0) {
      return Error{
          "it has triangle strips (tristrips), which are not supported. Save it with faces."};
    }
    if (element.name != "vertex" || element.count == 0) continue;
    for (const std::string_view axis : {"x", "y", "z"}) {
      const auto named = [axis](const Property& property) {
        return property.name == axis && property.count == nullptr;
      };
      if (std::count_if(element.properties.begin(), element.properties.end(), named) == 1) continue;
      return Error{"its vertices do not have exactly one number " + std::string(axis) + "."};
    }
  }
  return std::nullopt;
}

// Returns whether the coordinates are in single precision: a text keeps all its digits.
bool is_single(const Header& header) {
  if (*header.form == Form::kText) return false;
  for (const Element& element : header.elements) {
    for (const Property& property : element.properties) {
      const bool axis = property.name == "x" || property.name == "y" || property.name == "z";
      if (element.name == "vertex" && axis && property.type->kind == 'f' &&
          property.type->size == sizeof(float)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

driver::Result<TriangleMesh> read_ply(std::string_view bytes, std::vector<std::string>& notes,
                                      MeshAttributes* attributes) {
  if (bytes.empty()) return Error{"the file is empty."};
  std::string_view rest = bytes;
  const auto header = read_header(rest);
  if (!header) return header.error();
  if (auto error = check_elements(*header)) return *error;
  TriangleMesh mesh;
  std::optional<VertexValues> values;
  if (attributes != nullptr) values.emplace(*header);
  std::vector<std::int32_t> corners;
  Numbers numbers(rest, *header->form);
  for (const Element& element : header->elements) {
    if (element.name == "vertex" && element.count > std::numeric_limits<std::int32_t>::max()) {
      return Error{"it has more than 2^31 - 1 vertices."};
    }
    if (element.properties.empty()) continue;  // has no bytes
    for (std::int64_t i = 0; i < element.count; ++i) {
      std::optional<Error> error;
      if (element.name == "vertex") {
        error = read_vertex(element, i, numbers, mesh, values ? &*values : nullptr);
      } else if (element.name == "face") {
        error = read_face(element, i, numbers, corners, mesh, attributes);
      } else {
        for (const Property& property : element.properties) {
          if (!read_property(property, numbers, [](double) {})) return ends_in(element, i);
        }
      }
      if (error) return *error;
    }
  }
  if (mesh.triangles.empty()) return Error{"it has no face with three corners."};
  if (is_single(*header)) {
    SinglePrecision precision;
    for (const Eigen::Vector3d& vertex : mesh.vertices) precision.add(vertex);
    if (auto kept = precision.judge(mesh, notes); !kept) return kept.error();
  }
  if (values) {
    values->give(mesh, *attributes);
    complete(mesh.triangles.size(), *attributes);
  }
  return mesh;
}

}  // namespace thimble::render
