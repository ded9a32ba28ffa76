#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "share/shared_layout.h"
#include "share/shared_memory.h"
#include "share/shared_scene.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::session {

/// Viewer's access to the memory that a run shares: reads its state and sends requests.
///
/// Invalid contents of the memory never cause a crash. All returned data is within bounds and
/// consistent: from one tick. Used by one thread; Real-time: never from the servo thread.
class THIMBLE_EXPORT SharedReader {
 public:
  /// Attaches to a run by name, or to the newest one if `name` is empty. The error says what to
  /// do.
  static driver::Result<std::unique_ptr<SharedReader>> attach(const std::string& name);
  /// Reads memory that this process has mapped, such as `SharedRun::memory().again()`.
  static driver::Result<std::unique_ptr<SharedReader>> over(std::unique_ptr<SharedMemory> memory);
  /// Reads memory owned by the caller, aligned to 64, for tests.
  static driver::Result<std::unique_ptr<SharedReader>> over(std::span<std::byte> memory);

  SharedReader(const SharedReader&) = delete;
  SharedReader& operator=(const SharedReader&) = delete;
  /// Signs out of the run, which keeps a list of its viewers.
  ~SharedReader();

  /// Returns the constant data of the run.
  const SharedScene& scene() const noexcept { return scene_; }
  /// Returns the name of the run; empty if it has none.
  const std::string& name() const noexcept { return name_; }

  /// Returns the state of the run; kEnded also if its process has died or the memory is gone.
  RunState state() const;
  /// Returns whether the run was killed or crashed.
  bool died() const;

  /// Copies the newest tick. Returns false if there is none yet, or if the memory is invalid.
  bool newest(driver::TickRecord& record) const noexcept;
  /// Copies the newest tick of an arm after the first, numbered from 1. As `newest`.
  bool newest_of(std::size_t arm, driver::TickRecord& record) const noexcept;
  /// Appends the ticks after number `serial` (0: from the oldest available), oldest first, and sets
  /// `serial` to the last one. Returns the number of ticks that were overwritten before they could
  /// be read.
  std::uint64_t ticks_since(std::uint64_t& serial, std::vector<driver::TickRecord>& ticks) const;
  /// Copies the poses of the moving objects; returns false if none were stored.
  bool poses(ScenePoses& poses) const noexcept;
  /// Copies the newest dent; returns false if none was stored. Without triangles nothing is dented.
  bool patch(render::BodyPatch& patch) const noexcept;
  /// Returns the number of patches so far; a viewer redraws only if it has increased.
  std::uint64_t patch_count() const noexcept { return live_->patch.count(); }
  /// Updates the mesh of a shaped object (W, m; its own vertices from 0 on) to its current shape,
  /// from its state in `scene` or after the last call.
  void shape(std::size_t object, render::TriangleMesh& mesh) const;
  /// Returns the number of permanent vertex moves and edge splits so far; a viewer updates only if
  /// it has increased.
  std::uint64_t shape_moves() const noexcept { return live_->shape_moves.load(); }

  /// Counters of a run.
  struct Counters {
    std::uint64_t ticks = 0;
    std::uint64_t missed = 0;  ///< Periods of the loop that were skipped, except those in a pause.
    std::uint64_t paused = 0;  ///< Ticks that passed in pauses; 0 if simulated time stops.
    bool recording = false;
    std::uint64_t record_dropped = 0;  ///< Ticks missing in the recording.
  };
  Counters counters() const noexcept;
  /// Returns the message of the run to the user, such as the reason why a scene was rejected;
  /// empty: none.
  std::string notice() const;
  /// Returns the path of the current or last recording; empty if there is none.
  std::string recording_path() const;

  /// Returns the current value of a knob; its initial value if the memory is invalid. Precondition,
  /// also for the next functions: the scene has the knob.
  double knob(std::size_t knob) const noexcept;
  /// Returns the requested value of a knob.
  double knob_wanted(std::size_t knob) const noexcept;
  /// Requests a value of a knob, limited to its bounds; NaN is ignored.
  void turn_knob(std::size_t knob, double value) noexcept;

  /// Returns success if the run processes all requests made so far. Fails if it has ended; send
  /// requests to the run that replaces it, if any.
  driver::Result<void> check_accepted() const;
  void ask_pause(bool pause) noexcept;
  bool pause_asked() const noexcept { return is_pause(live_->requests.pause.load()); }
  /// Lets a paused run advance by `ticks`, 1 to kStepsMax. The error gives the reason if it
  /// cannot.
  driver::Result<void> ask_steps(std::uint64_t ticks);
  /// Requests a speed, kSpeedMin to kSpeedMax times real time. The error gives the reason if the
  /// run does not support it.
  driver::Result<void> ask_speed(double speed);
  /// Returns the requested speed; 1 if the memory is invalid.
  double speed_asked() const noexcept;
  /// Requests a restart from the first tick, with `scene` (a file, absolute) or with the current
  /// version of its own scene file. The error gives the reason if it cannot.
  driver::Result<void> ask_restart(const std::string& scene = {});
  /// Requests a restart whenever the run ends. The error is that of `ask_restart`.
  driver::Result<void> ask_loop(bool loop);
  bool loop_asked() const noexcept { return live_->requests.loop.load() == 1; }
  /// Returns the reason why the run cannot be restarted; empty if it can.
  std::string why_no_restart() const;
  /// Returns the reason why the run cannot be stepped; empty if it can.
  std::string why_no_step() const;
  /// Returns the reason why the run has no other speed; empty if it has.
  std::string why_no_speed() const;
  /// Requests the end of the run.
  void ask_stop() noexcept { live_->requests.stop.store(1); }
  /// Requests a recording to `path` (HDF5). If empty, the file is in the folder in which the run
  /// was started, named by scene and time. Returns false if another viewer is writing a request.
  bool ask_record(const std::string& path = {}) noexcept;
  bool ask_record_stop() noexcept;
  /// Sets the target of the hand (W, m), and whether the mouse holds it. The run limits it to the
  /// workspace and limits its speed. Returns false if another viewer is writing a request, or if
  /// the target is not finite. Also returns false if there are too many viewers, because the run
  /// could not detect the death of this one.
  bool lead_hand(const Eigen::Vector3d& p_WH, bool holds) noexcept;

  /// Reports that the key of the enabling input is held; call it with each picture while it is.
  void hold_key() noexcept { live_->requests.key_held.fetch_add(1, std::memory_order_relaxed); }

  /// Holds buttons of the simulated arm (one bit each; bit 0 is the first); call it with each
  /// picture while one is held, and with 0 once they are released.
  void hold_buttons(std::uint16_t buttons) noexcept {
    const std::uint64_t before = live_->requests.buttons.load(std::memory_order_relaxed);
    live_->requests.buttons.store(((before >> 16U) + 1U) << 16U | buttons,
                                  std::memory_order_relaxed);
  }

  /// Returns the number of invalid values read from the memory.
  std::uint64_t rejected() const noexcept { return rejected_; }

 private:
  SharedReader(std::unique_ptr<SharedMemory> memory, std::span<std::byte> bytes, SharedScene scene);
  void sign_in() noexcept;
  bool sound(driver::TickRecord& record) const noexcept;
  bool sound(ScenePoses& poses) const noexcept;
  bool sound(render::BodyPatch& patch) const noexcept;
  bool take_turn() noexcept;
  void end_turn() noexcept;
  std::string why_real() const;

  std::unique_ptr<SharedMemory> memory_;  // Null if the caller owns the memory.
  std::string name_;
  SharedScene scene_;
  SharedLive* live_;
  std::span<const SharedShaped> shaped_;
  std::span<const SharedSplit> splits_;
  std::span<const SharedRingSlot> ring_;
  std::optional<std::size_t> place_;  // Place among the viewers; empty if all were taken.
  mutable std::uint64_t rejected_ = 0;
};

}  // namespace thimble::session
