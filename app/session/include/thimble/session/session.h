#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/result.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/snapshot.h"
#include "thimble/driver/tick_record.h"
#include "thimble/driver/transport.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/arm_policy.h"
#include "thimble/scene/hand_route.h"
#include "thimble/session/recording.h"
#include "thimble/session/run_figures.h"
#include "thimble/session/tick_observer.h"

namespace thimble::render {
class SceneTouch;
}
namespace thimble::scene {
class ArmSimulation;
class SceneBuilder;
class SharedMeshes;
struct Scene;
}  // namespace thimble::scene

namespace thimble::session {

class Setup;
class SharedRun;
struct RunRecords;

/// Clock of a session.
enum class ClockKind {
  kVirtual,  ///< Virtual time: as fast as possible, with bit-identical results.
  kWall,     ///< Real time; required for a real arm.
  kPaced,    ///< Bit-identical to kVirtual, at the pace of real time or a fraction of it.
};

/// Amount of tick data that a session keeps.
enum class Keep {
  kRun,  ///< All ticks, their statistics, and the seconds before a fault.
  /// Only the newest tick, for many parallel sessions. Saves about 3 MB per session and 0.3 MB per
  /// second. Cannot be combined with viewers.
  kNewest,
};

/// Link factory that replaces `scene::open_link` in tests.
using OpenLink = std::function<driver::Result<std::unique_ptr<driver::ArmLink>>(
    const scene::ArmFile&, driver::Clock&)>;

/// Real arm to use instead of one of the simulated arms of a scene.
struct RealArmUse {
  driver::FoundArm arm;     ///< Board of the arm.
  scene::ArmPolicy terms;   ///< Terms of use: arm file, force limit, state of the feel check.
  OpenLink open_link = {};  ///< Link factory to use instead of `scene::open_link`, if set.
};

/// Options of a session, in addition to the scene.
struct SessionOptions {
  ClockKind clock = ClockKind::kVirtual;  ///< Clock of the session.
  /// Clock to use instead of the built-in virtual clock, for example one driven by another program.
  /// With a real arm it requires `open_link`.
  std::shared_ptr<driver::Clock> own_clock = {};
  std::optional<double> duration = {};  ///< Duration, s; if empty, that of the scene.
  /// Seed of all random numbers; if empty, that of the scene.
  std::optional<std::uint64_t> seed = {};
  /// Folder of `cgal:` meshes; if empty, see SceneReading.
  std::filesystem::path mesh_folder = {};
  std::filesystem::path arm_file = {};            ///< Arm file or name; replaces that of the scene.
  std::optional<driver::FoundArm> real_arm = {};  ///< Real arm to use instead of the simulated one.
  /// Terms of use for `real_arm`; required if it is set.
  std::optional<scene::ArmPolicy> terms = {};
  /// Real arms of a scene with several arms, by name in the scene. Arms without an entry or without
  /// a value are simulated.
  std::map<std::string, std::optional<RealArmUse>> real_arms = {};
  /// Firmware file for a real arm that requires one (Falcon).
  std::filesystem::path firmware = {};
  std::filesystem::path record = {};  ///< File of the recording; empty: none.
  bool overwrite = false;             ///< Allows `record` to replace an existing recording.
  bool share = false;                 ///< Makes the run visible to a viewer in this process.
  bool share_if_possible = false;  ///< Continues without viewers if shared memory is unavailable.
  bool share_out = false;          ///< Makes the run visible to viewers in other processes.
  /// Lets a viewer move the simulated hand and end the run.
  bool hand_by_mouse = false;
  /// Lets a program move the simulated hand (Session::lead_hand). The hand waits at the start of
  /// the scene's path, and the run has no duration.
  bool hand_by_program = false;
  /// Lets a program hold buttons of the simulated arm (Session::hold_buttons).
  bool buttons_by_program = false;
  /// Buttons that the simulated hand of the first arm holds over time, in order of time.
  std::vector<scene::ButtonStep> buttons = {};
  /// True if the caller restarts the run when a viewer requests it. Never applies to real arms.
  bool restarts = false;
  /// Name of the shared run. If it is empty, the name is that of the scene, with a number appended
  /// if that name is taken.
  std::string share_name = {};
  /// Factor on the loop rate of the scene (scene::SceneReading). Cannot be used with a real arm,
  /// whose rate is fixed.
  double rate_factor = 1;
  /// Accuracy/performance preset (scene::kQualityNames).
  std::string quality = "normal";
  std::optional<double> budget = {};  ///< Time per tick that `quality` "auto" may use, ns.
  /// Modifies the scene before anything is built from it. A recording does not contain this change;
  /// it notes that there was one.
  std::function<void(scene::Scene&)> adjust = {};
  /// Meshes shared with other sessions (scene/shared_meshes.h); if null, not shared.
  std::shared_ptr<scene::SharedMeshes> meshes = {};
  /// Folder of the mesh cache (scene::MeshCacheChoice), if `meshes` is null. Empty: the one that
  /// the environment names (THIMBLE_MESH_CACHE), or none.
  std::filesystem::path mesh_cache = {};
  Keep keep = Keep::kRun;  ///< Data kept of the ticks.
  bool log = false;        ///< Logs the events of the run.
  /// True if the real arm was in its home pose at power-on. Then it need not be moved there.
  bool homed = false;
  /// Continues the run until it is stopped. The simulated hand stays at the end of its path, and
  /// the loop continues with zero force after a fault. Cannot be combined with `duration`.
  bool endless = false;
  /// True if the caller handles scenes with several arms (Session::arms). If false, such a scene is
  /// an error.
  bool several_arms = false;
  /// True if the caller changes the settings of a scene with one arm (Session::turn_knob). Cannot
  /// be combined with viewers, which change settings themselves.
  bool knobs = false;
  OpenLink open_link = {};      ///< Link factory for `real_arm`, if set.
  driver::HoldToRun hold = {};  ///< Enabling inputs that each arm needs for a force.
};

/// Numeric setting of a scene's object that can be changed during a run.
struct Knob {
  std::string name;         ///< Name, such as "OBJECT: stiffness".
  std::string unit;         ///< SI unit.
  double min = 0, max = 0;  ///< Smallest and largest value.
  double value = 0;         ///< Current value.
};

/// Stop flag that is never set.
inline const std::atomic<bool> kNeverStopped{false};

/// One run of a scene: its configuration, the servo loop, and the observers of its ticks. The servo
/// runs on the thread that calls `run` or `step`. Meanwhile another thread may read `newest`.
/// Unless its comment says otherwise, any other function must be called before or after the run, or
/// between two steps.
class THIMBLE_EXPORT Session {
 public:
  /// Loads a scene and opens its arm, ready to run. `scene` is a file or a name
  /// (scene::find_scene). Non-interactive: fails if a real arm is not at its start pose. The error
  /// names the file and the fix. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Session>> open(const std::filesystem::path& scene,
                                                       const SessionOptions& options = {});

  /// Does the same for a scene made in code (scene/scene_builder.h), whose values are copied. A
  /// recording contains the text of the scene; to replay it, save the scene and pass its file.
  /// Fails with viewers (`share`, `share_out`), which read the scene's file: save the scene and
  /// open the file. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Session>> open(const scene::SceneBuilder& scene,
                                                       const SessionOptions& options = {});

  /// Opens a session with the scene, meshes, hand paths and options of `other` and a new seed.
  /// Viewers and recording are not copied. If the files have not changed, results are bit-identical
  /// to those of `open`, which is slower. Fails unless `other` uses virtual time and the built-in
  /// clock. `other` may have run, or may be running on another thread. Real-time: never from the
  /// servo thread.
  static driver::Result<std::unique_ptr<Session>> open_like(const Session& other,
                                                            std::uint64_t seed);

  /// As `open_like`, but does not open the arms (`open_arm`). Fails if an arm of `other` is real or
  /// the caller advances its clock. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Session>> prepare_like(const Session& other,
                                                               std::uint64_t seed);

  /// Performs the slow, arm-independent part of `open`: reads the files, plans the hand's path,
  /// builds the objects, starts the recording and makes the run visible to viewers. Real-time:
  /// never from the servo thread.
  static driver::Result<std::unique_ptr<Session>> prepare(const std::filesystem::path& scene,
                                                          const SessionOptions& options = {});
  /// Does the same for a scene made in code, as `open` does.
  static driver::Result<std::unique_ptr<Session>> prepare(const scene::SceneBuilder& scene,
                                                          const SessionOptions& options = {});
  /// Opens the arm of a prepared session. Simulated arms are then active. If any arm of the run is
  /// real, all arms are idle, with zero force, until `activate`. Call once. Real-time: never from
  /// the servo thread.
  driver::Result<void> open_arm();
  /// Enables forces on the open arm. If the arm is real, the caller must first have checked that
  /// its tip is at the start pose. Real-time: never from the servo thread.
  driver::Result<void> activate();

  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Replaces the force law of the scene for the whole run. The law may call `touch` for the
  /// scene's force; its own force passes through the same gate. It must outlive the run. Fails if a
  /// tick has run or the scene has several arms. Also fails if the run uses wall-clock time:
  /// external code is not real-time safe, so it is refused on real arms. Real-time: never from the
  /// servo thread.
  driver::Result<void> set_law(driver::ForceLaw law);
  /// Replaces the force law of the scene as `set_law` does, but also in real time. The law must be
  /// real-time safe: it neither waits nor allocates, and its duration is bounded. It may call
  /// `own_law`. Fails if a tick has run or the scene has several arms. Real-time: never from the
  /// servo thread.
  driver::Result<void> set_servo_law(driver::ForceLaw law);
  /// Returns the default law of the session: that of the scene, with the changes that viewers or
  /// `turn_knob` have made. Real-time: safe.
  driver::ForceLaw own_law() noexcept;
  /// Adds an observer of every tick of an arm. Observers are called in the order in which they were
  /// added. The observer must outlive the run. Fails once a tick has run. Real-time: never from the
  /// servo thread.
  driver::Result<void> add_observer(TickObserver& observer, std::size_t arm = 0);

  /// Runs the servo loop until the scene's duration is over or `stop` is set. With a simulated arm
  /// a fault also ends the run. With a real arm the loop continues after a fault with zero force,
  /// so that the arm can recover. The run always ends with zero force. Precondition: the arm is
  /// open. Real-time: safe; it runs on the servo thread.
  driver::ServoEnd run(const std::atomic<bool>& stop = kNeverStopped) noexcept;
  /// Runs one tick. Returns the end reason once the run is over; `run` calls this until then. Every
  /// call must pass the same `stop`. With several arms, runs the tick of each arm in turn, then
  /// steps the bodies that they touch. Real-time: safe.
  std::optional<driver::ServoEnd> step(const std::atomic<bool>& stop = kNeverStopped) noexcept;
  /// Moves the target of the simulated hand to a point (W, m); replaces the scene's path. A point
  /// outside the workspace is projected onto its box. Returns false if the arm cannot reach the
  /// point (ArmSimulation::lead). Precondition: the arm is simulated. Call between two ticks.
  /// Real-time: safe.
  bool lead_hand(const Eigen::Vector3d& p_WH) noexcept;
  /// Holds buttons of the first arm, if it is simulated, until the next call (one bit each; bit 0
  /// is the first button; 0 releases them). Returns false, and does nothing, if the arm is real
  /// or `buttons_by_program` is not set.
  /// Call like `lead_hand`. Real-time: safe.
  bool hold_buttons(std::uint16_t buttons) noexcept;

  /// Returns the settings that can be changed, with current values. Empty with several arms, or if
  /// SessionOptions::knobs was not set. Any thread. Real-time: never from the servo thread.
  std::vector<Knob> knobs() const;
  /// Changes a setting from the next tick on, without a sudden change of force. A change over the
  /// whole range takes at least 50 ms. The error lists the available settings, or the bounds that
  /// the value violates. Any thread. Real-time: never from the servo thread.
  driver::Result<void> turn_knob(const std::string& name, double value);

  /// Returns the scene as read from its file and adjusted (scene/scene_file.h).
  const scene::Scene& scene() const noexcept;
  /// Returns the scene's force law, with its objects (render/scene_touch.h).
  render::SceneTouch& touch() noexcept;
  const render::SceneTouch& touch() const noexcept;  ///< Const overload.
  /// Returns the number of arms in the scene. The functions below number arms from 0.
  std::size_t arms() const noexcept;
  /// Returns the name of an arm in the scene; empty if it is the only one.
  const std::string& arm_name(std::size_t arm) const noexcept;
  /// Returns the device through which the loop drives an arm. Precondition: the arm is open.
  driver::Device& device(std::size_t arm = 0) noexcept;
  const driver::Device& device(std::size_t arm = 0) const noexcept;  ///< Const overload.
  /// Returns the simulation of an arm (scene/arm_simulation.h); null if the arm is real.
  scene::ArmSimulation* simulation(std::size_t arm = 0) noexcept;
  const scene::ArmSimulation* simulation(std::size_t arm = 0) const noexcept;  ///< Const overload.
  /// Returns whether the run uses wall-clock time.
  bool real_time() const noexcept;
  /// Returns warnings to show the user: mesh repairs, omissions and assumptions. For a real arm,
  /// they also state which limits of the scene were kept or ignored.
  const std::vector<std::string>& warnings() const noexcept;
  /// Former name of `warnings`.
  [[deprecated("renamed to warnings")]] const std::vector<std::string>& told() const noexcept {
    return warnings();
  }

  /// Returns the newest tick. Any thread may load it.
  const driver::Snapshot<driver::TickRecord>& newest(std::size_t arm = 0) const noexcept;
  /// Returns every `stride`-th tick of the run, oldest first; empty if ticks are not kept. Do not
  /// call while the servo runs.
  std::span<const driver::TickRecord> ticks(std::size_t arm = 0) const noexcept;
  /// Returns the interval n of the ticks that are kept: every n-th. It is 1 up to a million ticks.
  std::uint64_t stride() const noexcept;
  /// Returns how often gravity compensation was switched off because the tip moved in the direction
  /// of its force. Wrong compensation or a hand causes that. Any thread.
  std::uint64_t carry_withdrawn(std::size_t arm = 0) const noexcept;
  /// Returns the statistics of the ticks; empty if ticks are not kept. Do not call while the servo
  /// runs.
  const RunStatistics& statistics() const noexcept;
  /// Returns the figures of a run that is over or stopped, and searches its ticks for lost
  /// contacts. `grant` contains the real-time properties granted to the servo thread. Real-time:
  /// never from the servo thread.
  RunFigures figures(const driver::RealTimeGrant& grant = {}, std::size_t arm = 0) const;
  /// Returns the number of the object with the given name; empty if the scene has none.
  std::optional<int> find_object(const std::string& name) const;
  /// Returns the mesh of one object in its current pose and shape (W, m). If `object` is negative,
  /// returns all objects as one mesh. Do not call while the servo runs. Real-time: never from the
  /// servo thread.
  render::TriangleMesh mesh_now(int object = -1) const;
  /// Returns all objects as one mesh, with the deepest dent of the run (W, m); empty if nothing was
  /// dented. Do not call while the servo runs. Real-time: never from the servo thread.
  std::optional<render::TriangleMesh> deepest_dent() const;

  /// Starts a recording of every tick from now on; ends the previous one. A scene with several arms
  /// has one file per arm (file_of_arm). If `overwrite` is false, an existing recording of the same
  /// name is an error. A file of another kind is always an error. Call from one thread only; the
  /// servo may run meanwhile. Real-time: never from the servo thread.
  driver::Result<void> begin_recording(const std::filesystem::path& path, bool overwrite = false);
  /// Ends the recording and returns its file; empty if there was no recording. With several arms,
  /// returns the file of the first arm. The error lists the missing ticks and the cause. The rule
  /// about threads is that of `begin_recording`. Real-time: never from the servo thread.
  driver::Result<std::optional<std::filesystem::path>> end_recording();
  /// Writes the seconds around a fault into the user's state folder and returns the file; empty if
  /// there was no fault. With several arms, returns the first file. Call after the run. Real-time:
  /// never from the servo thread.
  driver::Result<std::optional<std::filesystem::path>> keep_black_box();
  /// Writes the seconds around the faults of all arms and returns the files. If `run_is_over` is
  /// false, skips each arm whose black box still receives ticks. Real-time: never from the servo
  /// thread.
  driver::Result<std::vector<std::filesystem::path>> keep_black_boxes(bool run_is_over);
  /// Returns the description of this session for recordings of an arm. Real-time: never from the
  /// servo thread.
  RecordingInfo recording_info(std::size_t arm = 0) const;

  /// Returns the trackers of the objects that are meshes in memory; none under a tip with a radius.
  std::vector<RunFigures::Tracker> trackers() const;

  // Access for Thimble's own code (app/session/src).

  /// Returns the configuration of the run.
  Setup& setup() noexcept;
  const Setup& setup() const noexcept;  ///< Const overload.
  /// Returns the observers that belong to the session.
  RunRecords& records() noexcept;
  const RunRecords& records() const noexcept;     ///< Const overload.
  RunRecords& records(std::size_t arm) noexcept;  ///< Returns the observers of the given arm.
  /// Appends the memory that the first arm uses in each tick and that belongs to this run alone, so
  /// that a caller with many runs can prefetch it. Precondition: the arm is open. Real-time: never
  /// from the servo thread.
  void list_memory(std::vector<std::span<const std::byte>>& memory) const;
  /// Returns the shared state that viewers read; null if the run is not shared.
  SharedRun* shared() noexcept;
  /// Makes a run visible to viewers, as requested by `options`, if it was prepared without viewers.
  /// If `before` (a run that is over) is not null, takes over its name. Call before the first tick.
  /// The errors are those of `prepare`. Real-time: never from the servo thread.
  driver::Result<void> share(const SessionOptions& options, SharedRun* before = nullptr);

 private:
  struct Parts;

  Session();
  static driver::Result<std::unique_ptr<Session>> from_setup(
      driver::Result<std::unique_ptr<Setup>> setup, const SessionOptions& options);
  static driver::Result<std::unique_ptr<Session>> open_prepared(
      driver::Result<std::unique_ptr<Session>> session);

  std::unique_ptr<Parts> parts_;
};

}  // namespace thimble::session
