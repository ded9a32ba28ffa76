#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include "files/file_hashes.h"
#include "log/progress.h"
#include "recording/replay_watch.h"
#include "recording/replayed_law.h"
#include "recording/run_choices.h"
#include "text_file.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/quality.h"
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

/// Returns the recorded state of the arm, `dt` (s) after the previous tick.
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

/// Returns a recorded tick with the newly computed force and contact; the force sent to the motors
/// is the recorded one.
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

/// Starts a replay of a recording in a scene.
Replay begin_replay(const Recording& recording, const scene::Scene& scene,
                    const std::filesystem::path& file) {
  Replay replay;
  RecordingInfo& info = replay.felt.info;
  info = recording.info;
  info.scene = scene.name;
  info.scene_file = file.string();
  info.scene_text = scene::text_of(file);
  info.file_hashes = scene::FileHashes(scene.inputs).text();
  info.program = scene::program_name();
  info.device = "replay";
  info.clock = "virtual";
  replay.felt.complete = true;
  replay.felt.ticks.reserve(recording.ticks.size());
  return replay;
}

constexpr const char* kProgressName = "replay";

/// Passes the arm's state of one tick to the scene's force law, and compares the result with the
/// recording. An arm in fault felt nothing, so nothing is computed.
void replay_tick(const Recording& recording, std::size_t i, ReplayedLaw& law, Replay& replay) {
  const TickRecord& then = recording.ticks[i];
  const std::int64_t before_ns = recording.ticks[i == 0 ? 0 : i - 1].time_ns;
  // Computed as by the device, so that it is bit-identical.
  const double dt = static_cast<double>(then.time_ns - before_ns) * 1e-9;
  // A fault found in reading the arm precedes the law, and a fault of the gate follows it. If the
  // law was not called in the run, it is not called here.
  const driver::DeviceState state = state_of(then, dt);
  const Eigen::Vector3d wanted = vector(then.f_wanted_W);
  const bool off = !recording.info.arm_in_scene.empty() && then.fault != driver::Fault::kNone &&
                   !then.in_contact && (wanted.isZero(0) || wanted == law.carried(state));
  const driver::ForceCommand command =
      off ? driver::ForceCommand{.f_T_W = wanted, .touch = {}} : law(state, then);
  replay.felt.ticks.push_back(with_answer(then, command));
  law.take(replay.felt.ticks.back());
  compare(then, replay.felt.ticks.back(), replay.compared);
}

/// Returns the index of each arm's recording, in the scene's order.
driver::Result<std::vector<std::size_t>> arms_of(std::span<const Recording> recordings,
                                                 const scene::Scene& scene,
                                                 const std::filesystem::path& file) {
  std::vector<std::string> names;
  for (const scene::SceneArm& arm : scene.arms) names.push_back(arm.name);
  std::vector<std::size_t> order;
  for (const std::string& name : names) {
    const auto is_it = [&name](const Recording& one) { return one.info.arm_in_scene == name; };
    const auto found = std::find_if(recordings.begin(), recordings.end(), is_it);
    if (found == recordings.end()) {
      return driver::Error{
          file.string() + ": the recording of the arm \"" + name +
          "\" is missing. The arms share one scene, so pass the recordings of all arms."};
    }
    order.push_back(static_cast<std::size_t>(found - recordings.begin()));
  }
  const Recording& first = recordings.front();
  for (const Recording& one : recordings) {
    const bool same = one.ticks.size() == first.ticks.size() && one.info.rate == first.info.rate &&
                      one.info.scene_text == first.info.scene_text &&
                      one.info.options == first.info.options &&
                      one.info.file_hashes == first.info.file_hashes;
    if (!same || recordings.size() != names.size()) {
      return driver::Error{file.string() + ": the recordings are not from one run of its " +
                           std::to_string(names.size()) + " arms."};
    }
  }
  return order;
}

}  // namespace

namespace {

/// Returns whether the run of a recording had several arms.
bool of_several(const Recording& recording) {
  return !recording.info.arm_in_scene.empty();
}

/// Loads the scene of a recording with the options of its run.
driver::Result<scene::Scene> load_scene_of(const Recording& recording,
                                           const std::filesystem::path& file, bool several) {
  const auto choices = run_choices(recording.info.options);
  if (!choices) return choices.error();
  auto scene = scene::load_scene(file, {.arm = several ? std::string() : recording.info.arm_file,
                                        .rate_factor = choices->rate_factor,
                                        .several_arms = several});
  if (!scene) return scene;
  const auto quality = scene::quality_named(choices->quality);
  scene::apply_quality(quality.value_or(scene::Quality::kNormal), *scene, choices->budget);
  return scene;
}

/// Builds the objects of a scene and passes them to `watch`, if it is not null.
driver::Result<std::shared_ptr<scene::SceneObjects>> build(const scene::Scene& scene,
                                                           ReplayWatch* watch) {
  auto built = scene::SceneObjects::build(scene);
  if (!built) return built.error();
  std::shared_ptr<scene::SceneObjects> objects = std::move(built).value();
  if (watch != nullptr) watch->begin(scene, objects);
  return objects;
}

driver::Result<Replay> replay_single(const Recording& recording, const std::string& scene_name,
                                     ReplayWatch* watch) {
  const auto file = scene_of(recording, scene_name);
  if (!file) return file.error();
  const auto scene = load_scene_of(recording, *file, false);
  if (!scene) return scene.error();
  const auto objects = build(*scene, watch);
  if (!objects) return objects.error();

  Replay replay = begin_replay(recording, *scene, *file);
  ReplayedLaw law(recording, *scene, scene->arms.front().arm, (*objects)->touch());
  scene::Progress progress(kProgressName);
  for (std::size_t i = 0; i < recording.ticks.size(); ++i) {
    progress.set_share(i + 1, recording.ticks.size());
    replay_tick(recording, i, law, replay);
    (*objects)->serve_pages();
    if (watch != nullptr) watch->take(replay.felt.ticks.back());
  }
  return replay;
}

}  // namespace

driver::Result<Replay> replay(const Recording& recording, const std::string& scene_name) {
  return replay_single(recording, scene_name, nullptr);
}

driver::Result<std::vector<Replay>> replay_together(std::span<const Recording> recordings,
                                                    const std::string& scene_name) {
  return replay_together(recordings, scene_name, nullptr);
}

driver::Result<std::vector<Replay>> replay_together(std::span<const Recording> recordings,
                                                    const std::string& scene_name,
                                                    ReplayWatch* watch) {
  if (recordings.empty()) return driver::Error{"No recording to replay was given."};
  if (recordings.size() == 1 && recordings.front().info.arm_in_scene.empty()) {
    auto alone = replay_single(recordings.front(), scene_name, watch);
    if (!alone) return alone.error();
    std::vector<Replay> one;
    one.push_back(std::move(alone).value());
    return one;
  }
  const auto file = scene_of(recordings.front(), scene_name);
  if (!file) return file.error();
  const auto scene = load_scene_of(recordings.front(), *file, true);
  if (!scene) return scene.error();
  const auto order = arms_of(recordings, *scene, *file);
  if (!order) return order.error();
  const auto objects = build(*scene, watch);
  if (!objects) return objects.error();
  std::vector<Replay> replays;
  for (const Recording& recording : recordings) {
    replays.push_back(begin_replay(recording, *scene, *file));
  }
  std::vector<std::unique_ptr<ReplayedLaw>> laws;
  for (std::size_t arm = 0; arm < order->size(); ++arm) {
    laws.push_back(std::make_unique<ReplayedLaw>(recordings[(*order)[arm]], *scene,
                                                 scene->arms[arm].arm, (*objects)->touch(arm)));
  }
  const double period = 1 / recordings.front().info.rate;
  scene::Progress progress(kProgressName);
  for (std::size_t i = 0; i < recordings.front().ticks.size(); ++i) {
    progress.set_share(i + 1, recordings.front().ticks.size());
    // Same order as in the run: each arm in the scene's order, then the bodies.
    for (std::size_t arm = 0; arm < order->size(); ++arm) {
      const std::size_t k = (*order)[arm];
      replay_tick(recordings[k], i, *laws[arm], replays[k]);
    }
    (*objects)->step_bodies(period);
    (*objects)->serve_pages();
    if (watch != nullptr) watch->take(replays[order->front()].felt.ticks.back());
  }
  return replays;
}

std::string unhashed_files(const Recording& recording, const std::string& scene) {
  if (!recording.info.file_hashes.empty()) return {};
  const auto file = scene_of(recording, scene);
  if (!file) return {};
  const auto read = load_scene_of(recording, *file, of_several(recording));
  if (!read || read->inputs.empty()) return {};
  std::string names;
  for (const std::filesystem::path& input : read->inputs) {
    names += (names.empty() ? "" : ", ") + input.string();
  }
  return "The recording is of a version that did not store hashes of files other than scene and "
         "arm, so these may have changed: " +
         names + ".";
}

driver::Result<void> check_repeatable(const Recording& recording, const std::string& scene) {
  const auto& ticks = recording.ticks;
  // A gap means that the disk was too slow. Missed periods of the loop leave no gap here.
  const auto gap = std::adjacent_find(ticks.begin(), ticks.end(), [](const auto& a, const auto& b) {
    return b.tick != a.tick + 1;
  });
  if (gap != ticks.end()) {
    return driver::Error{"ticks are missing in the recording because the disk was too slow."};
  }
  if (!ticks.empty() && ticks.front().tick != 0) {
    return driver::Error{"the recording does not start with the first tick of the run."};
  }
  const auto other_law = [](const TickRecord& tick) {
    return tick.setting == TickRecord::kOtherLaw;
  };
  if (std::any_of(ticks.begin(), ticks.end(), other_law)) {
    return driver::Error{
        "the forces of this run came from a program or a topic, not from the scene alone."};
  }
  const auto choices = run_choices(recording.info.options);
  if (!choices) return choices.error();
  if (choices->adjusted) {
    return driver::Error{"a program changed the scene of this run after it was read."};
  }
  const auto file = scene_of(recording, scene);
  if (!file) return file.error();
  if (scene::text_of(*file) != recording.info.scene_text) {
    return driver::Error{file->string() + " has changed since the recording."};
  }
  const std::filesystem::path arm = recording.info.arm_file;
  if (!arm.empty() && scene::text_of(arm) != recording.info.arm_text) {
    return driver::Error{arm.string() + " has changed since the recording."};
  }
  if (!recording.info.file_hashes.empty()) {
    const auto read = load_scene_of(recording, *file, of_several(recording));
    if (!read) return read.error();
    auto same = scene::check_file_hashes(recording.info.file_hashes, read->inputs);
    if (!same) return same;
  }
  if (scene::program_name() != recording.info.program) {
    const std::string unhashed = unhashed_files(recording, scene);
    return driver::Error{"recorded by " + recording.info.program + ", this is " +
                         scene::program_name() + "; only the same build is bit-identical." +
                         (unhashed.empty() ? "" : " " + unhashed)};
  }
  return {};
}

}  // namespace thimble::session
