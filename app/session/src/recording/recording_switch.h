#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "law_change.h"
#include "recording/recorder.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Recordings of a run, which start and end while the servo runs. The servo passes each tick to the
/// current recorder, if any, and never waits.
class RecordingSwitch final : public TickObserver {
 public:
  /// Receives one tick. Real-time: safe; not for a recording started without a thread, because it
  /// writes.
  void take(const driver::TickRecord& tick) noexcept override {
    if (!on()) return;
    // Set before the recorder is read, so that another thread does not remove it meanwhile.
    busy_.store(true, std::memory_order_seq_cst);
    if (Recorder* recorder = current_.load(std::memory_order_seq_cst)) {
      (*recorder)(change_ != nullptr && change_->any() ? changed(tick) : tick);
      if (!by_thread_ && recorder->waiting() >= Recorder::kRingTicks / 2) recorder->serve();
    }
    busy_.store(false, std::memory_order_release);
  }

  /// Records the changes of the force law with each tick; `change` must outlive the run. Real-time:
  /// never from the servo thread.
  void watch(const LawChange& change) noexcept { change_ = &change; }

  /// Starts a recording of at most `ticks_max` ticks; ends the previous one. With `by_thread` a
  /// separate thread writes, otherwise the servo's, for virtual time. `replace` as for
  /// Recorder::open. Real-time: never from the servo thread.
  driver::Result<void> begin(const std::filesystem::path& path, const RecordingInfo& info,
                             std::uint64_t ticks_max, bool by_thread, bool replace = false);
  /// Ends the recording, if there is one. The error is that of Recorder::finish.
  /// Real-time: never from the servo thread.
  driver::Result<void> stop();

  /// Returns whether ticks are recorded. Real-time: safe.
  bool on() const noexcept { return current_.load(std::memory_order_relaxed) != nullptr; }
  /// Returns the number of ticks missing in the recording. Call on the thread that begins and ends.
  std::uint64_t dropped() const noexcept { return recorder_ ? recorder_->dropped() : 0; }
  /// Returns the recorder; null if there is none. Call on the thread that begins and ends.
  Recorder* recorder() noexcept { return recorder_.get(); }

 private:
  driver::TickRecord changed(driver::TickRecord tick) const noexcept {
    tick.setting = change_->setting;
    tick.setting_value = change_->value;
    tick.gain = change_->gain;
    return tick;
  }

  const LawChange* change_ = nullptr;
  std::unique_ptr<Recorder> recorder_;
  std::atomic<Recorder*> current_{nullptr};
  std::atomic<bool> busy_{false};
  bool by_thread_ = false;  // True if a thread writes the current recording; set before `current_`.
};

}  // namespace thimble::session
