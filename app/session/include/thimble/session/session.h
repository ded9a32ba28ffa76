#pragma once

#include <Eigen/Core>
#include <atomic>
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
#include "thimble/scene/real_arm_terms.h"
#include "thimble/session/recording.h"
#include "thimble/session/run_figures.h"
#include "thimble/session/tick_observer.h"

namespace thimble::render {
class SceneTouch;
}
namespace thimble::scene {
class ArmSimulation;
class SharedMeshes;
struct Scene;
}  // namespace thimble::scene

namespace thimble::session {

class Setup;
class SharedRun;
struct RunRecords;

/// The time that a session runs on.
enum class ClockKind {
  kVirtual,  ///< As fast as it computes, and repeatable to the bit.
  kWall,     ///< In real time; a real arm always is.
  kPaced,    ///< The ticks of kVirtual to the bit, at the pace of real time or a part of it.
};

/// What a session keeps of its ticks.
enum class Keep {
  kRun,     ///< The ticks, their statistics, and the seconds before a fault.
  kNewest,  ///< The newest tick alone, for many sessions side by side: some 3 MB less for each, and
            ///< 0.3 MB less per second. Not with viewers.
};

/// Opens the link to a real arm in place of `scene::open_link`, for tests.
using OpenLink = std::function<driver::Result<std::unique_ptr<driver::ArmLink>>(
    const scene::ArmFile&, driver::Clock&)>;

/// A real arm in place of one of a scene's several.
struct RealArmUse {
  driver::FoundArm arm;       ///< Which board it is.
  scene::RealArmTerms terms;  ///< On which it may be used.
  OpenLink open_link = {};    ///< In place of its own wire; empty: as it is.
};

/// What the user asks for beyond the scene.
struct SessionOptions {
  ClockKind clock = ClockKind::kVirtual;  ///< which time it runs on
  /// Moves on the time of a virtual run in place of its own clock, which never waits: for runs that
  /// go on only when somebody else has done his part. With a real arm only where `open_link` stands
  /// in for its wire.
  std::shared_ptr<driver::Clock> own_clock = {};
  std::optional<double> duration = {};     ///< s; the scene's own if empty
  std::optional<std::uint64_t> seed = {};  ///< of everything random; the scene's own if empty
  std::filesystem::path mesh_folder = {};  ///< of `cgal:` meshes; empty: as SceneReading
  std::filesystem::path arm_file = {};     ///< file or name, in place of the scene's own
  std::optional<driver::FoundArm> real_arm = {};  ///< in place of the simulated one
  std::optional<scene::RealArmTerms> terms = {};  ///< on which it may be used; needed with one
  /// Of a scene with several arms: which of them are real, by their names; one without a value, or
  /// that is not named, is simulated.
  std::map<std::string, std::optional<RealArmUse>> real_arms = {};
  std::filesystem::path firmware = {};  ///< for a real arm that needs some (Falcon)
  std::filesystem::path record = {};    ///< where every tick is written; empty: nowhere
  bool overwrite = false;               ///< `record` may replace an existing recording
  bool share = false;                   ///< lets a viewer in this process see the run
  bool share_if_possible = false;       ///< goes on unseen where there is no shared memory
  bool share_out = false;               ///< lets viewers of other processes see it
  /// A viewer leads the simulated hand; the run ends when it is asked to.
  bool hand_by_mouse = false;
  /// A program leads the simulated hand (Session::lead_hand): it waits where the scene's path
  /// begins, and the run has no end of its own.
  bool hand_by_program = false;
  /// Whoever runs it begins it anew when a viewer asks; a run with a real arm is never.
  bool restarts = false;
  std::string share_name = {};  ///< under which; empty: the scene's, with a number if it is taken
  double rate_factor = 1;  ///< of the loop, over the scene's (scene::SceneReading); not with a real
                           ///< arm, which has its own
  /// How much of what cannot be felt the run spends time on (scene::kQualityNames).
  std::string quality = "normal";
  std::optional<double> budget = {};  ///< ns per tick that `quality` "auto" may spend
  /// Changes the scene before anything is built of it. A recording cannot hold it, and says so.
  std::function<void(scene::Scene&)> adjust = {};
  /// Meshes that this session shares with others (scene/shared_meshes.h); its own if null.
  std::shared_ptr<scene::SharedMeshes> meshes = {};
  Keep keep = Keep::kRun;  ///< what is kept of the ticks
  bool log = false;        ///< what happens in the run goes into the log
  bool homed = false;      ///< a real arm was in its home pose when it got power: do not ask for it
  /// Runs until it is stopped: the simulated hand stays where its path ends, and faults leave the
  /// loop going with zero force. Not with a duration.
  bool endless = false;
  /// The caller looks at every arm (Session::arms). For others a scene with several is an error.
  bool several_arms = false;
  /// Who holds the session turns the knobs of a scene with one arm (Session::turn_knob). Not with
  /// viewers, who turn them themselves.
  bool knobs = false;
  OpenLink open_link = {};      ///< of `real_arm`
  driver::HoldToRun hold = {};  ///< what must be held at each arm so that it gets a force
};

/// A setting of a scene's objects that can be turned while it is felt.
struct Knob {
  std::string name;            ///< "OBJECT: stiffness"
  std::string unit;            ///< SI
  double least = 0, most = 0;  ///< Its bounds.
  double value = 0;            ///< What it is now.
};

/// The stop flag of a run that nobody stops.
inline const std::atomic<bool> kNeverStopped{false};

/// One run of a scene: what is run, the loop over it, and the observers of its ticks. The servo
/// runs on the thread that calls `run` or `step`; another thread may read `newest` meanwhile, all
/// else before or after the run, or between two steps.
class THIMBLE_EXPORT Session {
 public:
  /// Loads a scene and opens its arm, ready to run. `scene`: file or name (scene::find_scene). For
  /// callers that can ask nobody: a real arm whose tip is not where it must be is an error. The
  /// error names the file and what to mend. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Session>> open(const std::filesystem::path& scene,
                                                       const SessionOptions& options = {});

  /// Opens another session of what `other` runs, by another seed, with the options of that one but
  /// for viewers and a recording: the scene as it was read and adjusted there, its meshes and the
  /// hands' paths are shared. To the bit what `open` would make of files that have not changed, and
  /// quicker. Fails unless `other` is in virtual time on a clock of its own; it may have run, or be
  /// running on another thread. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Session>> open_like(const Session& other,
                                                            std::uint64_t seed);

  /// Does of `open` what takes time and needs no arm: reads the files, plans the hand's path,
  /// builds the objects, begins the recording and lets viewers see the run. Real-time: never from
  /// the servo thread.
  static driver::Result<std::unique_ptr<Session>> prepare(const std::filesystem::path& scene,
                                                          const SessionOptions& options = {});
  /// Opens the arm of a prepared session. A simulated one may get forces from then on; a real one
  /// is idle, with zero force, until `activate`. Once. Real-time: never from the servo thread.
  driver::Result<void> open_arm();
  /// Lets forces through to the arm that was opened. Of a real arm the caller has looked before
  /// whether its tip is where it must be (`wait_for_start_pose`). Real-time: never from the servo
  /// thread.
  driver::Result<void> activate();

  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Puts a force law in place of the scene's, for the whole run; it may ask `touch` for the
  /// scene's force, and goes through the same gate. It must outlive the run. Fails unless time
  /// is virtual and no tick has run: a law from outside of this program may take its time, which on
  /// a real arm nobody has. Real-time: never from the servo thread.
  driver::Result<void> set_law(driver::ForceLaw law);
  /// Puts a law in place of the scene's that is safe on the servo's thread, in whatever time: it
  /// neither waits nor allocates, and ends in a time of its own. It may ask `own_law`. Else as
  /// `set_law`. Real-time: never from the servo thread.
  driver::Result<void> set_servo_law(driver::ForceLaw law);
  /// Returns the law that a session runs unless it is given another: the scene's, as viewers or
  /// knobs have changed it. Real-time: safe.
  driver::ForceLaw own_law() noexcept;
  /// Adds an observer of every tick, after those that were added before; it must outlive the
  /// run. Fails once a tick has run. Real-time: never from the servo thread.
  driver::Result<void> add_observer(TickObserver& observer, std::size_t arm = 0);

  /// Runs the servo loop until the scene's time is over, `stop` is set, or, with the simulated arm,
  /// a fault; with a real arm the loop outlives faults with zero force, so that the arm can come
  /// back. In every case the arm is left with zero force. Precondition: the arm is open. Real-time:
  /// safe; it is the servo's thread.
  driver::ServoEnd run(const std::atomic<bool>& stop = kNeverStopped) noexcept;
  /// Runs the next tick alone; `run` is nothing but all of them. Returns why there is none any
  /// more, once the run is over. Always with the same `stop`. With several arms it is the tick of
  /// each in turn, and then the step of the bodies that they touch. Real-time: safe.
  std::optional<driver::ServoEnd> step(const std::atomic<bool>& stop = kNeverStopped) noexcept;
  /// Leads the simulated hand to a point (W, m) from now on, in place of the scene's path; returns
  /// false if the arm does not reach it (ArmSimulation::lead). Precondition: the arm is simulated.
  /// Between two ticks. Real-time: safe.
  bool lead_hand(const Eigen::Vector3d& p_WH) noexcept;

  /// Returns the knobs as they are now; none unless SessionOptions::knobs asked for them, and with
  /// several arms. Any thread. Real-time: never from the servo thread.
  std::vector<Knob> knobs() const;
  /// Turns a knob: it is on its way from the next tick on, without a step of force (50 ms from end
  /// to end at the quickest). The error names the knobs that there are, or the bounds that the
  /// value misses. Any thread. Real-time: never from the servo thread.
  driver::Result<void> turn_knob(const std::string& name, double value);

  /// Returns the scene as it was read and adjusted (scene/scene_file.h).
  const scene::Scene& scene() const noexcept;
  /// Returns the scene's force law, with its objects (render/scene_touch.h).
  render::SceneTouch& touch() noexcept;
  const render::SceneTouch& touch() const noexcept;  ///< As above.
  /// Returns how many arms touch the scene; each is named by its number from 0 in what follows.
  std::size_t arms() const noexcept;
  /// Returns what the scene calls an arm; empty if it is the only one.
  const std::string& arm_name(std::size_t arm) const noexcept;
  /// Returns the arm as the loop drives it. Precondition: the arm is open.
  driver::Device& device(std::size_t arm = 0) noexcept;
  const driver::Device& device(std::size_t arm = 0) const noexcept;  ///< As above.
  /// Returns the simulation of the arm (scene/arm_simulation.h); null if the arm is real.
  scene::ArmSimulation* simulation(std::size_t arm = 0) noexcept;
  const scene::ArmSimulation* simulation(std::size_t arm = 0) const noexcept;  ///< As above.
  /// Returns whether the run goes by the time of the world.
  bool real_time() const noexcept;
  /// Returns what the user must know, a sentence each: what was put right, left out or guessed of
  /// the meshes, and what became of limits that the scene names, where the arm is real.
  const std::vector<std::string>& told() const noexcept;

  /// Returns the newest tick; any thread may load it.
  const driver::Snapshot<driver::TickRecord>& newest(std::size_t arm = 0) const noexcept;
  /// Returns the ticks of the run, oldest first: every `stride`-th; none if they are not kept. Not
  /// beside a running servo.
  std::span<const driver::TickRecord> ticks(std::size_t arm = 0) const noexcept;
  /// Returns n where every n-th tick is kept: 1 up to a million ticks.
  std::uint64_t stride() const noexcept;
  /// Returns how often the force that carries an arm's weight was taken away because the tip moved
  /// with it (gravity compensation that is wrong, or a hand). Any thread.
  std::uint64_t carry_withdrawn(std::size_t arm = 0) const noexcept;
  /// Returns what the ticks sum up to; of no tick if they are not kept. Not beside a running servo.
  const RunStatistics& statistics() const noexcept;
  /// Returns the figures of a run that is over, or of one that is stopped here. Looks through the
  /// ticks for contacts that were lost. `grant`: what the kernel granted the servo's thread.
  /// Real-time: never from the servo thread.
  RunFigures figures(const driver::RealTimeGrant& grant = {}, std::size_t arm = 0) const;
  /// Returns the number of the object of this name; empty if the scene has none.
  std::optional<int> find_object(const std::string& name) const;
  /// Returns the mesh of one object, or of all as one if `object` is negative, where it is now:
  /// moved and bent (W, m). Not beside a running servo. Real-time: never from the servo thread.
  render::TriangleMesh mesh_now(int object = -1) const;
  /// Returns the meshes of all objects as one, with the deepest dent of the run (W, m); nothing if
  /// nothing was dented. As `mesh_now`.
  std::optional<render::TriangleMesh> deepest_dent() const;

  /// Begins a recording of every tick from now on; ends the one before. Of several arms each has a
  /// file of its own (file_of_arm). `overwrite`: existing recordings of these names are replaced;
  /// without it they are an error, as files of another kind always are. One thread beside the
  /// servo's. Real-time: never from the servo thread.
  driver::Result<void> begin_recording(const std::filesystem::path& path, bool overwrite = false);
  /// Ends the recording, if there is one, and returns its file, of several arms that of the first.
  /// The error says which ticks it lacks and why. As above.
  driver::Result<std::optional<std::filesystem::path>> end_recording();
  /// Writes the seconds around a fault, if one came, into the user's state folder and returns the
  /// file, of several arms the first one's; after the run. As above.
  driver::Result<std::optional<std::filesystem::path>> keep_black_box();
  /// Writes the seconds around the faults of all arms and returns the files. `run_is_over`: also
  /// those to which a running servo still adds ticks; else only those that are complete. As above.
  driver::Result<std::vector<std::filesystem::path>> keep_black_boxes(bool run_is_over);
  /// Returns what this session is, for the recordings of an arm. Real-time: never from the servo
  /// thread.
  RecordingInfo recording_info(std::size_t arm = 0) const;

  // What the program's own parts look into (app/session/src).

  /// Returns what is run.
  Setup& setup() noexcept;
  const Setup& setup() const noexcept;  ///< As above.
  /// Returns the session's own observers.
  RunRecords& records() noexcept;
  const RunRecords& records() const noexcept;     ///< As above.
  RunRecords& records(std::size_t arm) noexcept;  ///< As above, of one of several arms.
  /// Returns what viewers see; null if the run is not shared.
  SharedRun* shared() noexcept;
  /// Lets viewers see a run that was prepared without, as `options` asks; under the name of
  /// `before`, a run that is over, if it is not null. Before its first tick. The error is that of
  /// `prepare`. Real-time: never from the servo thread.
  driver::Result<void> share(const SessionOptions& options, SharedRun* before = nullptr);

 private:
  struct Parts;

  Session();

  std::unique_ptr<Parts> parts_;
};

}  // namespace thimble::session
