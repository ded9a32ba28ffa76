#include "joints_section.h"

#include <algorithm>
#include <string>

#include "yaml/yaml_settings.h"
#include "yaml/yaml_words.h"

namespace thimble::scene {
namespace {

constexpr std::int64_t kIterationsMax = 1000;  // [chosen: one step of ten bodies takes 1 ms then]
constexpr std::int64_t kSubstepsMax = 64;      // [chosen]
constexpr std::int64_t kEveryMax = 32;         // [chosen: 31 Hz in a loop of 1 kHz]

/// Returns the index of an object that a joint can hold, named by a key; -1 if there is none.
int object_named(YamlMap& joint, const char* key, const Scene& scene) {
  const std::string name = joint.require_string(key);
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                  [&](const SceneObject& object) { return object.name == name; });
  if (found == scene.objects.end()) {
    joint.reject(key, "expected the name of an object, found " + in_quotes(name));
    return -1;
  }
  if (found->build_field || found->paged) {
    joint.reject(key, in_quotes(name) + " is a field or a page file, which has no joints");
  }
  return static_cast<int>(found - scene.objects.begin());
}

}  // namespace

void read_joints(YamlMap& root, const std::filesystem::path& folder, Scene& scene) {
  if (root.has("joints")) {
    for (YamlMap& map : root.require_maps("joints")) {
      SceneJoint joint;
      joint.a = object_named(map, "object", scene);
      if (map.has("on")) {
        joint.b = object_named(map, "on", scene);
        if (joint.a >= 0 && joint.a == joint.b) {
          map.reject("on", "expected another object than the joint's own");
        }
      }
      const auto moves = [&](int i) {
        return i >= 0 && scene.objects[static_cast<std::size_t>(i)].body.motion.has_value();
      };
      if (joint.a >= 0 && !moves(joint.a) && !moves(joint.b)) {
        map.reject("object", "must move, or that of on; add body: {motion: {mass: ...}}");
      }
      YamlSettings settings(map, folder);
      joint.choice.read(settings);
      settings.finish();
      const auto turns = [&](int i) {
        return moves(i) && scene.objects[static_cast<std::size_t>(i)].body.motion->kind ==
                               render::MotionKind::kRigid;
      };
      const bool turning = joint.choice.kind == render::JointKind::kHinge ||
                           joint.choice.kind == render::JointKind::kBall;
      if (turning && (moves(joint.a) || moves(joint.b)) && !turns(joint.a) && !turns(joint.b)) {
        map.reject("object",
                   "only translates, so the joint cannot turn it; set kind: rigid in its "
                   "body: {motion: ...}");
      }
      scene.joints.push_back(joint);
    }
  }
  if (root.has("collisions")) {
    YamlMap map = root.require_map("collisions");
    render::CollisionQuality& quality = scene.collisions;
    quality.iterations = static_cast<std::size_t>(map.optional_whole(
        "iterations", static_cast<std::int64_t>(quality.iterations), "", 1, kIterationsMax));
    quality.substeps = static_cast<std::size_t>(map.optional_whole(
        "substeps", static_cast<std::int64_t>(quality.substeps), "", 1, kSubstepsMax));
    quality.every = static_cast<std::size_t>(map.optional_whole(
        "every", static_cast<std::int64_t>(quality.every), "ticks", 1, kEveryMax));
    if (quality.every > 1 && quality.substeps > 1) {
      map.reject("every", "cannot be combined with substeps, which make the steps shorter");
    }
    map.finish();
  }
}

}  // namespace thimble::scene
