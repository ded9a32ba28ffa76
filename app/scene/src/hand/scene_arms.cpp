#include "hand/scene_arms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "hand/read_hand.h"
#include "math/elementary.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::scene {
namespace {

constexpr double kPlaceMax = 2;      // m
constexpr std::size_t kArmsMax = 8;  // [chosen: two users with two hands each, and a reserve]

/// Rotates a box by multiples of 90 degrees about z.
WorkspaceBox rotated_box(const WorkspaceBox& box, const Eigen::Matrix3d& R) {
  const Eigen::Vector3d a = R * box.min_W, b = R * box.max_W;
  return {.min_W = a.cwiseMin(b), .max_W = a.cwiseMax(b)};
}

/// Reads the place of an arm: rotated about the vertical, as on a desk, and then moved.
ArmPlace read_place(YamlMap map) {
  const Eigen::Vector3d p =
      map.optional_vector3("position", Eigen::Vector3d::Zero(), "m", -kPlaceMax, kPlaceMax);
  const double degrees = map.optional_number("turn_degrees", 0, "degrees", -360, 360);
  const double quarters = degrees / 90;
  if (std::round(quarters) != quarters) {
    map.refuse("turn_degrees",
               fmt::format("expected a multiple of 90, so that the workspace stays a box along the "
                           "world's axes, found {:g}",
                           degrees));
  }
  // Exact for multiples of 90 degrees.
  const double turn = std::round(quarters) * std::numbers::pi / 2;
  const double c = std::round(math::cos(turn)), s = std::round(math::sin(turn));
  ArmPlace place;
  place.R << c, -s, 0, s, c, 0, 0, 0, 1;
  place.p = p;
  map.finish();
  return place;
}

/// Returns the arm file that an entry names: next to the scene, or by name.
driver::Result<std::filesystem::path> file_of(const std::string& text,
                                              const std::filesystem::path& folder) {
  const std::filesystem::path beside = (folder / text).lexically_normal();
  std::error_code status;
  if (std::filesystem::is_regular_file(beside, status)) return beside;
  return find_arm_file(text);
}

driver::Result<SceneArm> read_arm_entry(YamlMap& map, const std::filesystem::path& folder) {
  SceneArm entry;
  for (const char* key :
       {"description", "rate", "duration", "seed", "gate", "faults", "objects", "tool"}) {
    map.explain_unused(
        key, "applies to the whole scene; move it out of arms, to the top level of the file");
  }
  entry.name = map.require_string("name");
  // The name becomes part of names of folders and of groups of files.
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (!std::all_of(entry.name.begin(), entry.name.end(), plain)) {
    map.refuse("name", "expected letters, digits and _, found \"" + entry.name + "\"");
  }
  const std::string text = map.require_string("arm");
  const auto in_entry = [&entry](const driver::Error& error) {
    return driver::Error{"The arm \"" + entry.name + "\": " + error.message};
  };
  if (!text.empty()) {
    auto file = file_of(text, folder);
    if (!file) return in_entry(file.error());
    entry.arm_file = std::move(file).value();
    auto arm = load_arm(entry.arm_file);
    if (!arm) return in_entry(arm.error());
    entry.arm = std::move(arm).value();
  }
  if (map.has("at")) {
    entry.place = read_place(map.require_map("at"));
    entry.arm = entry.place.put(std::move(entry.arm));
  }
  return entry;
}

std::string names_of(const std::vector<SceneArm>& arms) {
  std::string names;
  for (const SceneArm& arm : arms) names += (names.empty() ? "" : ", ") + arm.name;
  return names;
}

}  // namespace

ArmFile ArmPlace::put(ArmFile arm) const {
  arm.R_WB = R * arm.R_WB;
  arm.p_WB = R * arm.p_WB + p;
  arm.workspace = rotated_box(arm.workspace, R);
  arm.workspace.min_W += p;
  arm.workspace.max_W += p;
  return arm;
}

driver::Result<void> read_arms(YamlMap& root, const std::filesystem::path& folder,
                               const SceneReading& reading, std::vector<YamlMap>& arms,
                               Scene& scene) {
  arms = root.require_maps("arms");
  scene.faults = static_cast<FaultRule>(root.optional_choice("faults", 0, {"together", "apart"}));
  for (const char* key : {"arm", "hand"}) {
    if (root.has(key)) {
      root.refuse(key, "cannot be used with arms; each entry of arms has its own");
    }
  }
  root.explain_unused("at", "is the place of one arm; move it into an entry of arms");
  if (arms.size() == 1) root.refuse("arms", "expected two arms or more; for one use arm and hand");
  if (arms.size() > kArmsMax) {
    root.refuse("arms", fmt::format("expected at most {} arms, found {}", kArmsMax, arms.size()));
    arms.resize(kArmsMax, arms.front());
  }
  std::vector<SceneArm> read;
  for (YamlMap& map : arms) {
    auto entry = read_arm_entry(map, folder);
    if (!entry) return driver::Error{scene.file.string() + ": " + entry.error().message};
    for (const SceneArm& other : read) {
      if (other.name == entry->name) {
        map.reject("name", "expected different names, found \"" + entry->name + "\" twice");
      }
    }
    read.push_back(std::move(entry).value());
  }
  if (read.size() > 1 && !reading.several_arms) {
    return driver::Error{fmt::format(
        "{}: the scene has {} arms, but this command supports one. Pass a copy of the scene for "
        "each arm ({}), in which arm and hand of its entry replace arms. If the entry has at, also "
        "move the objects and the hand's path into the frame of the arm.",
        scene.file.string(), read.size(), names_of(read))};
  }
  if (read.size() > 1 && !reading.arm.empty()) {
    return driver::Error{
        fmt::format("{}: the scene has {} arms, so one arm file cannot replace them all; change "
                    "the entries of arms.",
                    scene.file.string(), read.size())};
  }
  if (!read.empty()) scene.arms = std::move(read);
  return {};
}

void read_hands(std::vector<YamlMap>& arms, const std::filesystem::path& folder, Scene& scene) {
  for (std::size_t i = 0; i < arms.size(); ++i) {
    SceneArm& arm = scene.arms[i];
    arm.hand =
        read_hand(arms[i].require_map("hand"), scene.objects, folder, arm.arm.simulated.hand);
    arms[i].finish();
  }
}

}  // namespace thimble::scene
