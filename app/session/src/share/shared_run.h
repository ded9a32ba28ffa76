#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "share/knob_requests.h"
#include "share/shared_layout.h"
#include "share/shared_memory.h"
#include "share/shared_scene.h"
#include "thimble/driver/result.h"

namespace thimble::render {
struct EdgeSplit;
}

namespace thimble::session {

/// The run's side of the memory that it shares with its viewers: the servo stores what happens
/// and looks at what is asked for, and never waits for anybody.
class SharedRun final : public KnobRequests {
 public:
  /// Makes the memory under `name`, or without a name for a viewer in this process if it is empty,
  /// and writes what does not change of the scene; pid, times and tables of `scene` are filled in
  /// here. The ring keeps `ring_ticks` ticks (> 0). The error is that of SharedMemory.
  /// Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SharedRun>> create(const std::string& name,
                                                           const SharedScene& scene,
                                                           std::size_t ring_ticks);
  /// As above, of a run that follows one that is over: it takes the name of that, if it has one, as
  /// soon as it is complete, so that viewers always find a run of that name.
  static driver::Result<std::unique_ptr<SharedRun>> create_next(SharedRun& before,
                                                                const SharedScene& scene,
                                                                std::size_t ring_ticks);
  SharedRun(const SharedRun&) = delete;
  SharedRun& operator=(const SharedRun&) = delete;
  /// Tells the viewers that the run has ended, and removes the name.
  ~SharedRun() override;

  /// Returns the memory, for a reader in this process.
  const SharedMemory& memory() const noexcept { return *memory_; }
  /// Returns the name; empty if it has none.
  const std::string& name() const noexcept { return memory_->run(); }

  // What the servo stores. One thread; Real-time: safe.
  void store_tick(const driver::TickRecord& record) noexcept;
  /// Stores a tick of an arm after the first, counted from 1; one that is not there is ignored.
  void store_tick_of(std::size_t arm, const driver::TickRecord& record) noexcept {
    if (arm >= 1 && arm < kArmsMost) live_->others[arm - 1].store(record);
  }
  void store_poses(const ScenePoses& poses) noexcept { live_->poses.store(poses); }
  void store_patch(const render::BodyPatch& patch) noexcept { live_->patch.store(patch); }
  /// Stores where a vertex of a shaped object has gone for good (W, m). `shaped` counts through
  /// the table; one outside is ignored.
  void store_vertex(std::size_t shaped, const Eigen::Vector3d& p_W) noexcept;
  /// Stores that an edge of a shaped object was split; the place of its new vertex is stored
  /// before. `number` counts through the table; one outside is ignored.
  void store_split(std::size_t number, const render::EdgeSplit& split) noexcept;
  void store_knob(std::size_t knob, double now) noexcept override {
    live_->knobs[knob].now.store(now, std::memory_order_relaxed);
  }

  // What any thread of the run may tell. Real-time: safe.
  void set_state(RunState state) noexcept {
    live_->state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
  }
  void set_recording(bool on, std::uint64_t dropped) noexcept;
  /// Returns where ticks are recorded to; one thread.
  void set_recording_path(const std::string& path) noexcept;

  // What viewers ask for. Nothing of it can be trusted: it is checked here. Real-time: safe.
  bool pause_asked() const noexcept {
    return is_pause(live_->requests.pause.load(std::memory_order_relaxed));
  }
  bool stop_asked() const noexcept {
    return live_->requests.stop.load(std::memory_order_relaxed) == 1;
  }
  bool loop_asked() const noexcept {
    return live_->requests.loop.load(std::memory_order_relaxed) == 1;
  }
  /// Returns a number that has grown since it was asked last if a viewer's key is held. Any number
  /// may stand there.
  std::uint64_t key_held() const noexcept {
    return live_->requests.key_held.load(std::memory_order_relaxed);
  }
  /// Returns how fast the run shall go, times real time; empty if a viewer wrote nonsense.
  std::optional<double> speed_wanted() const noexcept;
  /// Returns how many ticks a paused run was let go on by so far. Any number may stand there.
  std::uint64_t steps_asked() const noexcept {
    return live_->requests.steps.load(std::memory_order_relaxed);
  }
  /// Returns what a knob shall be: within its bounds, or empty if a viewer wrote nonsense.
  std::optional<double> knob_wanted(std::size_t knob) const noexcept override;
  std::size_t knob_count() const noexcept { return knobs_.size(); }
  /// Looks where a viewer wants the hand (W, m, finite); false if none ever did, or one is writing
  /// just now.
  bool hand(SharedHand& hand) const noexcept;

  /// An order to record or to stop that.
  struct RecordOrder {
    std::uint64_t number = 0;  ///< Grows with each order.
    bool record = false;
    std::string path;  ///< Empty: the run chooses.
  };
  /// Returns the newest order, if there is one after `number`. Real-time: never from the servo
  /// thread.
  std::optional<RecordOrder> record_order_after(std::uint64_t number) const;
  /// An order to begin the run anew.
  struct RestartOrder {
    std::uint64_t number = 0;  ///< Grows with each order.
    std::string scene;         ///< The file to run; empty: the same once more.
  };
  /// Returns the newest order, if there is one after `number`. Real-time: never from the servo
  /// thread.
  std::optional<RestartOrder> restart_order_after(std::uint64_t number) const;
  /// Sets what viewers find as asked for, unless one has asked already.
  void set_pace(double speed, bool loop) noexcept;
  /// Lets the run begin paused, as one was asked to be that ended before it could.
  void begin_paused() noexcept { live_->requests.pause.store(kPausedByNobody); }
  /// Ends the hearing: what a viewer asks from now on it is told that nobody hears. What was asked
  /// before can be seen when this returns, and must be looked at once more. Any thread but the
  /// servo's.
  void close() noexcept;
  /// Returns whether the hearing has ended.
  bool closed() const noexcept { return live_->closed.load() == 1; }
  /// Tells viewers what a person must know; empty: nothing any more. One thread.
  void set_notice(const std::string& notice) noexcept;
  /// Returns a knob by its number.
  const SharedScene::Knob& knob(std::size_t knob) const noexcept { return knobs_[knob]; }
  /// Returns the pids of the viewers that look on. Real-time: never from the servo thread.
  std::vector<std::uint64_t> viewers() const;
  /// Does for viewers that died what they would have done: lets the hand go that one held, makes
  /// whole what one was killed in writing, ends the pause that one asked of a run in virtual time
  /// (which would wait for ever; a loop in real time stays paused, without force), and forgets
  /// them. Returns whether it has ended a pause. One thread. Real-time: never from the servo
  /// thread.
  bool watch_viewers() noexcept;

 private:
  explicit SharedRun(std::unique_ptr<SharedMemory> memory) : memory_(std::move(memory)) {}
  static driver::Result<std::unique_ptr<SharedRun>> make(const std::string& name,
                                                         const SharedMemory* before,
                                                         const SharedScene& scene,
                                                         std::size_t ring_ticks);
  void write(const SharedScene& scene, std::size_t ring_ticks);
  bool is_viewer_alive(std::uint64_t place) const noexcept;
  void release_hand() noexcept;
  bool end_pause_of_dead() noexcept;

  std::unique_ptr<SharedMemory> memory_;
  SharedHead* head_ = nullptr;
  SharedLive* live_ = nullptr;
  SharedShaped* shaped_ = nullptr;
  std::size_t shaped_count_ = 0;
  SharedSplit* splits_ = nullptr;
  std::size_t splits_count_ = 0;
  SharedRingSlot* ring_ = nullptr;
  std::size_t ring_count_ = 0;
  std::vector<SharedScene::Knob> knobs_;
  std::uint64_t stored_ = 0;
  std::int64_t last_due_ns_ = 0;
  std::int64_t period_ns_ = 0;
  SharedHand last_hand_;  // as a viewer has asked for it last; not finite before
};

}  // namespace thimble::session
