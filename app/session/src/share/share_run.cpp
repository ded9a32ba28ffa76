#include "share/share_run.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "share/describe_scene.h"

namespace thimble::session {
namespace {

// Time that a viewer's plots can show, and largest number of ticks in memory (32 MB). Chosen.
constexpr double kShownSeconds = 8;
constexpr std::size_t kShownTicksMax = 100'000;
constexpr int kRunsOfAScene = 100;  // largest number of simultaneous runs of one scene; chosen

}  // namespace

driver::Result<std::unique_ptr<SharedRun>> share_run(const Setup& setup, const LiveKnobs& knobs,
                                                     const SessionOptions& options,
                                                     SharedRun* before) {
  // Before the meshes of many shapes are made.
  if (auto fits = check_object_count(setup.scene().objects.size()); !fits) return fits.error();
  std::vector<std::string> devices;
  for (std::size_t i = 0; i < setup.arms(); ++i) devices.push_back(setup.device_name(i));
  SharedScene scene = describe_scene(setup.scene(), setup.objects(), devices);
  scene.file = setup.scene_path();
  scene.period_ns = setup.period_ns();
  scene.duration =
      1e-9 * static_cast<double>(setup.period_ns()) * static_cast<double>(setup.ticks());
  scene.wall_clock = setup.real_time();
  scene.hand_by_mouse = setup.hand_by_mouse();
  scene.hold_by_key = setup.hold().by_caller;
  scene.paced = setup.paced();
  scene.restarts = options.restarts && !setup.any_real();
  if (setup.arms() == 1) scene.knobs = knobs.described();
  const auto ring = std::min(
      static_cast<std::size_t>(std::ceil(kShownSeconds * setup.scene().rate)), kShownTicksMax);
  if (before != nullptr) return SharedRun::create_next(*before, scene, ring);
  const std::string asked = options.share_name.empty() ? setup.scene().name : options.share_name;
  const std::string name = options.share_out ? run_name_of(asked) : "";
  auto shared = SharedRun::create(name, scene, ring);
  // If the name is that of the scene, a second run of the scene gets a number.
  for (int number = 2; !shared && options.share_name.empty() && number < kRunsOfAScene; ++number) {
    if (!run_name_taken(name)) break;
    std::string next = name;
    next += '-' + std::to_string(number);
    shared = SharedRun::create(next, scene, ring);
  }
  return shared;
}

std::vector<RunSharing::Shaped> shaped_objects(const Setup& setup) {
  std::vector<RunSharing::Shaped> shaped;
  std::size_t first = 0, first_split = 0;
  for (std::size_t i = 0; i < setup.scene().objects.size(); ++i) {
    if (!setup.scene().objects[i].body.shape.named()) continue;
    const render::BodyShape* shape = setup.objects().touch().object(i).shape();
    const std::size_t vertices = setup.objects().mesh_W(i).vertices.size();
    shaped.push_back({.shape = shape,
                      .first = first,
                      .first_split = first_split,
                      .vertices = static_cast<std::int32_t>(vertices)});
    first += vertices + shape->splits_left();
    first_split += shape->splits_left();
  }
  return shaped;
}

}  // namespace thimble::session
