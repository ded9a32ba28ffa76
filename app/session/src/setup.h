#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "heat_keeper.h"
#include "start_pose.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/real_arm_terms.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// What a session runs: a scene with its objects, and the arm that touches them, on one clock.
class Setup {
 public:
  /// Does what takes time and needs no arm: reads the scene, its arm and its meshes, plans the
  /// simulated hand's path and builds the objects. The error names the file and what to mend.
  /// Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Setup>> prepare(const std::filesystem::path& scene,
                                                        const SessionOptions& options);
  /// Starts the clock and opens the arm: a simulated one may get forces from then on, a real one
  /// is idle. Once. Real-time: never from the servo thread.
  driver::Result<void> open_arm();
  /// Fails if the tip of a real arm is not where it must be before a force may come; a simulated
  /// arm's always is. Precondition: the arm is open. Real-time: never from the servo thread.
  driver::Result<void> check_start_pose() const;

  const scene::Scene& scene() const noexcept { return scene_; }
  scene::SceneObjects& objects() const noexcept { return *objects_; }
  /// Returns the arm as the loop drives it. Precondition: the arm is open, as for `clock`.
  driver::Device& device() const noexcept { return *device_; }
  driver::Clock& clock() const noexcept { return *clock_; }
  /// Returns the simulation of the arm; null if the arm is real.
  scene::ArmSimulation* simulation() const noexcept { return simulation_.get(); }
  /// Returns where the tip of the real arm must be before it gets a force. Precondition: it is
  /// real.
  const StartPose& start_pose() const noexcept { return *start_pose_; }
  /// Returns the arm on the desk, if it is not simulated.
  const std::optional<driver::FoundArm>& real_arm() const noexcept { return real_arm_; }
  /// Returns the firmware image for an arm that needs one; may be empty.
  const std::filesystem::path& firmware() const noexcept { return firmware_; }

  /// Returns whether the run goes by the time of the world; threads load pages and write then.
  bool real_time() const noexcept { return real_time_; }
  /// Returns whether a real arm's counters are known to be right: it was in its home pose when it
  /// got power.
  bool homed() const noexcept { return homed_; }
  /// Returns whether it runs until it is stopped, faults or not.
  bool endless() const noexcept { return endless_; }
  /// Returns whether a viewer leads the simulated hand.
  bool hand_by_mouse() const noexcept { return hand_by_mouse_; }
  std::int64_t period_ns() const noexcept { return period_ns_; }  ///< Between two ticks.
  /// Returns how many periods the run lasts; 0: until it is stopped.
  std::uint64_t ticks() const noexcept { return ticks_; }
  std::uint64_t seed() const noexcept { return seed_; }  ///< Of everything random.
  /// Returns what the user must know, a sentence each: what was put right, left out or guessed of
  /// the meshes, and what became of limits that the scene names, where the arm is real.
  const std::vector<std::string>& told() const noexcept { return told_; }
  /// Returns what is known of the arm's feel check.
  scene::FeelCheckState feel_check() const noexcept { return feel_check_; }
  /// Returns "sim" or the name of the arm on the desk.
  const std::string& device_name() const noexcept { return device_name_; }
  /// Returns the scene's file, absolute.
  std::string scene_path() const;
  /// Returns what this is, for recordings. Real-time: never from the servo thread.
  RecordingInfo recording_info() const;

 private:
  Setup() = default;
  driver::Result<void> read(const SessionOptions& options);
  driver::Result<void> simulate_arm();

  std::filesystem::path scene_file_;
  scene::Scene scene_;
  std::vector<std::string> told_;
  scene::FeelCheckState feel_check_ = scene::FeelCheckState::kSimulated;
  std::string device_name_;
  std::optional<driver::FoundArm> real_arm_;
  std::filesystem::path firmware_;
  std::optional<StartPose> start_pose_;
  decltype(SessionOptions::open_link) open_link_;
  bool real_time_ = false;
  bool endless_ = false;
  bool hand_by_mouse_ = false;
  bool homed_ = false;
  std::uint64_t seed_ = 0;
  std::uint64_t ticks_ = 0;
  std::int64_t period_ns_ = 0;
  std::unique_ptr<scene::SceneObjects> objects_;
  std::shared_ptr<driver::Clock> clock_;
  std::unique_ptr<scene::ArmSimulation> simulation_;
  std::unique_ptr<driver::Device> device_;  // holds the wire to the simulation, so it goes first
  std::unique_ptr<scene::HeatKeeper> heat_keeper_;  // of a real arm whose file names its heat
};

}  // namespace thimble::session
