#include "thimble/scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include "builder/scene_text.h"
#include "builder/scene_value_parts.h"
#include "meshes/object_mesh.h"
#include "output/output_file.h"
#include "read_scene.h"
#include "thimble/render/mesh/mesh_file.h"
#include "user_folders.h"
#include "yaml/yaml_reader.h"
#include "yaml/yaml_text.h"

namespace thimble::scene {

SceneValue::SceneValue(double number)
    // Written so that the sign of a NaN makes no difference.
    : text_(std::isnan(number) ? "nan" : fmt::format("{}", number)) {}
SceneValue::SceneValue(std::string text) : kind_(Kind::kText), text_(std::move(text)) {}
SceneValue::SceneValue(const Eigen::Vector3d& numbers)
    : kind_(Kind::kList), values_(numbers.begin(), numbers.end()) {}
SceneValue::SceneValue(std::vector<SceneValue> list)
    : kind_(Kind::kList), values_(std::move(list)) {}
SceneValue::SceneValue(SceneMap map)
    : kind_(Kind::kMap), values_(std::move(map.values_)), keys_(std::move(map.keys_)) {}

SceneMap::SceneMap(std::initializer_list<std::pair<std::string_view, SceneValue>> entries) {
  for (const auto& [key, value] : entries) set(key, value);
}

SceneMap& SceneMap::set(std::string_view key, SceneValue value) {
  (*this)[key] = std::move(value);
  return *this;
}

SceneValue& SceneMap::operator[](std::string_view key) {
  const auto known = std::find(keys_.begin(), keys_.end(), key);
  if (known != keys_.end()) return values_[static_cast<std::size_t>(known - keys_.begin())];
  keys_.emplace_back(key);
  return values_.emplace_back(std::vector<SceneValue>());
}

SceneMap& SceneMap::append(std::string_view key, SceneValue entry) {
  SceneValue& list = (*this)[key];
  // A value that is no list becomes an entry, so that the reader reports it.
  if (list.kind_ != SceneValue::Kind::kList) list = SceneValue(std::vector<SceneValue>{list});
  list.values_.push_back(std::move(entry));
  return *this;
}

ObjectBuilder::ObjectBuilder(std::string_view name) {
  map_.set("name", name);
}

ObjectBuilder& ObjectBuilder::set(std::string_view key, SceneValue value) {
  if (key == "mesh") mesh_.reset();
  map_.set(key, std::move(value));
  return *this;
}

ObjectBuilder& ObjectBuilder::mesh(const std::filesystem::path& file) {
  return set("mesh", file);
}

ObjectBuilder& ObjectBuilder::mesh(render::TriangleMesh mesh) {
  set("mesh", "");  // the name is chosen when the scene is written
  mesh_ = std::make_shared<const render::TriangleMesh>(std::move(mesh));
  return *this;
}

ObjectBuilder& ObjectBuilder::sphere(double radius) {
  return set("sphere", SceneMap{{"radius", radius}});
}

ObjectBuilder& ObjectBuilder::box(const Eigen::Vector3d& sides) {
  return set("box", SceneMap{{"sides", sides}});
}

ObjectBuilder& ObjectBuilder::cylinder(double radius, double height) {
  return set("cylinder", SceneMap{{"radius", radius}, {"height", height}});
}

ObjectBuilder& ObjectBuilder::capsule(double radius, double height) {
  return set("capsule", SceneMap{{"radius", radius}, {"height", height}});
}

ObjectBuilder& ObjectBuilder::cone(double radius, double height) {
  return set("cone", SceneMap{{"radius", radius}, {"height", height}});
}

ObjectBuilder& ObjectBuilder::torus(double radius, double tube) {
  return set("torus", SceneMap{{"radius", radius}, {"tube", tube}});
}

ObjectBuilder& ObjectBuilder::plane(const Eigen::Vector3d& normal) {
  return set("plane", SceneMap{{"normal", normal}});
}

ObjectBuilder& ObjectBuilder::field(std::string_view kind, const SceneMap& settings) {
  set("field", kind);
  settings.each([this](const std::string& key, const SceneValue& value) { set(key, value); });
  return *this;
}

ObjectBuilder& ObjectBuilder::size(double side) {
  return set("size", side);
}

ObjectBuilder& ObjectBuilder::scale(double factor) {
  return set("scale", factor);
}

ObjectBuilder& ObjectBuilder::position(const Eigen::Vector3d& p_WO) {
  return set("position", p_WO);
}

ObjectBuilder& ObjectBuilder::rotate(char axis, double degrees) {
  map_.append("rotate_degrees", std::vector<SceneValue>{std::string(1, axis), degrees});
  return *this;
}

ObjectBuilder& ObjectBuilder::stiffness(double stiffness) {
  return set("stiffness", stiffness);
}

ObjectBuilder& ObjectBuilder::damping(double damping) {
  return set("damping", damping);
}

ObjectBuilder& ObjectBuilder::contact(SceneMap settings) {
  return set("contact", std::move(settings));
}

ObjectBuilder& ObjectBuilder::body(SceneMap parts) {
  return set("body", std::move(parts));
}

ObjectBuilder& ObjectBuilder::effect(std::string_view group, std::string_view name,
                                     SceneMap settings) {
  SceneMap entry;
  entry.set(group, name);
  settings.each(
      [&entry](const std::string& key, const SceneValue& value) { entry.set(key, value); });
  map_.append("effects", std::move(entry));
  return *this;
}

ObjectBuilder& ObjectBuilder::own_effect(render::EffectPlan plan) {
  own_effects_.push_back(std::move(plan));
  return *this;
}

HandBuilder& HandBuilder::set(std::string_view key, SceneValue value) {
  map_.set(key, std::move(value));
  return *this;
}

HandBuilder& HandBuilder::at(double time, const Eigen::Vector3d& p_W, bool stop) {
  SceneMap point{{"t", time}, {"at", p_W}};
  if (stop) point.set("stop", true);
  return waypoint(std::move(point));
}

HandBuilder& HandBuilder::on(double time, std::string_view object, const Eigen::Vector3d& near_W,
                             double press, bool stop) {
  SceneMap point{{"t", time}, {"on", object}, {"near", near_W}, {"press", press}};
  if (stop) point.set("stop", true);
  return waypoint(std::move(point));
}

HandBuilder& HandBuilder::waypoint(SceneMap keys) {
  map_.append("path", std::move(keys));
  return *this;
}

ArmBuilder::ArmBuilder(std::string_view name, std::string_view arm) {
  map_.set("name", name).set("arm", arm);
}

ArmBuilder& ArmBuilder::set(std::string_view key, SceneValue value) {
  map_.set(key, std::move(value));
  return *this;
}

ArmBuilder& ArmBuilder::at(const Eigen::Vector3d& p_W, double turn_degrees) {
  return set("at", SceneMap{{"position", p_W}, {"turn_degrees", turn_degrees}});
}

SceneBuilder::SceneBuilder(std::string_view name) : name_(name) {
  map_.set("name", name);
}

SceneBuilder& SceneBuilder::set(std::string_view key, SceneValue value) {
  map_.set(key, std::move(value));
  return *this;
}

SceneBuilder& SceneBuilder::description(std::string_view text) {
  return set("description", text);
}

SceneBuilder& SceneBuilder::arm(std::string_view arm) {
  return set("arm", arm);
}

SceneBuilder& SceneBuilder::rate(double rate) {
  return set("rate", rate);
}

SceneBuilder& SceneBuilder::duration(double duration) {
  return set("duration", duration);
}

SceneBuilder& SceneBuilder::seed(std::uint64_t seed) {
  return set("seed", seed);
}

SceneBuilder& SceneBuilder::gravity(const Eigen::Vector3d& g_W) {
  return set("gravity", g_W);
}

SceneBuilder& SceneBuilder::tool_radius(double radius) {
  return set("tool", SceneMap{{"radius", radius}});
}

SceneBuilder& SceneBuilder::joint(SceneMap keys) {
  map_.append("joints", std::move(keys));
  return *this;
}

SceneBuilder& SceneBuilder::folder(std::filesystem::path folder) {
  folder_ = std::move(folder);
  return *this;
}

ObjectBuilder& SceneBuilder::object(std::string_view name) {
  objects_.push_back(ObjectBuilder(name));
  return objects_.back();
}

ArmBuilder& SceneBuilder::add_arm(std::string_view name, std::string_view arm) {
  arms_.push_back(ArmBuilder(name, arm));
  return arms_.back();
}

std::filesystem::path SceneBuilder::folder_now() const {
  std::error_code status;  // a working folder that was removed: names are relative to nothing
  const auto whole = std::filesystem::absolute(folder_.empty() ? "." : folder_, status);
  return (status ? folder_ : whole).lexically_normal();
}

std::filesystem::path SceneBuilder::file() const {
  return folder_now() / ((name_.empty() ? "scene" : as_file_name(name_)) + ".yaml");
}

bool SceneBuilder::has_own_effects() const noexcept {
  return std::any_of(objects_.begin(), objects_.end(),
                     [](const ObjectBuilder& object) { return !object.own_effects_.empty(); });
}

std::vector<std::string> SceneBuilder::mesh_names(std::string_view stem) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    names.push_back(fmt::format("{}_{}.off", stem, i + 1));
  }
  return names;
}

SceneText SceneBuilder::write(const std::vector<std::string>& mesh_names,
                              const std::filesystem::path& files_in) const {
  const auto placed = [&files_in](SceneMap map) {
    if (files_in.empty()) return map;
    for (SceneValue& value : map.values_) SceneValue::Parts::make_paths_whole(value, files_in);
    return map;
  };
  SceneMap scene = placed(map_);
  const auto with_hand = [&placed](SceneMap map, const HandBuilder& hand) {
    if (!hand.map_.empty()) map.set("hand", placed(hand.map_));
    return map;
  };
  for (const ArmBuilder& arm : arms_) scene.append("arms", with_hand(placed(arm.map_), arm.hand_));
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    SceneMap object = placed(objects_[i].map_);
    if (objects_[i].mesh_) object.set("mesh", mesh_names[i]);
    scene.append("objects", std::move(object));
  }
  return SceneText(with_hand(std::move(scene), hand_));
}

driver::Result<Scene> SceneBuilder::build(const SceneReading& reading) const {
  const std::filesystem::path place = file();
  const SceneText written = write(mesh_names(place.stem().string()));
  std::vector<ObjectInMemory> objects(listed_objects());
  for (const ObjectBuilder& object : objects_) {
    objects.push_back({.mesh = object.mesh_, .effects = object.own_effects_});
  }
  auto scene = read_at_rate(reading, [&](const SceneReading& at) -> driver::Result<Scene> {
    auto yaml = YamlFile::parse(written.text(), "", nullptr, written.places());
    if (!yaml) return yaml.error();
    return read_scene(*yaml, place, at, objects);
  });
  if (scene) scene->energy_line = 0;  // there is no file
  return scene;
}

std::size_t SceneBuilder::listed_objects() const {
  for (std::size_t i = 0; i < map_.keys_.size(); ++i) {
    if (map_.keys_[i] == "objects") return map_.values_[i].values_.size();
  }
  return 0;
}

std::string SceneBuilder::place_of(std::size_t object) const {
  return SceneText::entry_place("objects", listed_objects() + object + 1, objects_[object].map_);
}

std::string SceneBuilder::text() const {
  return write(mesh_names(file().stem().string())).text();
}

driver::Result<std::string> SceneBuilder::checked_text(
    const std::vector<std::string>& mesh_names) const {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (objects_[i].own_effects_.empty()) continue;
    return driver::Error{place_of(i) +
                         ": has an effect of the program, which a scene file cannot contain; "
                         "remove own_effect."};
  }
  const SceneText written = write(mesh_names);
  if (const auto flaw = find_invalid_utf8(written.text())) {
    return driver::Error{written.places()[static_cast<std::size_t>(flaw->line)] +
                         ": a text is not UTF-8; encode it as UTF-8."};
  }
  return written.text();
}

driver::Result<std::string> SceneBuilder::yaml() const {
  return checked_text(mesh_names(file().stem().string()));
}

driver::Result<void> SceneBuilder::save(const std::filesystem::path& file) const {
  const std::filesystem::path into = std::filesystem::absolute(file).lexically_normal();
  const auto names = mesh_names(into.stem().string());
  auto text = checked_text(names);
  if (!text) return text.error();
  std::error_code status;
  if (!std::filesystem::equivalent(into.parent_path(), folder_now(), status)) {
    text = write(names, folder_now()).text();
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (!objects_[i].mesh_) continue;
    if (auto good = check_mesh_in_memory(*objects_[i].mesh_); !good) {
      return driver::Error{place_of(i) + ": mesh: " + good.error().message};
    }
    if (auto saved = render::save_mesh(*objects_[i].mesh_, into.parent_path() / names[i]); !saved) {
      return saved;
    }
  }
  return output::write_file(into, output::kPlainText, *text);
}

}  // namespace thimble::scene
