#include "mesh/file/gltf/read_gltf.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/file/corner_values.h"
#include "mesh/file/gltf/gltf_buffers.h"
#include "mesh/file/mesh_kind.h"
#include "mesh/file/mesh_parts.h"
#include "mesh/file/read_in_child.h"
#include "mesh/file/read_with_assimp.h"
#include "mesh/file/text_words.h"
#include "system/regular_file.h"

namespace thimble::render {
namespace {

using driver::Error;
using Eigen::Affine3d;
using Json = nlohmann::json;

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kTextureTransform = "KHR_texture_transform";

// Required extensions that are read, or that do not change the shape; in addition to those of
// materials.
constexpr std::array<std::string_view, 12> kKnownExtensions{kInstancing,
                                                            "KHR_mesh_quantization",
                                                            kTextureTransform,
                                                            "KHR_texture_basisu",
                                                            "EXT_texture_webp",
                                                            "EXT_texture_avif",
                                                            "MSFT_texture_dds",
                                                            "KHR_lights_punctual",
                                                            "EXT_lights_image_based",
                                                            "KHR_xmp_json_ld",
                                                            "KHR_xmp",
                                                            "KHR_animation_pointer"};

// Limits of reading: a small file may name large files in its folder.
constexpr driver::SandboxLimits kGltfLimits{.seconds = 20, .bytes = std::size_t{4} << 30};

// Modes of primitives [glTF 2.0, 3.7.2.1].
constexpr std::size_t kTriangles = 4, kStrip = 5, kFan = 6;

// Reads the JSON and the binary chunk of a GLB file.
driver::Result<std::pair<std::string_view, std::string_view>> chunks_of(std::string_view bytes) {
  constexpr std::size_t kGlbHead = 12, kChunkHead = 8;
  const auto number = [bytes](std::size_t at) {
    std::uint32_t value = 0;
    if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
    return std::size_t{value};
  };
  if (bytes.size() < kGlbHead + kChunkHead) return unreadable("glb", "it is truncated");
  std::pair<std::string_view, std::string_view> chunks;
  for (std::size_t at = kGlbHead; at + kChunkHead <= bytes.size();) {
    const std::size_t length = number(at);
    if (length > bytes.size() - at - kChunkHead) return unreadable("glb", "it is truncated");
    const std::string_view chunk = bytes.substr(at + kChunkHead, length);
    if (bytes.substr(at + 4, 4) == "JSON" && chunks.first.empty()) chunks.first = chunk;
    if (bytes.substr(at + 4, 4) == std::string_view("BIN\0", 4) && chunks.second.empty()) {
      chunks.second = chunk;
    }
    at += kChunkHead + length;
  }
  if (chunks.first.empty()) return unreadable("glb", "it has no JSON chunk");
  return chunks;
}

class GltfReader {
 public:
  GltfReader(const Json& gltf, std::string_view chunk, const std::filesystem::path& folder,
             std::string kind, MeshAttributes* attributes)
      : gltf_(gltf),
        buffers_(gltf, chunk, folder),
        kind_(std::move(kind)),
        attributes_(attributes) {}

  driver::Result<TriangleMesh> read(std::vector<std::string>& notes);

 private:
  /// A node to be visited, and the place of its parent.
  struct Stop {
    std::size_t node = 0;
    Affine3d place = Affine3d::Identity();
  };
  struct Primitive {
    TriangleMesh mesh;
    bool single = false;
    MeshAttributes attributes;
  };

  std::optional<Error> check_extensions() const;
  // Returns whether the file requires that texture coordinates are transformed.
  bool places_textures() const;
  driver::Result<std::vector<std::size_t>> roots() const;
  std::optional<Error> add_node(const Json& node, const Affine3d& place);
  std::optional<Error> add_primitive(const Json& primitive, const Json* weights,
                                     const std::vector<Affine3d>& places);
  std::optional<Error> add_targets(const Json& primitive, const Json& weights, Primitive& part);
  std::optional<Error> read_triangles(const Json& primitive, std::size_t mode, Primitive& part);
  std::optional<Error> read_attributes(const Json& attributes, Primitive& part);
  driver::Result<std::vector<Affine3d>> instances(const Json& node, const Affine3d& place);
  driver::Result<Affine3d> place_of(const Json& node) const;
  Error damaged(const std::string& reason) const { return unreadable(kind_, reason); }

  const Json& gltf_;
  GltfBuffers buffers_;
  std::string kind_;
  MeshAttributes* attributes_;
  MeshParts parts_;
  bool moves_ = false, lines_ = false, morphed_ = false;
};

// Returns the array at a pointer; an empty one if it is null.
const Json& elements_of(const Json* array) {
  static const Json kNone = Json::array();
  return array != nullptr && array->is_array() ? *array : kNone;
}

// Returns the numbers of an array, or `fallback` if it is absent; empty for anything else.
template <std::size_t kCount>
std::optional<std::array<double, kCount>> numbers_of(const Json& node, const char* key,
                                                     std::array<double, kCount> fallback) {
  const Json* const array = json_member(node, key);
  if (array == nullptr) return fallback;
  if (!array->is_array() || array->size() != kCount) return std::nullopt;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (!(*array)[i].is_number()) return std::nullopt;
    fallback[i] = (*array)[i].get<double>();
  }
  return fallback;
}

// Returns translation times rotation times scale; empty if the rotation is not valid.
std::optional<Affine3d> composed(const std::array<double, 3>& t, const std::array<double, 4>& r,
                                 const std::array<double, 3>& s) {
  const Eigen::Quaterniond rotation(r[3], r[0], r[1], r[2]);
  if (!(rotation.norm() > 0)) return std::nullopt;
  Affine3d place = Affine3d::Identity();
  place.linear() =
      rotation.normalized().toRotationMatrix() * Eigen::Vector3d(s[0], s[1], s[2]).asDiagonal();
  place.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
  return place;
}

driver::Result<Affine3d> GltfReader::place_of(const Json& node) const {
  if (json_member(node, "matrix") != nullptr) {
    const auto m = numbers_of<16>(node, "matrix", {});
    if (!m) return damaged("a node has a matrix that is not 16 numbers");
    Affine3d place = Affine3d::Identity();
    for (std::size_t i = 0; i < 16; ++i) {
      if (i % 4 == 3) continue;
      place.matrix()(static_cast<Eigen::Index>(i % 4), static_cast<Eigen::Index>(i / 4)) = (*m)[i];
    }
    return place;
  }
  const auto t = numbers_of<3>(node, "translation", {0, 0, 0});
  const auto r = numbers_of<4>(node, "rotation", {0, 0, 0, 1});
  const auto s = numbers_of<3>(node, "scale", {1, 1, 1});
  if (!t || !r || !s) return damaged("a node has a pose that does not consist of numbers");
  const auto place = composed(*t, *r, *s);
  if (!place) return damaged("a node has a rotation of length 0");
  return *place;
}

std::optional<Error> GltfReader::check_extensions() const {
  const Json* const required = json_member(gltf_, "extensionsRequired");
  if (required == nullptr || !required->is_array()) return std::nullopt;
  for (const Json& extension : *required) {
    if (!extension.is_string()) return damaged("it requires an extension without a name");
    const auto& name = extension.get_ref<const std::string&>();
    // Draco is refused only if a primitive has nothing else.
    const bool known =
        name.starts_with("KHR_materials_") || name == kDraco ||
        std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) != kKnownExtensions.end();
    if (!known) {
      return Error{"it requires the glTF extension " + shown_word(name) +
                   ", which is not supported. Export the mesh without it."};
    }
  }
  return std::nullopt;
}

bool GltfReader::places_textures() const {
  const Json* const required = json_member(gltf_, "extensionsRequired");
  const Json& names = elements_of(required);
  return std::any_of(names.begin(), names.end(), [](const Json& name) {
    return name.is_string() && name.get_ref<const std::string&>() == kTextureTransform;
  });
}

driver::Result<std::vector<std::size_t>> GltfReader::roots() const {
  const Json* const nodes = json_member(gltf_, "nodes");
  const std::size_t count = nodes != nullptr && nodes->is_array() ? nodes->size() : 0;
  std::vector<std::size_t> roots;
  if (json_member(gltf_, "scenes") == nullptr) {
    // No scene: all nodes that are not children.
    std::vector<bool> child(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Json* const children = json_member((*nodes)[i], "children");
      for (const Json& number : elements_of(children)) {
        if (number.is_number_unsigned() && number.get<std::size_t>() < count) {
          child[number.get<std::size_t>()] = true;
        }
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!child[i]) roots.push_back(i);
    }
    return roots;
  }
  const Json* const scene = gltf_element(gltf_, "scenes", json_index(gltf_, "scene").value_or(0));
  if (scene == nullptr) return damaged("its scene does not exist");
  const Json* const named = json_member(*scene, "nodes");
  for (const Json& number : elements_of(named)) {
    if (!number.is_number_unsigned()) return damaged("its scene lists an invalid node");
    roots.push_back(number.get<std::size_t>());
  }
  return roots;
}

driver::Result<TriangleMesh> GltfReader::read(std::vector<std::string>& notes) {
  if (auto unknown = check_extensions()) return *unknown;
  const auto first = roots();
  if (!first) return first.error();
  std::vector<Stop> stops;
  for (std::size_t i = first->size(); i-- > 0;) stops.push_back({(*first)[i]});
  std::vector<bool> visited;
  while (!stops.empty()) {
    const Stop stop = stops.back();
    stops.pop_back();
    const Json* const node = gltf_element(gltf_, "nodes", stop.node);
    if (node == nullptr) return damaged("node " + std::to_string(stop.node) + " does not exist");
    if (visited.size() <= stop.node) visited.resize(stop.node + 1);
    if (visited[stop.node]) {
      return damaged("node " + std::to_string(stop.node) + " is a child of two nodes");
    }
    visited[stop.node] = true;
    const auto own = place_of(*node);
    if (!own) return own.error();
    const Affine3d place = stop.place * *own;
    if (auto wrong = add_node(*node, place)) return *wrong;
    const Json* const children = json_member(*node, "children");
    if (children == nullptr || !children->is_array()) continue;
    // The first child on top: parts stay in the file's order.
    for (std::size_t i = children->size(); i-- > 0;) {
      if (!(*children)[i].is_number_unsigned()) return damaged("a node lists an invalid child");
      stops.push_back({(*children)[i].get<std::size_t>(), place});
    }
  }
  auto mesh = parts_.take(notes);
  if (!mesh) return mesh;
  if (attributes_ != nullptr) *attributes_ = parts_.take_attributes();
  const Json* const animations = json_member(gltf_, "animations");
  if (moves_ || (animations != nullptr && !animations->empty())) {
    notes.push_back("Bones and animations were ignored: the mesh is in its rest pose.");
  }
  if (morphed_) notes.push_back("Morph targets were applied with the weights of the file.");
  if (lines_) notes.push_back("Lines and points were ignored: only faces can be touched.");
  return mesh;
}

driver::Result<std::vector<Affine3d>> GltfReader::instances(const Json& node,
                                                            const Affine3d& place) {
  const Json* const extensions = json_member(node, "extensions");
  const Json* const instancing =
      extensions != nullptr ? json_member(*extensions, kInstancing) : nullptr;
  if (instancing == nullptr) return std::vector<Affine3d>{place};
  const Json* const attributes = json_member(*instancing, "attributes");
  if (attributes == nullptr) return damaged("its instances have no attributes");
  std::array<std::vector<double>, 3> values;  // translations, rotations, scales
  constexpr std::array<std::pair<const char*, std::size_t>, 3> kNames{
      {{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}}};
  std::optional<std::size_t> count;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto& [name, columns] = kNames[i];
    if (json_member(*attributes, name) == nullptr) continue;
    const auto accessor = json_index(*attributes, name);
    if (!accessor) return damaged(std::string("its instances have no accessor for ") + name);
    auto numbers = buffers_.read(*accessor, columns);
    if (!numbers) return damaged(numbers.error().message);
    values[i] = std::move(numbers->values);
    const std::size_t own = values[i].size() / columns;
    if (count && *count != own) return damaged("its instance attributes differ in length");
    count = own;
  }
  if (!count) return damaged("its instances have no pose");
  std::vector<Affine3d> places;
  for (std::size_t i = 0; i < *count; ++i) {
    std::array<double, 3> t{0, 0, 0}, s{1, 1, 1};
    std::array<double, 4> r{0, 0, 0, 1};
    const auto take = [i](const std::vector<double>& from, auto& to) {
      if (from.empty()) return;
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(i * to.size()), to.size(), to.begin());
    };
    take(values[0], t);
    take(values[1], r);
    take(values[2], s);
    const auto own = composed(t, r, s);
    if (!own) return damaged("an instance has a rotation of length 0");
    places.push_back(place * *own);
  }
  return places;
}

std::optional<Error> GltfReader::add_node(const Json& node, const Affine3d& place) {
  if (json_member(node, "mesh") == nullptr) return std::nullopt;
  const auto number = json_index(node, "mesh");
  const Json* const mesh = number ? gltf_element(gltf_, "meshes", *number) : nullptr;
  if (mesh == nullptr) return damaged("a node refers to a mesh that does not exist");
  moves_ = moves_ || json_member(node, "skin") != nullptr;
  const Json* weights = json_member(node, "weights");
  if (weights == nullptr) weights = json_member(*mesh, "weights");
  const auto places = instances(node, place);
  if (!places) return places.error();
  const Json* const primitives = json_member(*mesh, "primitives");
  for (const Json& primitive : elements_of(primitives)) {
    if (auto wrong = add_primitive(primitive, weights, *places)) return wrong;
  }
  return std::nullopt;
}

std::optional<Error> GltfReader::add_primitive(const Json& primitive, const Json* weights,
                                               const std::vector<Affine3d>& places) {
  const bool named = json_member(primitive, "mode") != nullptr;
  const std::size_t mode = json_index(primitive, "mode").value_or(named ? kFan + 1 : kTriangles);
  if (mode < kTriangles) {
    lines_ = true;
    return std::nullopt;
  }
  if (mode > kFan) return damaged("a primitive has an unknown mode");
  const Json* const attributes = json_member(primitive, "attributes");
  const auto accessor = attributes != nullptr ? json_index(*attributes, "POSITION") : std::nullopt;
  if (!accessor) return damaged("a primitive has no positions");
  const Json* const extensions = json_member(primitive, "extensions");
  const Json* const positions = gltf_element(gltf_, "accessors", *accessor);
  if (extensions != nullptr && json_member(*extensions, kDraco) != nullptr &&
      (positions == nullptr || json_member(*positions, "bufferView") == nullptr)) {
    return Error{std::string("it is compressed with the glTF extension ") + kDraco +
                 ", which is not supported. Export the mesh without it."};
  }
  const auto numbers = buffers_.read(*accessor, 3);
  if (!numbers) return damaged(numbers.error().message);
  Primitive part;
  part.single = numbers->single;
  const std::size_t count = numbers->values.size() / 3;
  if (count > std::numeric_limits<std::int32_t>::max()) {
    return Error{"it has more than 2^31 - 1 vertices."};
  }
  part.mesh.vertices.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    part.mesh.vertices[i] = Eigen::Vector3d::Map(numbers->values.data() + 3 * i);
  }
  if (weights != nullptr) {
    if (auto wrong = add_targets(primitive, *weights, part)) return wrong;
  }
  if (auto wrong = read_triangles(primitive, mode, part)) return wrong;
  if (attributes_ != nullptr) {
    if (auto wrong = read_attributes(*attributes, part)) return wrong;
  }
  for (const Affine3d& place : places) {
    if (auto added = parts_.add(part.mesh, place, part.single, &part.attributes); !added) {
      return added.error();
    }
  }
  return std::nullopt;
}

std::optional<Error> GltfReader::read_attributes(const Json& attributes, Primitive& part) {
  // Reads an accessor with an element per vertex; no numbers if the primitive does not name it.
  const auto read = [&](const char* name, std::initializer_list<std::size_t> columns,
                        std::size_t& width) -> driver::Result<std::vector<double>> {
    if (json_member(attributes, name) == nullptr) return std::vector<double>();
    const auto accessor = json_index(attributes, name);
    driver::Result<GltfNumbers> numbers(Error{"its accessor is not a number"});
    for (const std::size_t one : columns) {
      if (accessor && !numbers) numbers = buffers_.read(*accessor, width = one);
    }
    if (!numbers) return damaged(std::string(name) + ": " + numbers.error().message);
    if (numbers->values.size() != width * part.mesh.vertices.size()) {
      return damaged(std::string(name) + " and the positions differ in the number of vertices");
    }
    return std::move(numbers->values);
  };
  std::size_t width = 0;
  const auto uv = read("TEXCOORD_0", {2}, width);
  if (!uv) return uv.error();
  // Written so that NaN is refused.
  for (std::size_t i = 0; i < uv->size(); ++i) {
    if (std::abs((*uv)[i]) <= kTextureCoordinateMax) continue;
    return Error{"TEXCOORD_0 of vertex " + std::to_string(i / 2) +
                 " of a primitive has a value that is not a number between -1e6 and 1e6. Unwrap "
                 "the mesh again and export it."};
  }
  if (!uv->empty() && places_textures()) {
    return Error{std::string("it requires the glTF extension ") + kTextureTransform +
                 ", which is not applied to texture coordinates. Apply it in the program that made "
                 "the file, and export the mesh without it."};
  }
  if (!uv->empty()) {
    const auto of = [&](std::int32_t vertex) {
      const double* const at = uv->data() + 2 * static_cast<std::size_t>(vertex);
      // The first row of a picture is at v = 0 [Khronos, glTF 2.0, 3.8.3].
      return Eigen::Vector2d(at[0], 1 - at[1]);
    };
    append_values<Eigen::Vector2d>(part.mesh.triangles, 0, of, part.attributes.uv);
  }
  const auto colours = read("COLOR_0", {3, 4}, width);
  if (!colours) return colours.error();
  for (std::size_t i = 0; i < colours->size(); ++i) {
    if ((*colours)[i] >= 0 && (*colours)[i] <= 1) continue;
    return Error{"COLOR_0 of vertex " + std::to_string(i / width) +
                 " of a primitive has a value that is not a number from 0 to 1. Export colours as "
                 "floats from 0 to 1, or as normalized integers."};
  }
  if (!colours->empty()) {
    const auto of = [&](std::int32_t vertex) {
      const double* const at = colours->data() + width * static_cast<std::size_t>(vertex);
      return Eigen::Vector3d(at[0], at[1], at[2]);
    };
    append_values<Eigen::Vector3d>(part.mesh.triangles, 0, of, part.attributes.colours);
  }
  return std::nullopt;
}

std::optional<Error> GltfReader::add_targets(const Json& primitive, const Json& weights,
                                             Primitive& part) {
  const Json* const targets = json_member(primitive, "targets");
  if (targets == nullptr || !targets->is_array()) return std::nullopt;
  for (std::size_t i = 0; i < targets->size(); ++i) {
    if (!weights.is_array() || i >= weights.size()) break;
    if (!weights[i].is_number()) return damaged("a weight of a morph target is not a number");
    const double weight = weights[i].get<double>();
    if (weight == 0 || json_member((*targets)[i], "POSITION") == nullptr) continue;
    const auto accessor = json_index((*targets)[i], "POSITION");
    if (!accessor) return damaged("a morph target has no accessor");
    const auto moved = buffers_.read(*accessor, 3);
    if (!moved) return damaged(moved.error().message);
    if (moved->values.size() != 3 * part.mesh.vertices.size()) {
      return damaged("a morph target and its mesh differ in the number of vertices");
    }
    for (std::size_t v = 0; v < part.mesh.vertices.size(); ++v) {
      part.mesh.vertices[v] += weight * Eigen::Vector3d::Map(moved->values.data() + 3 * v);
    }
    morphed_ = true;
  }
  return std::nullopt;
}

std::optional<Error> GltfReader::read_triangles(const Json& primitive, std::size_t mode,
                                                Primitive& part) {
  std::vector<std::int32_t> corners;
  const std::size_t vertices = part.mesh.vertices.size();
  if (json_member(primitive, "indices") != nullptr) {
    const auto accessor = json_index(primitive, "indices");
    if (!accessor) return damaged("a primitive has no accessor for its corners");
    const auto numbers = buffers_.read(*accessor, 1);
    if (!numbers) return damaged(numbers.error().message);
    corners.reserve(numbers->values.size());
    for (const double number : numbers->values) {
      if (!(number >= 0 && number < static_cast<double>(vertices))) {
        return damaged("a triangle refers to a vertex that does not exist");
      }
      corners.push_back(static_cast<std::int32_t>(number));
    }
  } else {
    corners.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) corners[i] = static_cast<std::int32_t>(i);
  }
  auto& triangles = part.mesh.triangles;
  if (mode == kTriangles) {
    if (corners.size() % 3 != 0) return damaged("its last triangle is incomplete");
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    }
    return std::nullopt;
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    if (mode == kFan) {
      triangles.push_back({corners[0], corners[i - 1], corners[i]});
    } else {
      const bool odd = i % 2 == 1;
      triangles.push_back({corners[i - 2], corners[odd ? i : i - 1], corners[odd ? i - 1 : i]});
    }
  }
  return std::nullopt;
}

// Returns whether a file is of version 1.
bool is_version_1(const Json& gltf) {
  const Json* const asset = json_member(gltf, "asset");
  const Json* const version = asset != nullptr ? json_member(*asset, "version") : nullptr;
  if (version == nullptr) return false;
  if (version->is_number()) return version->get<double>() < 2;
  return version->is_string() && version->get_ref<const std::string&>().starts_with("1");
}

driver::Result<TriangleMesh> read_file(const std::string& bytes, const std::string& kind,
                                       const std::filesystem::path& folder, MeshFileInfo& info,
                                       MeshAttributes* attributes) {
  info.unit = 1;
  info.up = 'y';
  std::string_view text = bytes, chunk;
  if (kind == "glb") {
    constexpr std::size_t kVersion = 4;  // position of the version
    if (bytes.size() > kVersion && bytes[kVersion] == 1) {
      return import_by_assimp(bytes, kind, folder, info.notes);
    }
    const auto chunks = chunks_of(bytes);
    if (!chunks) return chunks.error();
    text = chunks->first;
    chunk = chunks->second;
  }
  const Json gltf = Json::parse(text, nullptr, false);
  if (!gltf.is_object()) return unreadable(kind, "it is not JSON");
  if (is_version_1(gltf)) return import_by_assimp(bytes, kind, folder, info.notes);
  return GltfReader(gltf, chunk, folder, kind, attributes).read(info.notes);
}

}  // namespace

driver::Result<TriangleMesh> read_gltf(const std::string& bytes, const std::string& kind,
                                       const std::filesystem::path& folder, MeshFileInfo& info,
                                       MeshAttributes* attributes) {
  if (bytes.empty()) return Error{"the file is empty."};
  return read_in_child(
      [&](MeshFileInfo& found) { return read_file(bytes, kind, folder, found, attributes); }, kind,
      kGltfLimits, info, attributes);
}

std::vector<std::filesystem::path> gltf_buffer_files(const std::filesystem::path& file) {
  // The kind of a JSON or GLB file is determined by its first characters.
  constexpr std::size_t kHead = 64;
  const std::string kind = mesh_kind_of(driver::read_head(file, kHead), "");
  if (kind != "gltf" && kind != "glb") return {};
  const auto bytes = driver::read_file(file, kGltfFileMax);
  if (!bytes) return {};
  std::string_view text = *bytes;
  if (kind == "glb") {
    const auto chunks = chunks_of(text);
    if (!chunks) return {};
    text = chunks->first;
  }
  std::vector<std::filesystem::path> files;
  const Json gltf = Json::parse(text, nullptr, false);
  const Json* const buffers = json_member(gltf, "buffers");
  if (buffers == nullptr) return {};
  for (const Json& buffer : *buffers) {
    const Json* const uri = json_member(buffer, "uri");
    if (uri == nullptr || !uri->is_string()) continue;
    const auto& name = uri->get_ref<const std::string&>();
    // A name that was not encoded may contain a per cent sign.
    for (const std::string& tried : {percent_decoded(name), name}) {
      const std::filesystem::path path = file.parent_path() / tried;
      if (name.starts_with("data:") || !driver::is_regular(path)) continue;
      files.push_back(path);
      break;
    }
  }
  return files;
}

}  // namespace thimble::render
