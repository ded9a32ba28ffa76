#include "thimble/scene/scene_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <string_view>
#include <system_error>
#include <unordered_set>
#include <utility>

#include "disk_paging/page_file.h"
#include "energy_guard_settings.h"
#include "files/scene_paths.h"
#include "hand/read_hand.h"
#include "hand/scene_arms.h"
#include "joints_section.h"
#include "loop_latency.h"
#include "object_sections.h"
#include "read_scene.h"
#include "yaml/yaml_reader.h"
#include "yaml/yaml_settings.h"
#include "yaml/yaml_words.h"

namespace thimble::scene {
namespace {

// The bounds catch misplaced decimal points and values in mm. They are far beyond what a desk-top
// arm can use [DEVICES 3].
constexpr double kGravityMax = 100;                   // m/s^2, as of a motion
constexpr double kPositionMax = 2;                    // m
constexpr double kStiffnessMax = 1e5;                 // N/m
constexpr double kMapStiffnessMin = 1;                // N/m; less cannot be felt
constexpr double kFrictionFactorMax = 10;             // of the coefficient of friction
constexpr double kDampingMax = 1000;                  // N s/m
constexpr double kSheetMin = 1e-5, kSheetMax = 0.02;  // m
constexpr std::int64_t kBudgetMin = 1;                // MiB: 16 pages, around a tip at rest
constexpr std::int64_t kBudgetMax = 1 << 20;          // MiB
constexpr double kBandMax = 0.1;                      // m
constexpr double kTipRadiusMin = 1e-5;                // m; less cannot be felt
constexpr double kTipRadiusMax = 0.1;                 // m
constexpr double kDurationMax = 86400;                // s
constexpr double kRateMin = 10;                       // Hz
constexpr double kRateMax = 1e5;                      // Hz
constexpr double kStiffnessMargin =
    0.5;  // of the stable stiffness [chosen: hands differ by this factor]

/// Reads the settings of contact. `named`: whether a tracker is named, not "auto".
render::ContactChoice read_contact(YamlMap map, bool& named) {
  render::ContactChoice choice;
  const auto choose = [&map](std::string_view key, std::span<const std::string_view> names) {
    return map.optional_choice(key, 0, {names.begin(), names.end()});
  };
  std::vector<std::string_view> trackers{"auto"};
  trackers.insert(trackers.end(), render::kTrackerNames.begin(), render::kTrackerNames.end());
  const auto tracker = choose("tracker", trackers);
  named = tracker > 0;
  if (named) choice.tracker = static_cast<render::TrackerChoice>(tracker - 1);
  if (map.has("search")) {
    choice.search = static_cast<render::SearchChoice>(choose("search", render::kSearchNames));
  }
  if (map.has("blending")) {
    choice.blending =
        static_cast<render::BlendingChoice>(choose("blending", render::kBlendingNames));
  }
  if (map.has("normals")) {
    choice.normals = static_cast<render::NormalWeights>(choose("normals", render::kNormalNames));
  }
  if (map.has("curved_depth")) choice.curved_depth = map.optional_bool("curved_depth", false);
  if (map.has("crease_degrees")) {
    choice.crease_angle =
        map.require_number("crease_degrees", "degrees", 0, 180) * std::numbers::pi / 180;
  }
  choice.band = map.optional_number("band", choice.band, "m", 0, kBandMax);
  if (map.has("profile")) {
    choice.profile = static_cast<render::BlendProfile>(choose("profile", render::kProfileNames));
    if (choice.blending != render::BlendingChoice::kFixedBand &&
        choice.blending != render::BlendingChoice::kSizedBand) {
      map.reject("profile",
                 "sets how the normal turns within a band; use it with blending: "
                 "fixed_band or sized_band");
    }
  }
  map.finish();
  return choice;
}

void read_mesh(YamlMap& map, const std::filesystem::path& folder,
               const std::filesystem::path& mesh_folder, SceneObject& object) {
  if (map.has("mesh") && object.mesh) {
    object.mesh_file = map.name_of_place();
  } else if (map.has("mesh")) {
    object.mesh_file = find_mesh_file(map, folder, mesh_folder);
  } else {
    map.refuse_absence(
        "expected one of mesh, plane, sphere, box, cylinder, capsule, cone, torus and field, found "
        "none");
  }
  if (map.has("size")) object.size = map.require_number("size", "m", 1e-4, kPositionMax);
  if (object.size && map.has("scale")) {
    map.refuse("scale", "cannot be used with size; keep one of them");
  } else if (map.has("scale")) {
    object.scale = map.require_number("scale", "m per unit of the file", 1e-9, 1e9);
  }
  object.repair = map.optional_bool("repair", false);
  if (map.has("open")) {
    YamlMap open = map.require_map("open");
    object.sheet_thickness = open.require_number("thickness", "m", kSheetMin, kSheetMax);
    open.finish();
  }
}

/// Reads the memory for the pages of a page file.
void read_budget(YamlMap& map, SceneObject& object) {
  if (!map.has("budget")) return;
  object.page_budget =
      static_cast<std::size_t>(map.require_whole("budget", "MiB", kBudgetMin, kBudgetMax));
  if (!object.paged) {
    map.reject(
        "budget",
        "applies to page files only, which stay mostly on disk; remove it, or write the mesh "
        "into a page file (thimble mesh page)");
  }
}

/// Checks the keys that sheets exclude, and selects the tracker for sheets.
void read_sheets(YamlMap& map, SceneObject& object) {
  if ((object.repair || object.sheet_thickness) && object.paged) {
    map.reject(
        object.repair ? "repair" : "open",
        "cannot be used with a page file; repair the mesh before it is split into pages (thimble "
        "mesh --repair)");
    return;
  }
  if (!object.sheet_thickness) return;
  if (object.tracker_named && object.contact.tracker != render::TrackerChoice::kGodObject) {
    map.reject(
        "open",
        "needs the tracker \"god_object\", the only one that cannot pass through a sheet; remove "
        "contact: {tracker: ...}");
  }
  object.contact.tracker = render::TrackerChoice::kGodObject;
}

/// Reads the stiffness over a surface: `stiffness` becomes the largest one.
void read_stiffness_map(YamlMap& map, const std::filesystem::path& folder, SceneObject& object) {
  map.explain_unused("stiffness", "cannot be used with stiffness_map; keep one of them");
  object.stiffness_map =
      read_map(map.require_map("stiffness_map"), folder, "N/m", kMapStiffnessMin, kStiffnessMax);
  render::MapChoice& choice = *object.stiffness_map;
  object.stiffness = std::max(choice.black, choice.white);
  if (!(object.stiffness > 0)) return;  // refused already
  choice.black /= object.stiffness;
  choice.white /= object.stiffness;
}

/// Reads the factor of the frictions of an object.
void read_friction_map(YamlMap& map, const std::filesystem::path& folder, SceneObject& object) {
  object.friction_map =
      read_map(map.require_map("friction_map"), folder, "", 0, kFrictionFactorMax);
  const bool rubs = std::any_of(object.effects.begin(), object.effects.end(),
                                [](const auto& one) { return one.kind->group == "friction"; });
  if (!rubs) {
    map.reject("friction_map",
               "scales a friction, and the object has none; add effects: [{friction: bristle}]");
  }
}

/// Checks the keys that exclude maps.
void check_maps(YamlMap& map, const SceneObject& object) {
  if (!object.needs_maps()) return;
  const char* const key = object.stiffness_map  ? "stiffness_map"
                          : object.friction_map ? "friction_map"
                                                : "effects";
  const std::string what = key == std::string_view("effects") ? "with map: uv " : "";
  if (object.shape) {
    map.reject(key, what + "needs mesh: a shape has no texture coordinates; remove map: uv");
  } else if (object.paged) {
    map.reject(key, what +
                        "cannot be used with a page file, which keeps no texture coordinates or "
                        "colours; use the mesh file itself");
  } else if (object.sheet_thickness) {
    map.reject(key, what +
                        "cannot be used with open, whose rims have no texture coordinates or "
                        "colours; close the mesh in its file and remove open");
  } else if (object.body.dent || object.body.shape.named()) {
    map.reject(key, what +
                        "cannot be used on a body that deforms (dent, plastic, snap); remove the "
                        "deformation, or the map");
  }
}

/// Explains the keys of surfaces and meshes that an object without them does not use.
void explain_unused_keys(YamlMap& map) {
  for (const char* key :
       {"size", "scale", "repair", "open", "budget", "contact", "stiffness_map", "friction_map"}) {
    map.explain_unused(key, "needs mesh");
  }
  for (const char* key : {"stiffness", "damping", "effects", "body", "collision"}) {
    map.explain_unused(key, "needs a surface: a mesh or a shape");
  }
}

/// Reads how an object meets bodies.
void read_collision(YamlMap& map, const std::filesystem::path& folder, SceneObject& object) {
  if (!map.has("collision")) return;
  YamlSettings settings(map.require_map("collision"), folder);
  object.collision.emplace().read(settings);
  settings.finish();
  if (object.paged && object.collision->shape != render::CollisionShape::kNone) {
    map.reject("collision", "of a page file can only be {shape: none}");
  }
}

/// Adds the effects of a program to those of the text.
void add_effects(YamlMap& map, const std::vector<render::EffectPlan>& own, SceneObject& object) {
  for (const render::EffectPlan& plan : own) {
    if (plan.kind == nullptr || !plan.build) {
      map.refuse("", "an effect of the program needs its kind and its builder; set both");
      return;
    }
    object.effects.push_back(plan);
  }
  std::stable_sort(object.effects.begin(), object.effects.end(),
                   [](const auto& a, const auto& b) { return a.kind->order < b.kind->order; });
}

SceneObject read_object(YamlMap map, const std::filesystem::path& folder,
                        const std::filesystem::path& mesh_folder, render::EffectContext context,
                        const Eigen::Vector3d& gravity_W, const ObjectInMemory& in_memory) {
  SceneObject object;
  if (in_memory.mesh) object.mesh = in_memory.mesh;
  object.name = map.require_string("name");
  int forms = 0;
  for (const char* form :
       {"mesh", "plane", "sphere", "box", "cylinder", "capsule", "cone", "torus", "field"}) {
    forms += map.has(form);
  }
  if (forms > 1) {
    map.refuse(
        "",
        "expected one of mesh, plane, sphere, box, cylinder, capsule, cone, torus and field, "
        "found several; keep one");
    return object;
  }
  object.R_WO = map.optional_rotation("rotate_degrees");
  object.p_WO =
      map.optional_vector3("position", Eigen::Vector3d::Zero(), "m", -kPositionMax, kPositionMax);
  context.R_WO = object.R_WO;
  context.p_WO = object.p_WO;
  explain_unused_keys(map);
  if (map.has("field")) {
    object.build_field = read_field(map, folder, context);
    if (!in_memory.effects.empty()) {
      map.refuse("", "an effect of the program needs a surface: a mesh or a shape");
    }
    return object;
  }
  object.shape = read_shape(map, object.R_WO, object.p_WO);
  if (!object.shape) read_mesh(map, folder, mesh_folder, object);
  if (!object.shape && map.has("stiffness_map")) {
    read_stiffness_map(map, folder, object);
  } else {
    object.stiffness = map.require_number("stiffness", "N/m", 0, kStiffnessMax);
  }
  object.damping = map.optional_number("damping", 0, "N s/m", 0, kDampingMax);
  object.paged =
      !object.mesh && !object.mesh_file.empty() && render::is_page_file(object.mesh_file);
  if (!object.shape && map.has("contact")) {
    object.contact = read_contact(map.require_map("contact"), object.tracker_named);
  }
  if (object.paged) {
    const render::ContactChoice& c = object.contact;
    const bool uses_defaults =
        (!object.tracker_named || c.tracker == render::TrackerChoice::kPacked) && !c.search &&
        !c.blending && !c.normals && !c.curved_depth && !c.crease_angle;
    if (map.has("contact") && !uses_defaults) {
      map.reject(
          "contact",
          "a page file supports only \"tracker: compact\", and stores its creases itself; remove "
          "all other keys");
    }
    object.contact.tracker = render::TrackerChoice::kPacked;
  }
  if (!object.shape) read_budget(map, object);
  if (!object.shape) read_sheets(map, object);
  context.surface_stiffness = object.stiffness;
  context.surface_damping = object.damping;
  if (map.has("effects")) {
    object.effects = read_effects(map, folder, context);
  }
  if (!in_memory.effects.empty()) add_effects(map, in_memory.effects, object);
  if (!object.shape && map.has("friction_map")) read_friction_map(map, folder, object);
  if (map.has("body")) {
    object.body = read_body(map, folder, context, gravity_W);
    const auto names = [&object](std::string_view group) {
      return std::any_of(object.effects.begin(), object.effects.end(),
                         [&](const auto& effect) { return effect.kind->group == group; });
    };
    object.coupling = coupling_of(context, names("texture") || object.stiffness_map.has_value(),
                                  names("friction"));
    if (object.paged) {
      map.reject("body", "cannot be used with a page file, only with a mesh in memory");
    } else if (object.sheet_thickness && (object.body.dent || object.body.shape.named())) {
      map.reject("body",
                 "of a sheet can only be motion: dent, plastic and snap need a closed mesh");
    } else if (object.shape && (object.body.dent || object.body.shape.named())) {
      map.reject("body",
                 "of a shape can only be motion: dent, plastic and snap need a mesh; name a mesh");
    } else if (object.body.motion && object.shape &&
               std::holds_alternative<render::HalfSpace>(object.shape->shape_W)) {
      map.reject("body", "a plane has no end and cannot move; use a box, or remove body");
    }
  }
  read_collision(map, folder, object);
  check_maps(map, object);
  map.finish();
  return object;
}

/// Returns why a tip with a radius cannot touch an object, and the remedy; empty if it can.
std::string_view not_by_ball(const SceneObject& object) {
  if (object.paged) {
    return "is a page file, which only a point can touch; use a mesh file, or remove radius";
  }
  if (object.body.dent || object.body.shape.named()) {
    return "deforms (dent, plastic, snap), and only a point can touch it; remove the deformation, "
           "or radius";
  }
  if (object.body.motion && object.body.motion->grip) {
    return "can be held by the hand, and only a point can touch it; remove hold, or radius";
  }
  return {};
}

/// Reads the tip, and gives it to all objects.
void read_tool(YamlMap tool, Scene& scene) {
  scene.tip_radius = tool.optional_number("radius", 0, "m", 0, kTipRadiusMax);
  if (scene.tip_radius > 0 && scene.tip_radius < kTipRadiusMin) {
    tool.reject("radius", fmt::format("expected 0, a point, or {:g} m and more", kTipRadiusMin));
  }
  if (scene.tip_radius > 0) {
    for (SceneObject& object : scene.objects) {
      if (object.build_field) continue;
      const std::string_view why = not_by_ball(object);
      if (!why.empty()) tool.reject("radius", fmt::format("{} {}", in_quotes(object.name), why));
      object.contact.tip_radius = scene.tip_radius;
    }
  }
  tool.finish();
}

/// Lets the hands follow the surface at the depth that the scene names: the tip is the centre of a
/// ball.
void lift_hands(Scene& scene) {
  for (SceneArm& one : scene.arms) {
    for (HandWaypoint& waypoint : one.hand) {
      if (waypoint.on) waypoint.press -= scene.tip_radius;
    }
  }
}

/// Returns whether the stiffness of every surface is well within the stable range of the loop, with
/// one arm.
bool is_stable_at_rate(const Scene& scene, const ArmFile& file) {
  const device_sim::SimulatedArmSettings& arm = file.simulated;
  const double latency = latency_of(loop_pace(file, scene.rate));
  return std::all_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
    const double held = arm.plant.viscous + arm.hand.damping + object.damping;
    // Written so that NaN counts as unstable.
    return object.stiffness <= kStiffnessMargin * stiffness_limit(held, latency);
  });
}

/// Returns whether this holds for all arms of the scene.
bool is_stable_at_rate(const Scene& scene) {
  return std::all_of(scene.arms.begin(), scene.arms.end(),
                     [&](const SceneArm& one) { return is_stable_at_rate(scene, one.arm); });
}

/// Records a mistake if the period of the loop is so long that the gate of an arm would report a
/// stall.
void check_stall(YamlMap& root, double rate, const ArmFile& arm) {
  const double stall = 1e-9 * static_cast<double>(arm.limits.stall_ns);
  if (1 / rate <= stall) return;
  root.reject("rate",
              fmt::format("expected {:.4g} Hz or more, found {:g}: a tick would take longer "
                          "than the {:.4g} s after which the gate of {} treats the loop as "
                          "stalled",
                          1 / stall, rate, stall, arm.name));
}

}  // namespace

bool SceneObject::needs_maps() const {
  return stiffness_map || friction_map ||
         std::any_of(effects.begin(), effects.end(),
                     [](const auto& effect) { return effect.build.needs_maps(); });
}

driver::Result<Scene> read_scene(YamlFile& yaml, const std::filesystem::path& file,
                                 const SceneReading& reading,
                                 std::span<const ObjectInMemory> in_memory) {
  const std::filesystem::path& mesh_folder = reading.mesh_folder;
  YamlMap& root = yaml.root();
  const std::filesystem::path folder = file.parent_path();
  Scene scene;
  scene.file = file;
  scene.name = root.require_string("name");
  scene.description = root.optional_string("description", "");
  const bool several = root.has("arms");
  if (!several) scene.arms.front().arm_file = find_own_arm_file(root, folder);
  scene.rate =
      std::clamp(root.optional_number("rate", 1000, "Hz", kRateMin, kRateMax) * reading.rate_factor,
                 kRateMin, kRateMax);
  scene.rate_factor = reading.rate_factor;
  scene.duration = root.require_number("duration", "s", 0.001, kDurationMax);
  scene.seed =
      static_cast<std::uint64_t>(root.optional_whole("seed", 0, "", 0, std::int64_t{1} << 53));
  if (root.has("gate")) {
    YamlMap gate = root.require_map("gate");
    scene.energy =
        static_cast<driver::EnergyStage>(gate.optional_choice("energy", 0, kEnergyStageNames));
    scene.energy_line = gate.key_line("energy");
    gate.finish();
  }
  std::vector<YamlMap> arms;
  if (several) {
    if (auto read = read_arms(root, folder, reading, arms, scene); !read) return read.error();
  } else {
    root.explain_unused("faults", "needs arms, a list of two arms or more");
  }
  scene.arms.front().own_arm_file = scene.arms.front().arm_file;
  if (!reading.arm.empty()) {
    auto other = find_arm_file(reading.arm.string());
    if (!other) return other.error();
    scene.arms.front().arm_file = std::move(other).value();
  }
  std::optional<driver::Error> arm_error;
  if (!several) {
    auto arm = load_arm(scene.arms.front().arm_file);
    if (arm) {
      scene.arms.front().arm = std::move(arm).value();
    } else {
      arm_error = arm.error();
      root.ignore_checks();  // they would compare with an arm that could not be read
    }
  }
  if (!arm_error) {
    for (const SceneArm& one : scene.arms) check_stall(root, scene.rate, one.arm);
  }
  const Eigen::Vector3d gravity_W =
      root.optional_vector3("gravity", Eigen::Vector3d::Zero(), "m/s^2", -kGravityMax, kGravityMax);
  const render::EffectContext context = effect_context_of(scene.arms.front().arm, scene.rate);
  scene.objects.reserve(root.list_size("objects"));
  std::size_t number = 0;
  root.visit_maps("objects", [&](YamlMap& object) {
    const ObjectInMemory memory = number < in_memory.size() ? in_memory[number] : ObjectInMemory();
    ++number;
    scene.objects.push_back(
        read_object(std::move(object), folder, mesh_folder, context, gravity_W, memory));
  });
  read_joints(root, folder, scene);
  if (root.has("tool")) read_tool(root.require_map("tool"), scene);
  std::unordered_set<std::string_view> names;
  for (const SceneObject& object : scene.objects) {
    if (names.insert(object.name).second) continue;
    root.reject("objects", "expected different names, found " + in_quotes(object.name) + " twice");
  }
  if (several) {
    read_hands(arms, folder, scene);
  } else {
    scene.arms.front().hand = read_hand(root.require_map("hand"), scene.objects, folder,
                                        scene.arms.front().arm.simulated.hand);
  }
  lift_hands(scene);
  root.finish();
  if (auto done = yaml.finish(); !done) return done.error();
  scene.inputs = yaml.files();
  if (arm_error) return *arm_error;
  return scene;
}

namespace {

driver::Result<Scene> find_and_read_scene(const std::filesystem::path& meant,
                                          const SceneReading& reading) {
  const auto file = find_scene(meant.string());
  if (!file) return file.error();
  driver::Result<YamlFile> yaml = YamlFile::load(*file);
  if (!yaml) return yaml.error();
  return read_scene(*yaml, *file, reading);
}

}  // namespace

driver::Result<Scene> read_at_rate(
    const SceneReading& reading,
    const std::function<driver::Result<Scene>(const SceneReading&)>& read) {
  auto scene = read(reading);
  if (!(reading.rate_factor < 1) || (scene && is_stable_at_rate(*scene))) {
    if (scene && reading.rate_factor > 1) {
      const auto report_as_often = [&](ArmFile& arm) {
        auto& period_ns = arm.simulated.firmware.report_period_ns;
        period_ns = std::min<std::int64_t>(period_ns, std::llround(1e9 / scene->rate));
      };
      for (SceneArm& one : scene->arms) report_as_often(one.arm);
    }
    return scene;
  }
  SceneReading unchanged_rate = reading;
  unchanged_rate.rate_factor = 1;
  return read(unchanged_rate);
}

driver::Result<Scene> load_scene(const std::filesystem::path& meant, const SceneReading& reading) {
  return read_at_rate(reading,
                      [&meant](const SceneReading& at) { return find_and_read_scene(meant, at); });
}

}  // namespace thimble::scene
