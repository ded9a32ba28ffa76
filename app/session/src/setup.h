#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "heat_keeper.h"
#include "recording/run_choices.h"
#include "sleep_lock.h"
#include "speed_clock.h"
#include "start_pose.h"
#include "terminal.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/real_arm_terms.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/shared_meshes.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// What is run, before anything is built from it: a copy with another seed is another run of it.
struct RunPlan {
  std::filesystem::path scene_file;
  std::shared_ptr<scene::Scene> scene;  ///< Of sessions alike; changed only while it is read.
  std::vector<std::string> told;        ///< What the user must know, a sentence each.
  std::vector<std::string> quality_choices;
  RunChoices choices;
  std::filesystem::path firmware;
  bool real_time = false;
  bool paced = false;
  bool own_clock = false;  ///< The caller moves the clock on.
  bool endless = false;
  bool hand_by_mouse = false;
  bool hand_by_program = false;
  bool homed = false;
  driver::HoldToRun hold{};
  std::uint64_t seed = 0;
  std::uint64_t ticks = 0;
  std::int64_t period_ns = 0;
  Keep keep = Keep::kRun;
  std::shared_ptr<scene::SharedMeshes> meshes;
};

/// One arm of a run: what it is, and as its loop drives it.
struct ArmOfRun {
  std::optional<driver::FoundArm> real;  ///< The arm on the desk, if it is not simulated.
  OpenLink open_link;                    ///< To it, in place of its own; may be empty.
  /// Where its tip must be before it gets a force; of a real arm, and of those beside one.
  std::optional<StartPose> start_pose;
  scene::FeelCheckState feel_check = scene::FeelCheckState::kSimulated;
  std::optional<driver::EnergyStage> energy;  ///< That the scene names, if it is not the arm's.
  std::unique_ptr<scene::ArmSimulation> simulation;  ///< Null if it is real.
  std::unique_ptr<driver::Device> device;  ///< Holds the wire to the simulation, so it goes first.
  std::vector<std::string> inside_at_start;        ///< Names of the objects that its tip starts in.
  std::unique_ptr<scene::HeatKeeper> heat_keeper;  ///< Of a real arm whose file names its heat.
  std::unique_ptr<scene::SleepLock> awake;         ///< Of a real arm: the computer does not sleep.
};

/// What a session runs: a scene with its objects, and the arms that touch them, on one clock.
class THIMBLE_EXPORT Setup {
 public:
  /// Does what takes time and needs no arm: reads the scene, its arm and its meshes, plans the
  /// simulated hand's path and builds the objects. The error names the file and what to mend.
  /// Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Setup>> prepare(const std::filesystem::path& scene,
                                                        const SessionOptions& options);
  /// Does the same for another run of what `other` runs, by another seed: the scene as it was read
  /// there, its meshes, and the hands' paths are the same objects. Fails unless `other` is in
  /// virtual time on a clock of its own. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Setup>> prepare_like(const Setup& other,
                                                             std::uint64_t seed);
  /// Starts the clock and opens the arms: simulated ones alone may get forces from then on; where
  /// one is real all are idle. Once. Real-time: never from the servo thread.
  driver::Result<void> open_arm();
  /// Fails if the tip of a real arm is not where it must be before a force may come; a simulated
  /// arm's always is. Precondition: the arms are open. Real-time: never from the servo thread.
  driver::Result<void> check_start_pose() const;
  /// Lets forces through to all arms. Precondition: they are open. Real-time: never from the servo
  /// thread.
  driver::Result<void> activate();

  const scene::Scene& scene() const noexcept { return *plan_.scene; }
  scene::SceneObjects& objects() const noexcept { return *objects_; }
  /// Returns how many arms touch the scene.
  std::size_t arms() const noexcept { return plan_.scene->arms.size(); }
  /// Returns what the scene calls an arm, counted from 0; empty if it is the only one.
  const std::string& arm_name(std::size_t arm) const noexcept {
    return plan_.scene->arms[arm].name;
  }
  /// Returns an arm's file.
  const scene::ArmFile& arm_file(std::size_t arm) const noexcept {
    return plan_.scene->arms[arm].arm;
  }
  /// Returns the arm as the loop drives it. Precondition: the arm is open, as for `clock`.
  driver::Device& device(std::size_t arm = 0) const noexcept { return *arms_[arm].device; }
  driver::Clock& clock() const noexcept { return *clock_; }
  /// Returns whether simulated time passes at a pace that viewers choose.
  bool paced() const noexcept { return plan_.paced; }
  /// Returns the clock that has that pace; null if there is none. Precondition: the arm is open.
  SpeedClock* pace() const noexcept { return pace_; }
  /// Returns the simulation of the arm; null if the arm is real.
  scene::ArmSimulation* simulation(std::size_t arm = 0) const noexcept {
    return arms_[arm].simulation.get();
  }
  /// Returns where the tip of an arm must be before it gets a force. Precondition: an arm of the
  /// run is real.
  const StartPose& start_pose(std::size_t arm = 0) const noexcept { return *arms_[arm].start_pose; }
  /// Returns the arm on the desk, if it is not simulated.
  const std::optional<driver::FoundArm>& real_arm(std::size_t arm = 0) const noexcept {
    return arms_[arm].real;
  }
  /// Returns whether an arm of the run is real.
  bool any_real() const noexcept;
  /// Returns the firmware image for an arm that needs one; may be empty.
  const std::filesystem::path& firmware() const noexcept { return plan_.firmware; }

  /// Returns what is kept of the ticks.
  Keep keep() const noexcept { return plan_.keep; }
  /// Returns whether the run goes by the time of the world; threads load pages and write then.
  bool real_time() const noexcept { return plan_.real_time; }
  /// Returns whether a real arm's counters are known to be right: it was in its home pose when it
  /// got power.
  bool homed() const noexcept { return plan_.homed; }
  /// Returns what must be held for a force.
  const driver::HoldToRun& hold() const noexcept { return plan_.hold; }
  /// Returns whether it runs until it is stopped, faults or not.
  bool endless() const noexcept { return plan_.endless; }
  /// Returns whether a viewer leads the simulated hand.
  bool hand_by_mouse() const noexcept { return plan_.hand_by_mouse; }
  /// Returns whether somebody leads the simulated hand in place of the scene's path.
  bool hand_led() const noexcept { return plan_.hand_by_mouse || plan_.hand_by_program; }
  std::int64_t period_ns() const noexcept { return plan_.period_ns; }  ///< Between two ticks.
  /// Returns how many periods the run lasts; 0: until it is stopped.
  std::uint64_t ticks() const noexcept { return plan_.ticks; }
  std::uint64_t seed() const noexcept { return plan_.seed; }  ///< Of everything random.
  /// Returns what the user must know, a sentence each: what was put right, left out or guessed of
  /// the meshes, and what became of limits that the scene names, where the arm is real.
  const std::vector<std::string>& told() const noexcept { return plan_.told; }
  /// Returns the names of the objects that the tip of an arm starts in; of a real arm once it is
  /// activated.
  const std::vector<std::string>& inside_at_start(std::size_t arm = 0) const noexcept {
    return arms_[arm].inside_at_start;
  }
  /// Returns what the quality that was asked for has chosen for the scene, a sentence each.
  const std::vector<std::string>& quality_choices() const noexcept { return plan_.quality_choices; }
  /// Returns what is known of an arm's feel check.
  scene::FeelCheckState feel_check(std::size_t arm = 0) const noexcept {
    return arms_[arm].feel_check;
  }
  /// Returns "sim" or the name of the arm on the desk.
  std::string device_name(std::size_t arm = 0) const {
    return arms_[arm].real ? arms_[arm].real->name() : "sim";
  }
  /// Returns the scene's file, absolute.
  std::string scene_path() const;
  /// Returns what this is, for recordings. Real-time: never from the servo thread.
  RecordingInfo recording_info(std::size_t arm = 0) const;

 private:
  Setup() = default;
  driver::Result<void> read(const SessionOptions& options);
  driver::Result<void> check_several(const SessionOptions& options) const;
  driver::Result<void> use_real_arms(const SessionOptions& options);
  driver::Result<void> use_among_others(std::size_t arm, const RealArmUse& use);
  driver::Result<void> build_objects();
  driver::Result<void> simulate_arms();
  std::string find_start_inside(std::size_t arm, const Eigen::Vector3d& p_WT);
  driver::Result<void> open(std::size_t arm);

  RunPlan plan_;
  // What is built from it.
  std::unique_ptr<scene::SceneObjects> objects_;
  std::shared_ptr<driver::Clock> clock_;
  SpeedClock* pace_ = nullptr;  // the same, or null
  std::vector<ArmOfRun> arms_;
};

/// Returns a terminal whose lines name an arm, where a run has several.
Terminal terminal_of(const Setup& setup, std::size_t arm, Terminal terminal);

}  // namespace thimble::session
