#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/file_hashes.h"
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
#include "thimble/scene/arm_policy.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_builder.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/shared_meshes.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Plan of a run, before anything is built from it. A copy with another seed describes another run
/// of the same plan.
struct RunPlan {
  std::filesystem::path scene_file;
  /// Scene made in code instead of `scene_file`; null if there is a file.
  std::shared_ptr<const scene::SceneBuilder> built;
  /// Scene, shared by similar sessions; changed only while it is read.
  std::shared_ptr<scene::Scene> scene;
  std::shared_ptr<scene::FileHashes> inputs;  ///< Hashes of the scene's inputs.
  std::vector<std::string> warnings;          ///< Warnings to show the user, one sentence each.
  std::vector<std::string> quality_choices;
  RunChoices choices;
  std::filesystem::path firmware;
  bool real_time = false;
  bool paced = false;
  bool own_clock = false;  ///< True if the caller advances the clock.
  bool endless = false;
  bool hand_by_mouse = false;
  bool hand_by_program = false;
  bool buttons_allowed = false;
  bool homed = false;
  driver::HoldToRun hold{};
  std::uint64_t seed = 0;
  std::uint64_t ticks = 0;
  std::int64_t period_ns = 0;
  Keep keep = Keep::kRun;
  std::shared_ptr<scene::SharedMeshes> meshes;
};

/// One arm of a run, with the device through which its loop drives it.
struct ArmOfRun {
  std::optional<driver::FoundArm> real;  ///< Real arm; empty if it is simulated.
  /// Link factory to use instead of `scene::open_link`; may be empty.
  OpenLink open_link;
  /// Required start pose of the tip; set for all arms of a run with a real one.
  std::optional<StartPose> start_pose;
  scene::FeelCheckState feel_check = scene::FeelCheckState::kSimulated;
  /// Energy stage of the scene, if it differs from the arm's.
  std::optional<driver::EnergyStage> energy;
  std::unique_ptr<scene::ArmSimulation> simulation;  ///< Simulation; null if the arm is real.
  /// Device; destroyed before the simulation, because it holds the wire to it.
  std::unique_ptr<driver::Device> device;
  /// Names of the objects in which the tip starts.
  std::vector<std::string> inside_at_start;
  /// Stored motor heat of a real arm whose file has thermal limits.
  std::unique_ptr<scene::HeatKeeper> heat_keeper;
  /// Prevents a suspend of the computer while a real arm is open.
  std::unique_ptr<scene::SleepLock> awake;
};

/// Configuration of a session: a scene with its objects, and the arms that touch them, on one
/// clock.
class THIMBLE_EXPORT Setup {
 public:
  /// Performs the slow, arm-independent part: reads the scene, its arm files and its meshes, plans
  /// the simulated hand's path and builds the objects. The error names the file and the fix.
  /// Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Setup>> prepare(const std::filesystem::path& scene,
                                                        const SessionOptions& options);
  /// Does the same for a scene made in code.
  static driver::Result<std::unique_ptr<Setup>> prepare(const scene::SceneBuilder& scene,
                                                        const SessionOptions& options);
  /// Does the same for another run of `other` with a new seed. The scene as read before, its meshes
  /// and the hands' paths are shared. Fails if an arm of `other` is real or it uses the caller's
  /// clock. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Setup>> prepare_like(const Setup& other,
                                                             std::uint64_t seed);
  /// Starts the clock and opens the arms. Simulated arms are then active, unless an arm of the run
  /// is real; then all are idle. Call once. Real-time: never from the servo thread.
  driver::Result<void> open_arm();
  /// Fails if the tip of a real arm is not at its start pose; that of a simulated arm always is.
  /// Precondition: the arms are open. Real-time: never from the servo thread.
  driver::Result<void> check_start_pose() const;
  /// Enables forces on all arms. Precondition: they are open. Real-time: never from the servo
  /// thread.
  driver::Result<void> activate();

  const scene::Scene& scene() const noexcept { return *plan_.scene; }
  scene::SceneObjects& objects() const noexcept { return *objects_; }
  /// Returns the number of arms in the scene.
  std::size_t arms() const noexcept { return plan_.scene->arms.size(); }
  /// Returns the name of an arm in the scene, numbered from 0; empty if it is the only one.
  const std::string& arm_name(std::size_t arm) const noexcept {
    return plan_.scene->arms[arm].name;
  }
  /// Returns the contents of an arm's file.
  const scene::ArmFile& arm_file(std::size_t arm) const noexcept {
    return plan_.scene->arms[arm].arm;
  }
  /// Returns the device of an arm. Precondition: the arm is open; also for `clock`.
  driver::Device& device(std::size_t arm = 0) const noexcept { return *arms_[arm].device; }
  driver::Clock& clock() const noexcept { return *clock_; }
  /// Returns whether viewers control the pace of simulated time.
  bool paced() const noexcept { return plan_.paced; }
  /// Returns the clock with that pace; null if there is none. Precondition: the arm is open.
  SpeedClock* pace() const noexcept { return pace_; }
  /// Returns the simulation of the arm; null if the arm is real.
  scene::ArmSimulation* simulation(std::size_t arm = 0) const noexcept {
    return arms_[arm].simulation.get();
  }
  /// Returns the start pose of an arm. Precondition: an arm of the run is real.
  const StartPose& start_pose(std::size_t arm = 0) const noexcept { return *arms_[arm].start_pose; }
  /// Returns the real arm; empty if the arm is simulated.
  const std::optional<driver::FoundArm>& real_arm(std::size_t arm = 0) const noexcept {
    return arms_[arm].real;
  }
  /// Returns whether an arm of the run is real.
  bool any_real() const noexcept;
  /// Returns the firmware image for an arm that needs one; may be empty.
  const std::filesystem::path& firmware() const noexcept { return plan_.firmware; }

  /// Returns the data kept of the ticks.
  Keep keep() const noexcept { return plan_.keep; }
  /// Returns whether the run uses wall-clock time; then threads load disk pages and write files.
  bool real_time() const noexcept { return plan_.real_time; }
  /// Returns whether the counters of a real arm are known to be correct, because it was in its home
  /// pose at power-on.
  bool homed() const noexcept { return plan_.homed; }
  /// Returns the enabling inputs.
  const driver::HoldToRun& hold() const noexcept { return plan_.hold; }
  /// Returns whether the run continues until it is stopped, even after a fault.
  bool endless() const noexcept { return plan_.endless; }
  /// Returns whether viewers or a program may hold buttons of simulated arms.
  bool buttons_allowed() const noexcept { return plan_.buttons_allowed; }
  /// Returns whether a viewer moves the simulated hand.
  bool hand_by_mouse() const noexcept { return plan_.hand_by_mouse; }
  /// Returns whether a viewer or a program moves the simulated hand instead of the scene's path.
  bool hand_led() const noexcept { return plan_.hand_by_mouse || plan_.hand_by_program; }
  /// Returns the period of the loop, ns.
  std::int64_t period_ns() const noexcept { return plan_.period_ns; }
  /// Returns the number of periods of the run; 0: until it is stopped.
  std::uint64_t ticks() const noexcept { return plan_.ticks; }
  /// Returns the seed of all random numbers.
  std::uint64_t seed() const noexcept { return plan_.seed; }
  /// Returns warnings to show the user: mesh repairs, omissions and assumptions. For a real arm
  /// also how the limits named in the scene were applied.
  const std::vector<std::string>& warnings() const noexcept { return plan_.warnings; }
  /// Returns the names of the objects in which the tip of an arm starts; for a real arm once it is
  /// activated.
  const std::vector<std::string>& inside_at_start(std::size_t arm = 0) const noexcept {
    return arms_[arm].inside_at_start;
  }
  /// Returns the choices of the requested quality for the scene, one sentence each.
  const std::vector<std::string>& quality_choices() const noexcept { return plan_.quality_choices; }
  /// Returns the state of an arm's feel check.
  scene::FeelCheckState feel_check(std::size_t arm = 0) const noexcept {
    return arms_[arm].feel_check;
  }
  /// Returns "sim" or the name of the real arm.
  std::string device_name(std::size_t arm = 0) const {
    return arms_[arm].real ? arms_[arm].real->name() : "sim";
  }
  /// Returns the absolute path of the scene file.
  std::string scene_path() const;
  /// Returns the description of the run for recordings. Real-time: never from the servo thread.
  RecordingInfo recording_info(std::size_t arm = 0) const;

 private:
  Setup() = default;
  static driver::Result<std::unique_ptr<Setup>> prepare(std::unique_ptr<Setup> setup,
                                                        const SessionOptions& options);
  driver::Result<void> read(const SessionOptions& options);
  driver::Result<void> check_several(const SessionOptions& options) const;
  driver::Result<void> use_real_arms(const SessionOptions& options);
  driver::Result<void> use_real_arm(std::size_t arm, const RealArmUse& use);
  driver::Result<void> build_objects();
  driver::Result<void> simulate_arms();
  std::string find_start_inside(std::size_t arm, const Eigen::Vector3d& p_WT);
  driver::Result<void> open(std::size_t arm);

  RunPlan plan_;
  // Built from the plan.
  std::unique_ptr<scene::SceneObjects> objects_;
  std::shared_ptr<driver::Clock> clock_;
  SpeedClock* pace_ = nullptr;  // The same clock, or null.
  std::vector<ArmOfRun> arms_;
};

/// Returns a terminal whose lines name the arm if a run has several.
Terminal terminal_of(const Setup& setup, std::size_t arm, Terminal terminal);

}  // namespace thimble::session
