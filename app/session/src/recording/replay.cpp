#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include "text_file.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/recording.h"

namespace thimble::session {
namespace {

using driver::TickRecord;

Eigen::Vector3d vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}
std::array<double, 3> plain(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Returns the state that the arm was in, `dt` (s) after the tick before.
driver::DeviceState state_of(const TickRecord& then, double dt) {
  driver::DeviceState state;
  state.time_ns = then.time_ns;
  state.tick = then.tick;
  state.dt = dt;
  state.p_WT = vector(then.p_WT);
  state.v_WT = vector(then.v_WT);
  state.q = vector(then.q);
  state.counts = then.counts;
  state.buttons = then.buttons;
  state.fresh = then.fresh;
  state.has_orientation = then.q_WT != driver::TipQuaternion{};
  state.q_WT = then.q_WT;
  state.R_WT = driver::rotation_of(then.q_WT);
  state.gimbal = then.gimbal;
  state.has_gripper = then.has_gripper;
  state.gripper = then.gripper;
  return state;
}

/// Returns a recorded tick with the scene's new answer; what the motors got is the recorded one.
TickRecord with_answer(const TickRecord& then, const driver::ForceCommand& command) {
  TickRecord now = then;
  now.f_wanted_W = plain(command.f_T_W);
  now.in_contact = command.touch.in_contact;
  now.object = command.touch.object;
  now.feature = command.touch.feature;
  now.depth = command.touch.depth;
  now.p_WP = plain(command.touch.p_WP);
  now.n_W = plain(command.touch.n_W);
  now.hops = command.touch.hops;
  return now;
}

void compare(const TickRecord& then, const TickRecord& now, ReplayComparison& compared) {
  using Bits = std::array<std::uint64_t, 3>;
  ++compared.ticks;
  if (std::bit_cast<Bits>(now.f_wanted_W) == std::bit_cast<Bits>(then.f_wanted_W)) return;
  ++compared.differing;
  if (!compared.first) compared.first = then.tick;
  const double difference = (vector(now.f_wanted_W) - vector(then.f_wanted_W)).norm();
  // Written so that NaN counts as the largest.
  if (!(difference <= compared.largest)) compared.largest = difference;
}

driver::Result<std::filesystem::path> scene_of(const Recording& recording,
                                               const std::string& scene) {
  if (scene.empty()) return std::filesystem::path(recording.info.scene_file);
  return scene::find_scene(scene);
}

}  // namespace

driver::Result<Replay> replay(const Recording& recording, const std::string& scene_name) {
  const auto file = scene_of(recording, scene_name);
  if (!file) return file.error();
  const auto scene = scene::load_scene(*file, {.arm = recording.info.arm_file});
  if (!scene) return scene.error();
  auto objects = scene::SceneObjects::build(*scene);
  if (!objects) return objects.error();

  Replay replay;
  RecordingInfo& info = replay.felt.info;
  info = recording.info;
  info.scene = scene->name;
  info.scene_file = file->string();
  info.scene_text = scene::text_of(*file);
  info.program = scene::program_name();
  info.device = "replay";
  info.clock = "virtual";
  replay.felt.complete = true;
  replay.felt.ticks.reserve(recording.ticks.size());
  std::int64_t before_ns = recording.ticks.empty() ? 0 : recording.ticks.front().time_ns;
  for (const TickRecord& then : recording.ticks) {
    // As the device reckons it, so that it is the same to the bit.
    const double dt = static_cast<double>(then.time_ns - before_ns) * 1e-9;
    before_ns = then.time_ns;
    const driver::ForceCommand command = (*objects)->touch()(state_of(then, dt));
    (*objects)->serve_pages();
    replay.felt.ticks.push_back(with_answer(then, command));
    compare(then, replay.felt.ticks.back(), replay.compared);
  }
  return replay;
}

driver::Result<void> check_repeatable(const Recording& recording, const std::string& scene) {
  const auto& ticks = recording.ticks;
  // Where the disk was too slow; missed periods of the loop are not missing ticks.
  const auto gap = std::adjacent_find(ticks.begin(), ticks.end(), [](const auto& a, const auto& b) {
    return b.tick != a.tick + 1;
  });
  if (gap != ticks.end()) {
    return driver::Error{"ticks are missing in the recording, because the disk was slow."};
  }
  if (!ticks.empty() && ticks.front().tick != 0) {
    return driver::Error{"the recording does not begin with the run's first tick."};
  }
  const auto file = scene_of(recording, scene);
  if (!file) return file.error();
  if (scene::text_of(*file) != recording.info.scene_text) {
    return driver::Error{file->string() +
                         " is not the scene that was recorded; it has been changed since."};
  }
  if (scene::program_name() != recording.info.program) {
    return driver::Error{"recorded by " + recording.info.program + ", this is " +
                         scene::program_name() + "; only the same build promises the same bits."};
  }
  return {};
}

}  // namespace thimble::session
