#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "heat_keeper.h"
#include "recording/black_box.h"
#include "recording/recording_info.h"
#include "recording/recording_switch.h"
#include "share/live_control.h"
#include "share/shared_run.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/snapshot.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/real_arm_terms.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/scene_poses.h"
#include "thimble/session/dent_record.h"
#include "thimble/session/run_statistics.h"
#include "thimble/session/start_pose.h"
#include "thimble/session/trace.h"

namespace thimble::session {

/// Says which time a session runs on.
enum class ClockKind { kVirtual, kWall };

/// Says what the user asked for beyond the scene.
struct SessionOptions {
  ClockKind clock = ClockKind::kVirtual;
  std::optional<double> duration;            ///< s; the scene's own if empty
  std::optional<std::uint64_t> seed;         ///< of everything random; the scene's own if empty
  std::filesystem::path mesh_folder;         ///< where `cgal:` meshes lie
  std::filesystem::path arm_file;            ///< in place of the scene's own; empty: the scene's
  std::optional<driver::FoundArm> real_arm;  ///< in place of the simulated one
  std::optional<scene::RealArmTerms> terms;  ///< on which it may be used; needed with a real arm
  std::filesystem::path firmware;            ///< for a real arm that needs some (Falcon)
  std::filesystem::path record;              ///< where every tick is written; empty: nowhere
  bool share = false;                        ///< lets a viewer in this process see the run
  bool share_if_possible = false;            ///< goes on unseen where there is no shared memory
  bool share_out = false;                    ///< lets viewers of other processes see it
  bool hand_by_mouse =
      false;               ///< a viewer leads the simulated hand; the run ends when it is asked to
  std::string share_name;  ///< under which name; empty: the scene's, with a number if it is taken
  std::function<void(scene::Scene&)> adjust =
      {};              ///< changes the scene before anything is built of it
  bool homed = false;  ///< a real arm was in its home pose when it got power: do not ask for it
  /// Opens the wire to the real arm in place of `app::open_wire`, for tests.
  std::function<driver::Result<std::unique_ptr<driver::Transport>>(const scene::ArmFile&,
                                                                   driver::Clock&)>
      open_wire = {};
};

/// Is one scene, loaded and joined: clock, simulated arm, wire, device, touch, and who keeps the
/// records. The servo runs in `run`, on the caller's thread; `snapshot` may be read by others.
class Session {
 public:
  /// Does everything that takes time and needs no arm: reads the scene, its arm and its mesh, plans
  /// the hand's way, builds the objects, begins the recording and lets viewers see the run. The
  /// error names the file and what to mend. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Session>> prepare(const std::filesystem::path& scene_file,
                                                          const SessionOptions& options);
  /// Opens the arm of a prepared session. A simulated one may get forces from then on; a real one
  /// is idle, with zero force, until `activate`. Once. Real-time: never from the servo thread.
  driver::Result<void> open_arm();
  /// Lets forces through to the arm that was opened. Of a real arm the caller has looked before
  /// whether its tip is where it must be (`wait_for_start_pose`). Real-time: never from the servo
  /// thread.
  driver::Result<void> activate() { return device_->activate(); }

  /// Does all of it at once, for whoever can ask nobody: a real arm whose tip is not where it must
  /// be (`start_pose`) is an error. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Session>> open(const std::filesystem::path& scene_file,
                                                       const SessionOptions& options);

  /// Runs the servo loop until the scene's time is over, `stop` is set, or, with the simulated arm,
  /// a fault; with a real arm the loop outlives faults with zero force, so that the arm can come
  /// back. In every case the arm is left with zero force.
  driver::ServoEnd run(const std::atomic<bool>& stop) noexcept;

  /// Runs the next tick alone; `run` is nothing but all of them. Tells why there is none any more,
  /// once the run is over. Always with the same `stop`. Real-time: safe.
  std::optional<driver::ServoEnd> step(const std::atomic<bool>& stop) noexcept;

  /// Puts a force law in place of the scene's, for the whole run; it may ask `touch` for the
  /// scene's force. It must outlive the session. Fails unless time is virtual and no tick has run:
  /// whoever writes one outside of this program may take his time, which on a real arm nobody has.
  /// Real-time: never from the servo thread.
  driver::Result<void> set_law(driver::ForceLaw law);

  /// Leads the simulated hand from now on, in place of the scene's way (ArmSimulation::lead).
  /// Precondition: the arm is simulated. Between two ticks. Real-time: safe.
  bool lead_hand(const Eigen::Vector3d& p_WH) noexcept { return simulation_->lead(p_WH); }

  const scene::Scene& scene() const { return scene_; }
  /// Returns what became of limits that the scene names, where the arm is real: a sentence each.
  const std::vector<std::string>& told() const { return told_; }
  /// Returns what is known of the arm's feel check.
  scene::FeelCheckState feel_check() const { return feel_check_; }
  /// Gives the meshes of all objects in the world as one (m), for pictures: those that are touched,
  /// and those that stand for shapes; those on the disk are not in it.
  const render::TriangleMesh& mesh_W() const { return objects_->mesh_W(); }
  /// Returns what was put right, left out or guessed of the scene's meshes, a sentence each.
  const std::vector<std::string>& mesh_notes() const { return objects_->notes(); }
  /// Tells how many triangles can be touched, in memory and on the disk.
  std::size_t triangles() const { return objects_->triangles(); }
  const driver::Device& device() const { return *device_; }
  driver::Device& device() { return *device_; }
  /// Gives the simulation of the arm; nullptr if a real one is used.
  const scene::ArmSimulation* simulation() const { return simulation_.get(); }
  /// Gives it to who leads its hand from the servo's thread, beside a loop driven by hand.
  scene::ArmSimulation* simulation() { return simulation_.get(); }
  /// Gives the simulated arm. Precondition: it is simulated, and no Falcon.
  const device_sim::SimulatedArm& arm() const { return *simulation_->board_arm(); }
  /// Returns where the tip of the real arm must be before it gets a force.
  /// Precondition: the arm is real.
  const StartPose& start_pose() const { return *start_pose_; }
  /// Gives the clock that a new wire to a real arm must use.
  driver::Clock& clock() { return *clock_; }
  const render::SceneTouch& touch() const { return objects_->touch(); }
  /// Gives the force law, to be driven by hand in place of `run`.
  render::SceneTouch& touch() { return objects_->touch(); }
  /// Sums up what paging did for all objects on the disk; nothing if there are none.
  std::optional<render::PagingCounters> paging() const { return objects_->paging(); }
  const RunStatistics& statistics() const { return *statistics_; }
  const Trace& trace() const { return *trace_; }
  const driver::Snapshot<driver::TickRecord>& snapshot() const { return snapshot_; }
  /// Gives the recordings of the run; from one thread beside the servo's, and after the run.
  RecordingSwitch& recording() { return recording_; }
  /// Begins a recording of every tick from now on. Real-time: never from the servo thread.
  driver::Result<void> begin_recording(const std::filesystem::path& path);
  /// Gives what always keeps the last seconds.
  BlackBox& black_box() { return *black_box_; }
  /// Says what this session is, for its recordings.
  RecordingInfo recording_info() const;
  /// Gives the dents; nullptr if no object of the scene can dent.
  const DentRecord* dents() const { return dents_.get(); }
  /// Gives the meshes with the deepest dent of the run; as `mesh_W` if there was none.
  render::TriangleMesh bent_mesh_W() const;
  /// Shows where the objects that move are; nothing is ever stored if none does.
  const driver::Snapshot<scene::ScenePoses>& poses() const { return poses_; }
  /// Gives the mesh of one object, or of all as one if `object` is negative, where it is now: moved
  /// and bent (W, m). Not while `run` runs.
  render::TriangleMesh mesh_now(int object = -1) const { return objects_->mesh_now(object); }
  /// Gives what viewers see; nullptr if the run is not shared.
  SharedRun* shared() { return shared_.get(); }
  /// Tells whether the run goes by the time of the world.
  bool real_time() const { return by_thread_; }
  std::uint64_t seed() const { return seed_; }
  std::uint64_t ticks_planned() const { return ticks_; }
  std::int64_t period_ns() const { return period_ns_; }

  /// Takes the record of one tick (the servo loop's sink). Real-time: safe.
  void operator()(const driver::TickRecord& record) noexcept;

 private:
  /// Says where the vertices of a shaped object begin in what is shared.
  struct ShapedPlace {
    std::size_t object = 0;
    std::size_t first = 0;
  };

  Session() = default;
  void begin(const std::atomic<bool>& stop) noexcept;
  void store_poses(std::uint64_t tick) noexcept;
  void store_shapes() noexcept;
  driver::Result<void> share(const SessionOptions& options);
  driver::Result<void> plan_simulation(const std::filesystem::path& scene_file,
                                       const std::filesystem::path& firmware);

  scene::Scene scene_;
  std::vector<std::string> told_;
  scene::FeelCheckState feel_check_ = scene::FeelCheckState::kSimulated;
  std::uint64_t seed_ = 0;
  std::uint64_t ticks_ = 0;
  std::int64_t period_ns_ = 0;
  std::filesystem::path scene_file_;
  std::string device_name_;
  std::optional<driver::FoundArm> real_arm_;  // with what it takes to open it
  std::filesystem::path firmware_;
  std::optional<StartPose> start_pose_;
  decltype(SessionOptions::open_wire) open_wire_;
  std::unique_ptr<driver::Clock> clock_;
  std::unique_ptr<scene::ArmSimulation> simulation_;
  std::unique_ptr<driver::Device> device_;  // holds the wire to the simulation, so it goes first
  std::unique_ptr<scene::HeatKeeper> heat_keeper_;  // of a real arm whose file names its heat
  bool by_thread_ = false;  // whether threads load pages and write recordings
  std::unique_ptr<scene::SceneObjects> objects_;
  std::unique_ptr<RunStatistics> statistics_;
  std::unique_ptr<Trace> trace_;
  std::unique_ptr<DentRecord> dents_;
  driver::Snapshot<driver::TickRecord> snapshot_;
  RecordingSwitch recording_;
  std::atomic<bool> may_record_{false};  // a recording was asked for, or viewers may ask for one
  std::unique_ptr<BlackBox> black_box_;
  scene::ScenePoses poses_now_;
  driver::Snapshot<scene::ScenePoses> poses_;
  std::unique_ptr<SharedRun> shared_;
  std::unique_ptr<LiveControl> control_;   // if it is shared
  std::optional<driver::ForceLaw> law_;    // in place of the scene's
  std::optional<driver::ServoLoop> loop_;  // since the first tick
  bool ended_ = false;
  bool hand_by_mouse_ = false;
  std::vector<ShapedPlace> shaped_;  // the objects whose vertices move for good, if it is shared
};

}  // namespace thimble::session
