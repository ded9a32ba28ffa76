#include "hand/read_hand.h"

#include <string>
#include <utility>

#include "hand/bag_hand.h"

namespace thimble::scene {
namespace {

// The bounds catch misplaced decimal points and values in mm, as for objects.
constexpr double kPointMax = 2;     // m
constexpr double kPushMax = 0.1;    // m
constexpr double kTimeMax = 86400;  // s

HandWaypoint read_waypoint(YamlMap map, const std::vector<SceneObject>& objects) {
  HandWaypoint waypoint;
  waypoint.time = map.require_number("t", "s", 0, kTimeMax);
  waypoint.stop = map.optional_bool("stop", false);
  for (const char* key : {"near", "press"}) {
    map.explain_unused(key, map.has("at") ? "needs on, an object, instead of at"
                                          : "needs on, an object of this scene");
  }
  if (map.has("at") == map.has("on")) {
    map.refuse("", "expected either at: [x, y, z] or on: OBJECT with near: [x, y, z]");
  } else if (map.has("at")) {
    waypoint.p_W = map.require_vector3("at", "m", -kPointMax, kPointMax);
  } else {
    waypoint.on = map.require_string("on");
    waypoint.p_W = map.require_vector3("near", "m", -kPointMax, kPointMax);
    waypoint.press = map.optional_number("press", 0, "m", -kPushMax, kPushMax);
    bool known = false, is_field = false;
    for (const SceneObject& object : objects) {
      if (object.name != *waypoint.on) continue;
      known = true;
      is_field = object.build_field != nullptr;
      if (object.paged) {
        map.reject(
            "on",
            "a page file is not in memory, so no path over its surface can be planned; give the "
            "points by at: [x, y, z]");
      }
    }
    if (!known) map.reject("on", "expected an object of this scene, found \"" + *waypoint.on + '"');
    if (is_field) map.reject("on", "a field has no surface; use at: [x, y, z]");
  }
  map.finish();
  return waypoint;
}

/// Reads how the simulated hand holds the arm, if the scene replaces the values of the arm file.
/// The limits are the same.
void read_grip(YamlMap map, device_sim::HandSettings& hand) {
  hand.mass = map.optional_number("mass", hand.mass, "kg", 0, 10);
  hand.stiffness = map.optional_number("stiffness", hand.stiffness, "N/m", 0, 1e5);
  hand.damping = map.optional_number("damping", hand.damping, "N s/m", 0, 1000);
  hand.tremor_amplitude = map.optional_number("tremor", hand.tremor_amplitude, "m", 0, 0.01);
  map.finish();
}

/// Reads the path in a ROS bag; `folder`: that of the scene.
std::vector<HandWaypoint> read_bag_path(YamlMap& map, const std::filesystem::path& folder) {
  const std::string text = map.require_string("bag");
  const std::string topic = map.optional_string("topic", "");
  const std::size_t axes = map.optional_choice("axes", 0, {"plain", "omni"});
  if (map.has("path")) map.refuse("path", "cannot be used with bag; keep one of them");
  if (text.empty()) return {};
  const std::filesystem::path bag = (folder / text).lexically_normal();
  map.note_file(bag);
  auto hand = read_bag_hand(bag, topic, static_cast<bag::BagAxes>(axes));
  if (hand) return std::move(hand).value();
  std::string sentence = hand.error().message;  // becomes part of another sentence
  if (sentence.ends_with('.')) sentence.pop_back();
  map.refuse("bag", sentence);
  return {};
}

}  // namespace

std::vector<HandWaypoint> read_hand(YamlMap map, const std::vector<SceneObject>& objects,
                                    const std::filesystem::path& folder,
                                    device_sim::HandSettings& grip) {
  std::vector<HandWaypoint> hand;
  if (map.has("grip")) read_grip(map.require_map("grip"), grip);
  if (map.has("bag")) {
    hand = read_bag_path(map, folder);
    map.finish();
    return hand;
  }
  for (const char* key : {"topic", "axes"}) {
    map.explain_unused(key, "needs bag, a ROS 2 bag, instead of path");
  }
  if (map.key_line("path") == 0 &&
      map.refuse_absence("hand: expected either path or bag, found neither")) {
    map.finish();
    return hand;
  }
  for (YamlMap& entry : map.require_maps("path")) {
    hand.push_back(read_waypoint(entry, objects));
    if (hand.size() > 1 && !(hand.back().time > hand[hand.size() - 2].time)) {
      entry.reject("t", "expected a later time than that of the waypoint before");
    }
  }
  map.finish();
  return hand;
}

}  // namespace thimble::scene
