#include "object_sections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "energy_guard_settings.h"
#include "surface/friction/friction_settings.h"
#include "surface/height_image.h"
#include "worst_direction.h"
#include "yaml/yaml_settings.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

/// Returns the groups of the effect table, each once, in its order.
std::vector<std::string_view> group_names() {
  std::vector<std::string_view> groups;
  for (const render::EffectKind& kind : render::effect_table()) {
    if (std::find(groups.begin(), groups.end(), kind.group) == groups.end()) {
      groups.push_back(kind.group);
    }
  }
  return groups;
}

/// Returns the effect that an entry of the list names; nullptr, with a recorded mistake, if there
/// is none.
/// `text`: the value of the group, if it is any text.
const render::EffectKind* named_effect(YamlMap& entry, std::string& text) {
  const render::EffectKind* found = nullptr;
  std::string known;
  for (const std::string_view group : group_names()) {
    known += (known.empty() ? "" : " or ") + std::string(group) + ": NAME";
    if (!entry.has(group)) continue;
    if (found != nullptr) {
      entry.refuse(group, "is a second effect in one list entry; move it to an entry of its own");
      return nullptr;
    }
    std::vector<const render::EffectKind*> kinds;
    std::vector<std::string_view> names;
    for (const render::EffectKind& kind : render::effect_table()) {
      if (kind.group != group) continue;
      kinds.push_back(&kind);
      names.push_back(kind.name);
    }
    if (kinds.front()->free_text) {
      found = kinds.front();
      text = entry.require_string(group);
    } else {
      found = kinds[entry.require_choice(group, names)];
    }
  }
  if (found == nullptr) entry.refuse("", "expected " + known);
  return found;
}

constexpr double kSideMin = 1e-4, kSideMax = 2;  // m, as for the size of meshes

SceneShape read_plane(YamlMap map, const Eigen::Matrix3d& R_WO, const Vector3d& p_WO) {
  Vector3d normal = map.optional_vector3("normal", Vector3d::UnitZ(), "", -1e3, 1e3);
  const double drawn = map.optional_number("drawn_side", 0.1, "m", kSideMin, kSideMax);
  if (!(normal.stableNorm() > 0)) {
    map.reject("normal", "expected a direction, found zeros");
    normal = Vector3d::UnitZ();
  }
  map.finish();
  return {.shape_W = render::HalfSpace{.n_W = R_WO * normal.stableNormalized(), .p_WO = p_WO},
          .drawn_side = drawn};
}

SceneShape read_sphere(YamlMap map, const Vector3d& p_WO) {
  const render::Sphere ball{.p_WO = p_WO,
                            .radius = map.require_number("radius", "m", kSideMin, kSideMax)};
  map.finish();
  return {.shape_W = ball};
}

SceneShape read_box(YamlMap map, const Eigen::Matrix3d& R_WO, const Vector3d& p_WO) {
  const Vector3d sides = map.require_vector3("sides", "m", kSideMin, kSideMax);
  const render::Box box{.R_WO = R_WO, .p_WO = p_WO, .half_sides = sides / 2};
  const bool wedges = map.optional_choice("form", 0, {"entry_face", "wedges"}) == 1;
  map.finish();
  if (wedges) return {.shape_W = render::WedgeBox{box}};
  return {.shape_W = render::EntryFaceBox{box}};
}

/// Radius and half height of a shape.
struct RoundSize {
  double radius = 0, half_height = 0;
};

RoundSize read_size(YamlMap map) {
  const double radius = map.require_number("radius", "m", kSideMin, kSideMax);
  const double height = map.require_number("height", "m", kSideMin, kSideMax);
  map.finish();
  return {.radius = radius, .half_height = height / 2};
}

SceneShape read_torus(YamlMap map, const render::RoundFrame& frame) {
  const double radius = map.require_number("radius", "m", kSideMin, kSideMax);
  const double tube = map.require_number("tube", "m", kSideMin, kSideMax);
  if (!(tube < radius)) map.reject("tube", "must be less than radius, so that the ring has a hole");
  map.finish();
  return {.shape_W = render::Torus{frame, radius, tube}};
}

}  // namespace

render::EffectContext effect_context_of(const ArmFile& arm, double rate) {
  render::EffectContext context;
  context.tick = 1 / rate;
  context.delay = loop_delay(arm);
  context.force_max = arm.limits.force_max;
  context.tip_mass = arm.simulated.plant.mass;
  context.tip_damping = arm.simulated.plant.viscous;
  context.tip_coulomb = arm.simulated.plant.coulomb;
  context.encoder_step = worst_over_workspace(arm).encoder_step;
  return context;
}

std::vector<render::EffectPlan> read_effects(YamlMap& object, const std::filesystem::path& folder,
                                             const render::EffectContext& context) {
  std::vector<render::EffectPlan> plans;
  for (YamlMap& entry : object.require_maps("effects")) {
    std::string text;
    const render::EffectKind* kind = named_effect(entry, text);
    if (kind == nullptr) continue;
    entry.set_place("effects[] " + std::string(kind->group) + ": " + std::string(kind->name));
    YamlSettings settings(entry, folder, kind->group, std::move(text));
    plans.push_back({kind, kind->read(settings, context)});
    settings.finish();
  }
  std::stable_sort(plans.begin(), plans.end(),
                   [](const auto& a, const auto& b) { return a.kind->order < b.kind->order; });
  return plans;
}

render::MapChoice read_map(YamlMap map, const std::filesystem::path& folder, std::string_view unit,
                           double low, double high) {
  render::MapChoice choice;
  const bool by_image = map.has("image"), by_colour = map.has("vertex_colour");
  if (by_image && by_colour) {
    map.refuse("vertex_colour", "cannot be used with image; keep one of them");
  } else if (by_image) {
    std::filesystem::path file;
    YamlSettings(map, folder).file("image", file);
    std::error_code status;
    if (std::filesystem::is_regular_file(file, status)) {
      auto image = render::HeightImage::load(file);
      if (image) {
        choice.image = std::make_shared<const render::HeightImage>(std::move(image).value());
      } else {
        map.refuse("image", image.error().message);
      }
    }
  } else if (by_colour) {
    choice.channel = map.require_choice("vertex_colour", {"red", "green", "blue"});
  } else {
    map.refuse_absence("expected one of image and vertex_colour, found none");
  }
  choice.black = map.require_number("min", unit, low, high);
  choice.white = map.require_number("max", unit, low, high);
  map.finish();
  return choice;
}

render::FieldBuilder read_field(YamlMap& object, const std::filesystem::path& folder,
                                const render::EffectContext& context) {
  std::vector<std::string_view> names;
  for (const render::FieldKind& kind : render::field_table()) names.push_back(kind.name);
  const render::FieldKind& kind = render::field_table()[object.require_choice("field", names)];
  object.set_place("objects[] field: " + std::string(kind.name));
  YamlSettings settings(object, folder);
  render::FieldBuilder build = kind.read(settings, context);
  settings.finish();
  return build;
}

std::optional<SceneShape> read_shape(YamlMap& object, const Eigen::Matrix3d& R_WO,
                                     const Eigen::Vector3d& p_WO) {
  if (object.has("plane")) return read_plane(object.require_map("plane"), R_WO, p_WO);
  if (object.has("sphere")) return read_sphere(object.require_map("sphere"), p_WO);
  if (object.has("box")) return read_box(object.require_map("box"), R_WO, p_WO);
  const render::RoundFrame frame{.R_WO = R_WO, .p_WO = p_WO};
  if (object.has("cylinder")) {
    const RoundSize size = read_size(object.require_map("cylinder"));
    return SceneShape{.shape_W = render::Cylinder{frame, size.radius, size.half_height}};
  }
  if (object.has("capsule")) {
    const RoundSize size = read_size(object.require_map("capsule"));
    return SceneShape{.shape_W = render::Capsule{frame, size.radius, size.half_height}};
  }
  if (object.has("cone")) {
    const RoundSize size = read_size(object.require_map("cone"));
    return SceneShape{.shape_W = render::Cone{frame, size.radius, size.half_height}};
  }
  if (object.has("torus")) return read_torus(object.require_map("torus"), frame);
  return {};
}

SceneBody read_body(YamlMap& object, const std::filesystem::path& folder,
                    const render::EffectContext& context, const Eigen::Vector3d& gravity_W) {
  SceneBody body;
  YamlMap map = object.require_map("body");
  const auto read = [&](const char* key, auto read_settings) {
    if (!map.has(key)) return;
    YamlSettings settings(map.require_map(key), folder);
    read_settings(settings);
    settings.finish();
  };
  read("dent", [&](auto& settings) { body.dent.emplace().read(settings, context); });
  read("plastic", [&](auto& settings) { body.shape.clay.emplace().read(settings); });
  read("snap", [&](auto& settings) { body.shape.snap.emplace().read(settings); });
  read("motion", [&](auto& settings) {
    body.motion.emplace().gravity_W = gravity_W;
    body.motion->read(settings);
  });
  body.shape.step = context.tick;
  map.finish();
  return body;
}

render::BodyCoupling coupling_of(const render::EffectContext& context, bool texture,
                                 bool friction) {
  render::BodyCoupling coupling{.stiffness = context.surface_stiffness,
                                .damping = context.surface_damping,
                                .step = context.tick};
  if (texture) coupling.stiffness *= 2;
  if (!friction) return coupling;
  const double hold = render::stick_stiffness_max(context);
  if (std::isfinite(hold)) coupling.stiffness = std::max(coupling.stiffness, hold);
  return coupling;
}

}  // namespace thimble::scene
