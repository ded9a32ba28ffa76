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

/// A viewer's side of the memory that a run shares: what happens, and what to ask for.
///
/// Whatever the memory holds, nothing here crashes, and what it hands out is within bounds and
/// whole: from one tick, not from two. Used by one thread; Real-time: never from the servo thread.
class THIMBLE_EXPORT SharedReader {
 public:
  /// Attaches to a run by name, or to the newest one if `name` is empty. The error says what to
  /// do.
  static driver::Result<std::unique_ptr<SharedReader>> attach(const std::string& name);
  /// Reads memory that this process has mapped, such as `SharedRun::memory().again()`.
  static driver::Result<std::unique_ptr<SharedReader>> over(std::unique_ptr<SharedMemory> memory);
  /// Reads memory that somebody else keeps, aligned to 64, for tests.
  static driver::Result<std::unique_ptr<SharedReader>> over(std::span<std::byte> memory);

  SharedReader(const SharedReader&) = delete;
  SharedReader& operator=(const SharedReader&) = delete;
  /// Signs out of the run, which knows by name who looks on.
  ~SharedReader();

  /// Returns what does not change.
  const SharedScene& scene() const noexcept { return scene_; }
  /// Returns the name of the run; empty if it has none.
  const std::string& name() const noexcept { return name_; }

  /// Returns what the run is doing; kEnded too if its process has died or the memory is gone.
  RunState state() const;
  /// Returns whether the run ended without saying so: killed, or crashed.
  bool died() const;

  /// Copies the newest tick; false if there is none yet, or if the memory holds nonsense.
  bool newest(driver::TickRecord& record) const noexcept;
  /// Copies the newest tick of an arm after the first, counted from 1. As `newest`.
  bool newest_of(std::size_t arm, driver::TickRecord& record) const noexcept;
  /// Appends the ticks after number `serial` (0: from the oldest that is kept), oldest first, and
  /// moves `serial` to the last one. Tells how many were overwritten before they could be read.
  std::uint64_t ticks_since(std::uint64_t& serial, std::vector<driver::TickRecord>& ticks) const;
  /// Copies where the objects that move are; false if nothing was stored.
  bool poses(ScenePoses& poses) const noexcept;
  /// Copies the newest dent; false if nothing was stored. No triangles: nothing is dented.
  bool patch(render::BodyPatch& patch) const noexcept;
  /// Returns how many patches there were so far: a viewer need only draw anew if it has grown.
  std::uint64_t patch_count() const noexcept { return live_->patch.count(); }
  /// Brings the mesh of a shaped object (W, m; its own vertices from 0 on) to what it is now: as it
  /// was in `scene`, or as this left it before.
  void shape(std::size_t object, render::TriangleMesh& mesh) const;
  /// Counts vertices moved and edges split for good so far: a viewer need only look if it has
  /// grown.
  std::uint64_t shape_moves() const noexcept { return live_->shape_moves.load(); }

  /// What a run counts.
  struct Counters {
    std::uint64_t ticks = 0;
    std::uint64_t missed = 0;  ///< Periods of the loop that were skipped, but for those in a pause.
    std::uint64_t paused = 0;  ///< Ticks that passed in pauses: none where simulated time stands.
    bool recording = false;
    std::uint64_t record_dropped = 0;  ///< Ticks that the recording lacks.
  };
  Counters counters() const noexcept;
  /// Returns what the run wants a person to know: why a scene was not taken, say; empty: nothing.
  std::string notice() const;
  /// Returns where ticks are, or were last, recorded to; empty if nowhere.
  std::string recording_path() const;

  /// Returns what a knob is now; its first value if the memory holds nonsense. Precondition: the
  /// scene has it; as for all of these.
  double knob(std::size_t knob) const noexcept;
  /// Returns what it was turned to.
  double knob_wanted(std::size_t knob) const noexcept;
  /// Turns a knob; what is outside its bounds is brought within, NaN is ignored.
  void turn_knob(std::size_t knob, double value) noexcept;

  /// Answers whether the run looks at all that has been asked of it so far. The error: it has
  /// ended, and if another one takes its place, that is to be asked.
  driver::Result<void> heard() const;
  void ask_pause(bool pause) noexcept;
  bool pause_asked() const noexcept { return is_pause(live_->requests.pause.load()); }
  /// Lets a paused run go on by so many ticks, 1 to kStepsMost. The error says why it cannot.
  driver::Result<void> ask_steps(std::uint64_t ticks);
  /// Asks for a pace, kSpeedLeast to kSpeedMost times real time. The error says why the run has
  /// none.
  driver::Result<void> ask_speed(double speed);
  /// Returns what was asked for; 1 if the memory holds nonsense.
  double speed_asked() const noexcept;
  /// Asks the run to begin anew from its first tick, with `scene` (a file, absolute) or with its
  /// own as it lies on the disk now. The error says why it cannot.
  driver::Result<void> ask_restart(const std::string& scene = {});
  /// Asks that the run begins anew whenever it ends. The error as above.
  driver::Result<void> ask_loop(bool loop);
  bool loop_asked() const noexcept { return live_->requests.loop.load() == 1; }
  /// Returns why the run cannot be begun anew, be stepped, or go at another pace; empty if it can.
  std::string why_no_restart() const;
  std::string why_no_step() const;   ///< As above.
  std::string why_no_speed() const;  ///< As above.
  /// Asks the run to end.
  void ask_stop() noexcept { live_->requests.stop.store(1); }
  /// Asks for a recording to `path` (HDF5); empty: beside where the run was started, by name and
  /// time. False if another viewer is just asking for something.
  bool ask_record(const std::string& path = {}) noexcept;
  bool ask_record_stop() noexcept;
  /// Says where the hand shall be (W, m), and whether the mouse holds it. The run brings it into
  /// the workspace and bounds its speed. False as above, if it is not finite, and if this is one of
  /// too many viewers: should it die, the run would not know.
  bool lead_hand(const Eigen::Vector3d& p_WH, bool holds) noexcept;

  /// Reports that the key of the enabling input is held now; call it with each picture while it is.
  void hold_key() noexcept { live_->requests.key_held.fetch_add(1, std::memory_order_relaxed); }

  /// Counts what was read from the memory and made no sense.
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

  std::unique_ptr<SharedMemory> memory_;  // null if somebody else keeps it
  std::string name_;
  SharedScene scene_;
  SharedLive* live_;
  std::span<const SharedShaped> shaped_;
  std::span<const SharedSplit> splits_;
  std::span<const SharedRingSlot> ring_;
  std::optional<std::size_t> place_;  // among the viewers; none if all were taken
  mutable std::uint64_t rejected_ = 0;
};

}  // namespace thimble::session
