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
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::render {
struct EdgeSplit;
}

namespace thimble::session {

/// Returns an error if a scene has more objects than viewers can show. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT driver::Result<void> check_object_count(std::size_t count);

/// Run's access to the memory that it shares with its viewers. The servo stores its state and reads
/// requests, and never waits.
class SharedRun final : public KnobRequests {
 public:
  /// Creates the memory and writes the constant data of the scene. If `name` is empty, the memory
  /// has no name and is for a viewer in this process. Sets pid, times and tables of `scene`. The
  /// ring has `ring_ticks` entries (> 0). The error is that of SharedMemory. Real-time: never from
  /// the servo thread.
  static driver::Result<std::unique_ptr<SharedRun>> create(const std::string& name,
                                                           const SharedScene& scene,
                                                           std::size_t ring_ticks);
  /// As above, for a run that follows one that is over. Once it is complete, it takes the name of
  /// the previous run, if any. So viewers find a run of that name at all times.
  static driver::Result<std::unique_ptr<SharedRun>> create_next(SharedRun& before,
                                                                const SharedScene& scene,
                                                                std::size_t ring_ticks);
  SharedRun(const SharedRun&) = delete;
  SharedRun& operator=(const SharedRun&) = delete;
  /// Reports the end of the run to viewers and removes the name.
  ~SharedRun() override;

  /// Returns the memory, for a reader in this process.
  const SharedMemory& memory() const noexcept { return *memory_; }
  /// Returns the name; empty if it has none.
  const std::string& name() const noexcept { return memory_->run(); }

  // Functions that store data of the servo. One thread; Real-time: safe.
  void store_tick(const driver::TickRecord& record) noexcept;
  /// Stores a tick of an arm after the first, numbered from 1; ignored if there is no such arm.
  void store_tick_of(std::size_t arm, const driver::TickRecord& record) noexcept {
    if (arm >= 1 && arm < kArmsMax) live_->others[arm - 1].store(record);
  }
  void store_poses(const ScenePoses& poses) noexcept { live_->poses.store(poses); }
  void store_patch(const render::BodyPatch& patch) noexcept { live_->patch.store(patch); }
  /// Stores the permanent position of a vertex of a shaped object (W, m). `shaped`: index into the
  /// table; ignored if out of range.
  void store_vertex(std::size_t shaped, const Eigen::Vector3d& p_W) noexcept;
  /// Stores a split of an edge of a shaped object; the position of its new vertex is stored before.
  /// `number`: index into the table; ignored if out of range.
  void store_split(std::size_t number, const render::EdgeSplit& split) noexcept;
  void store_knob(std::size_t knob, double now) noexcept override {
    live_->knobs[knob].now.store(now, std::memory_order_relaxed);
  }

  // Functions for any thread of the run. Real-time: safe.
  void set_state(RunState state) noexcept {
    live_->state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
  }
  void set_recording(bool on, std::uint64_t dropped) noexcept;
  /// Sets the path of the recording; one thread.
  void set_recording_path(const std::string& path) noexcept;

  // Requests of viewers. They are not trusted and are validated here. Real-time: safe.
  bool pause_asked() const noexcept {
    return is_pause(live_->requests.pause.load(std::memory_order_relaxed));
  }
  bool stop_asked() const noexcept {
    return live_->requests.stop.load(std::memory_order_relaxed) == 1;
  }
  bool loop_asked() const noexcept {
    return live_->requests.loop.load(std::memory_order_relaxed) == 1;
  }
  /// Returns a number that increases while a viewer's key is held. Its value is arbitrary.
  std::uint64_t key_held() const noexcept {
    return live_->requests.key_held.load(std::memory_order_relaxed);
  }
  /// Returns the buttons that a viewer's keys hold, in the lower 16 bits. The number changes with
  /// each picture drawn while one is held. Its value is arbitrary.
  std::uint64_t buttons_asked() const noexcept {
    return live_->requests.buttons.load(std::memory_order_relaxed);
  }
  /// Returns the requested speed as a multiple of real time; empty if it is invalid.
  std::optional<double> speed_wanted() const noexcept;
  /// Returns the total number of steps requested for a paused run. Its value is arbitrary.
  std::uint64_t steps_asked() const noexcept {
    return live_->requests.steps.load(std::memory_order_relaxed);
  }
  /// Returns the requested value of a knob, within its bounds; empty if it is invalid.
  std::optional<double> knob_wanted(std::size_t knob) const noexcept override;
  std::size_t knob_count() const noexcept { return knobs_.size(); }
  /// Copies the target of the hand set by a viewer (W, m, finite). Returns false if there is none,
  /// or if a viewer is writing it.
  bool hand(SharedHand& hand) const noexcept;

  /// Request to start or stop a recording.
  struct RecordRequest {
    std::uint64_t number = 0;  ///< Number of the request.
    bool record = false;
    std::string path;  ///< Path of the recording; empty: chosen by the run.
  };
  /// Returns the newest request after `number`; empty if there is none. Real-time: never from the
  /// servo thread.
  std::optional<RecordRequest> record_request_after(std::uint64_t number) const;
  /// Request to restart the run.
  struct RestartRequest {
    std::uint64_t number = 0;  ///< Number of the request.
    std::string scene;         ///< Scene file to run; empty: the same scene.
  };
  /// Returns the newest request after `number`; empty if there is none. Real-time: never from the
  /// servo thread.
  std::optional<RestartRequest> restart_request_after(std::uint64_t number) const;
  /// Sets the initial values of the requested speed and loop, unless a viewer has set them.
  void set_pace(double speed, bool loop) noexcept;
  /// Starts the run paused, if a pause was requested from the previous run just before its end.
  void begin_paused() noexcept { live_->requests.pause.store(kPausedWithoutPlace); }
  /// Closes the run to requests: later requests of viewers are rejected. Requests made before are
  /// visible when this returns, and must be processed once more. Any thread except the servo's.
  void close() noexcept;
  /// Returns whether the run is closed to requests.
  bool closed() const noexcept { return live_->closed.load() == 1; }
  /// Sets the message to viewers; empty: none. One thread.
  void set_notice(const std::string& notice) noexcept;
  /// Returns the description of a knob by its number.
  const SharedScene::Knob& knob(std::size_t knob) const noexcept { return knobs_[knob]; }
  /// Returns the process ids of the viewers. Real-time: never from the servo thread.
  std::vector<std::uint64_t> viewers() const;
  /// Cleans up after viewers that died: releases the hand, repairs a partly written request, ends a
  /// pause in virtual time, and removes them from the list. (Such a pause would last forever; a
  /// loop in real time stays paused, without force.) Returns whether it has ended a pause. One
  /// thread. Real-time: never from the servo thread.
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
  SharedHand last_hand_;  // Last request of a viewer; not finite before.
};

}  // namespace thimble::session
