#include "mesh/file/package/read_3mf.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/file/file_unit.h"
#include "mesh/file/mesh_parts.h"
#include "mesh/file/package/xml_tags.h"
#include "mesh/file/package/zip_archive.h"
#include "mesh/file/read_in_child.h"
#include "mesh/file/text_words.h"

namespace thimble::render {
namespace {

using driver::Error;
using Eigen::Affine3d;

constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr std::string_view kProduction =
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
constexpr std::string_view kBeamLattice =
    "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";

// Extensions that may be required and do not change the shape.
constexpr std::array<std::string_view, 5> kKnown{
    kCore, kProduction, "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
    "http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04"};

// Maximum nesting of components, and maximum number of placed objects of a file.
constexpr int kDepthMax = 32;
constexpr int kPlacedMax = 1'000'000;

// An object placed by a build or by another object.
struct Component {
  std::string path;  // path of its model; empty: the same model
  std::int64_t object = 0;
  Affine3d place = Affine3d::Identity();
};

struct ModelObject {
  TriangleMesh mesh;
  std::vector<Component> components;
};

struct Model {
  double unit = 0;  // m
  std::map<std::int64_t, ModelObject> objects;
  std::vector<Component> build;
  bool beams = false;
};

Error damaged(const std::string& reason) {
  return unreadable("3mf", reason);
}

// Reads the text of one model.
class ModelReader {
 public:
  ModelReader(std::string_view text, std::string part) : text_(text), part_(std::move(part)) {}
  driver::Result<Model> read();

 private:
  std::optional<Error> read_tag(const XmlTag& tag);
  std::optional<Error> open_model(const XmlTag& tag);
  std::optional<Error> read_vertex(const XmlTag& tag);
  std::optional<Error> read_triangle(const XmlTag& tag);
  std::optional<Error> read_component(const XmlTag& tag, std::vector<Component>& components);
  Error error(const std::string& what) const { return damaged(part_ + ": " + what); }
  std::string_view space_of(std::string_view prefix) const;

  std::string_view text_;
  std::string part_;                                        // its name
  std::map<std::string, std::string, std::less<>> spaces_;  // namespaces by prefix
  Model model_;
  ModelObject* object_ = nullptr;  // object being read
  bool opened_ = false, closed_ = false;
};

std::string_view ModelReader::space_of(std::string_view prefix) const {
  const auto found = spaces_.find(prefix);
  // Files without any namespace occur; it means the core namespace.
  if (found == spaces_.end()) return prefix.empty() ? kCore : std::string_view();
  return found->second;
}

driver::Result<Model> ModelReader::read() {
  if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF")) {
    return Error{"its model is encoded as UTF-16. Save it as UTF-8."};
  }
  XmlTags tags(text_);
  XmlTag tag;
  while (!closed_ && tags.next(tag)) {
    for (const auto& [key, value] : tag.attributes) {
      if (key == "xmlns") spaces_[""] = plain_text(value);
      if (key.starts_with("xmlns:")) spaces_[std::string(key.substr(6))] = plain_text(value);
    }
    if (auto wrong = read_tag(tag)) return *wrong;
  }
  if (!closed_) {
    return error(tags.damaged() ? "it is not XML" : "it has no </model>: it is truncated");
  }
  return std::move(model_);
}

std::optional<Error> ModelReader::read_tag(const XmlTag& tag) {
  const std::string_view space = space_of(tag.prefix);
  if (space == kBeamLattice && tag.name == "beam") model_.beams = true;
  if (space != kCore) return std::nullopt;
  if (tag.opens) {
    std::optional<Error> wrong;
    if (tag.name == "model") wrong = open_model(tag);
    if (tag.name == "object") {
      const auto id = whole_number(tag.find("id").value_or(""));
      if (!id) return error("an object has no number");
      const auto [place, added] = model_.objects.try_emplace(*id);
      if (!added) return error("two objects have the number " + std::to_string(*id));
      object_ = &place->second;
    }
    if (tag.name == "vertex" && object_ != nullptr) wrong = read_vertex(tag);
    if (tag.name == "triangle" && object_ != nullptr) wrong = read_triangle(tag);
    if (tag.name == "component" && object_ != nullptr) {
      wrong = read_component(tag, object_->components);
    }
    if (tag.name == "item") wrong = read_component(tag, model_.build);
    if (wrong) return wrong;
  }
  if (tag.closes && tag.name == "object") object_ = nullptr;
  if (tag.closes && tag.name == "model") closed_ = true;
  return std::nullopt;
}

std::optional<Error> ModelReader::open_model(const XmlTag& tag) {
  if (opened_) return error("a model contains another model");
  opened_ = true;
  const auto unit = unit_of_word(tag.find("unit").value_or("millimeter"));
  if (!unit) return Error{"it uses an unknown length unit."};
  model_.unit = *unit;
  TextWords required(tag.find("requiredextensions").value_or(""), part_);
  for (std::string_view word = required.next(); !word.empty(); word = required.next()) {
    const std::string_view space = space_of(word);
    if (std::find(kKnown.begin(), kKnown.end(), space) == kKnown.end()) {
      return Error{"it requires the extension " + shown_word(word) + " of 3MF (" +
                   std::string(space) + "), which is not supported. Export the mesh without it."};
    }
  }
  return std::nullopt;
}

std::optional<Error> ModelReader::read_vertex(const XmlTag& tag) {
  Eigen::Vector3d vertex;
  constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = real_number(tag.find(kAxes[i]).value_or(""));
    if (!number) return error("a vertex has no valid coordinate " + std::string(kAxes[i]));
    vertex[static_cast<Eigen::Index>(i)] = *number;
  }
  if (object_->mesh.vertices.size() >= std::numeric_limits<std::int32_t>::max()) {
    return Error{"it has more than 2^31 - 1 vertices."};
  }
  object_->mesh.vertices.push_back(vertex);
  return std::nullopt;
}

std::optional<Error> ModelReader::read_triangle(const XmlTag& tag) {
  std::array<std::int32_t, 3> triangle{};
  constexpr std::array<std::string_view, 3> kCorners{"v1", "v2", "v3"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto vertex = whole_number(tag.find(kCorners[i]).value_or(""));
    if (!vertex || *vertex < 0 ||
        static_cast<std::size_t>(*vertex) >= object_->mesh.vertices.size()) {
      return error("triangle " + std::to_string(object_->mesh.triangles.size()) +
                   " refers to a vertex that does not exist");
    }
    triangle[i] = static_cast<std::int32_t>(*vertex);
  }
  object_->mesh.triangles.push_back(triangle);
  return std::nullopt;
}

std::optional<Error> ModelReader::read_component(const XmlTag& tag,
                                                 std::vector<Component>& components) {
  Component component;
  const auto object = whole_number(tag.find("objectid").value_or(""));
  if (!object) return error("a component has no object");
  component.object = *object;
  for (const auto& [key, value] : tag.attributes) {
    const std::size_t colon = key.find(':');
    if (colon == std::string_view::npos || key.substr(colon + 1) != "path") continue;
    if (space_of(key.substr(0, colon)) == kProduction) component.path = plain_text(value);
  }
  if (const auto transform = tag.find("transform")) {
    // Four rows of three numbers, multiplied from the right.
    TextWords words(*transform, part_);
    for (Eigen::Index i = 0; i < 12; ++i) {
      const auto number = real_number(words.next());
      if (!number) return error("a transform does not have twelve numbers");
      component.place.matrix()(i % 3, i / 3) = *number;
    }
  }
  components.push_back(std::move(component));
  return std::nullopt;
}

// Reads the models of an archive, each once, and assembles their objects.
class PackageReader {
 public:
  PackageReader(const ZipArchive& archive, MeshFileInfo& info) : archive_(archive), info_(info) {}
  driver::Result<TriangleMesh> read();

 private:
  std::string first_model() const;
  driver::Result<const Model*> model(const std::string& path);
  std::optional<Error> place(const std::string& path, const Component& component,
                             const Affine3d& where, int depth);

  const ZipArchive& archive_;
  MeshFileInfo& info_;
  std::map<std::string, Model> models_;
  MeshParts parts_;
  int placed_ = 0;
};

std::string PackageReader::first_model() const {
  constexpr std::string_view kType = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
  if (const auto relations = archive_.read("_rels/.rels")) {
    XmlTags tags(*relations);
    XmlTag tag;
    while (tags.next(tag)) {
      if (tag.name == "Relationship" && tag.find("Type") == kType) {
        return plain_text(tag.find("Target").value_or(""));
      }
    }
  }
  for (const std::string& name : archive_.names()) {
    if (name.ends_with(".model")) return name;
  }
  return "3D/3dmodel.model";
}

driver::Result<const Model*> PackageReader::model(const std::string& path) {
  if (const auto known = models_.find(path); known != models_.end()) return &known->second;
  const auto text = archive_.read(path);
  if (!text) return damaged("its archive " + text.error().message);
  auto read = ModelReader(*text, path).read();
  if (!read) return read.error();
  return &models_.emplace(path, std::move(read).value()).first->second;
}

std::optional<Error> PackageReader::place(const std::string& path, const Component& component,
                                          const Affine3d& where, int depth) {
  const std::string& own = component.path.empty() ? path : component.path;
  if (depth > kDepthMax) return damaged("its components are nested too deeply");
  if (++placed_ > kPlacedMax) return damaged("it places more than a million objects");
  const auto here = model(own);
  if (!here) return here.error();
  const auto object = (*here)->objects.find(component.object);
  if (object == (*here)->objects.end()) {
    return damaged("it refers to object " + std::to_string(component.object) + " of " + own +
                   ", which does not exist");
  }
  const Affine3d placed = where * component.place;
  if (!object->second.mesh.triangles.empty()) {
    if ((*here)->unit != *info_.unit) {
      return Error{
          "its models use different units, which is not supported. Export it in one unit."};
    }
    if (auto added = parts_.add(object->second.mesh, placed, false); !added) return added.error();
  }
  for (const Component& inner : object->second.components) {
    if (auto wrong = place(own, inner, placed, depth + 1)) return wrong;
  }
  return std::nullopt;
}

driver::Result<TriangleMesh> PackageReader::read() {
  const std::string first = first_model();
  const auto root = model(first);
  if (!root) return root.error();
  info_.unit = (*root)->unit;
  if ((*root)->build.empty()) return Error{"its build has no item, so there is nothing to read."};
  for (const Component& item : (*root)->build) {
    if (auto wrong = place(first, item, Affine3d::Identity(), 0)) return *wrong;
  }
  auto mesh = parts_.take(info_.notes);
  for (const auto& model : models_) {
    if (!model.second.beams) continue;
    info_.notes.push_back("Beam lattices were ignored.");
    break;
  }
  return mesh;
}

}  // namespace

driver::Result<TriangleMesh> read_3mf(const std::string& bytes, MeshFileInfo& info) {
  if (bytes.empty()) return Error{"the file is empty."};
  return read_in_child(
      [&bytes](MeshFileInfo& found) -> driver::Result<TriangleMesh> {
        const auto archive = ZipArchive::open(bytes);
        if (!archive) return damaged("its archive " + archive.error().message);
        return PackageReader(*archive, found).read();
      },
      "3mf", limits_of(bytes.size()), info);
}

}  // namespace thimble::render
