#include <filesystem>
#include <memory>
#include <utility>

#include "files/file_hashes.h"
#include "meshes/object_mesh.h"
#include "recording/replay_trajectory.h"
#include "text_file.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::session {
namespace {

/// Transforms a trajectory from the frame of an object's mesh file into the world; unchanged if no
/// object is named.
driver::Result<void> into_world(std::vector<TrajectoryPoint>& trajectory, const scene::Scene& scene,
                                const std::string& frame) {
  if (frame.empty() || frame == "world") return {};
  for (const scene::SceneObject& object : scene.objects) {
    if (object.name != frame) continue;
    if (object.mesh_file.empty() || object.paged) {
      return driver::Error{"--frame: \"" + frame + "\" has no mesh file in memory; use a " +
                           "trajectory in the world frame, in m."};
    }
    const auto mesh = scene::load_object_mesh(object);
    if (!mesh) return mesh.error();
    const scene::MeshPlacement& place = mesh->place;
    for (TrajectoryPoint& point : trajectory) {
      point.p = place.p_WM + place.scale * (object.R_WO * point.p);
      point.f = object.R_WO * point.f;
    }
    return {};
  }
  return driver::Error{"--frame: expected world or an object of the scene, found \"" + frame +
                       "\"."};
}

}  // namespace

driver::Result<TrajectoryReplay> touch_along(std::vector<TrajectoryPoint> trajectory,
                                             const std::string& frame,
                                             const std::filesystem::path& scene_file) {
  const auto scene = scene::load_scene(scene_file);
  if (!scene) return scene.error();
  if (auto placed = into_world(trajectory, *scene, frame); !placed) return placed.error();
  auto objects = scene::SceneObjects::build(*scene);
  if (!objects) return objects.error();
  TrajectoryReplay replay;
  replay.compared =
      replay_trajectory(trajectory, scene->rate, **objects,
                        [&](const driver::TickRecord& tick) { replay.felt.ticks.push_back(tick); });
  replay.felt.complete = true;
  replay.felt.info = {.scene = scene->name,
                      .scene_file = scene_file.string(),
                      .scene_text = scene::text_of(scene_file),
                      .arm = scene->arms.front().arm.name,
                      .arm_file = scene->arms.front().arm_file.string(),
                      .arm_text = scene::text_of(scene->arms.front().arm_file),
                      .device = {},
                      .clock = "virtual",
                      .program = scene::program_name(),
                      .rate = scene->rate,
                      .seed = scene->seed,
                      .file_hashes = scene::FileHashes(scene->inputs).text()};
  return replay;
}

driver::Result<TrajectoryReplay> replay_trajectory_file(const std::filesystem::path& file,
                                                        TrajectoryForm form,
                                                        const std::string& frame,
                                                        const std::filesystem::path& scene_file) {
  // In the frame of a mesh file, lengths are in the file's unit.
  if (!frame.empty() && frame != "world") {
    form.metres = 1;
    form.farthest = 1e9;
  }
  auto trajectory = read_trajectory(file, form);
  if (!trajectory) return trajectory.error();
  constexpr double kLongest = 86400;  // s
  if (!(trajectory->back().time - trajectory->front().time < kLongest)) {
    return driver::Error{file.string() +
                         " lasts more than a day; set the unit of time with --time."};
  }
  auto replay = touch_along(std::move(trajectory).value(), frame, scene_file);
  if (replay) replay->felt.info.device = "trajectory " + file.string();
  return replay;
}

}  // namespace thimble::session
