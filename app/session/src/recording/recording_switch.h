#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "recording/recorder.h"

namespace thimble::session {

/// Begins and ends recordings while the servo runs: the servo takes whatever recorder there is in
/// each tick, and waits for nobody.
class RecordingSwitch {
 public:
  /// Takes one tick (the servo loop's sink). Real-time: safe.
  void operator()(const driver::TickRecord& tick) noexcept {
    // Told before the recorder is looked at, so that nobody takes it away meanwhile.
    busy_.store(true, std::memory_order_seq_cst);
    if (Recorder* recorder = current_.load(std::memory_order_seq_cst)) (*recorder)(tick);
    busy_.store(false, std::memory_order_release);
  }

  /// Writes what has come, on the servo's own thread: for virtual time. Real-time: no.
  void serve_if_half_full() noexcept {
    Recorder* recorder = current_.load(std::memory_order_acquire);
    if (recorder == nullptr || recorder->waiting() < Recorder::kRingTicks / 2) return;
    busy_.store(true, std::memory_order_seq_cst);
    recorder = current_.load(std::memory_order_seq_cst);
    if (recorder != nullptr) recorder->serve();
    busy_.store(false, std::memory_order_release);
  }

  /// Begins a recording of at most `ticks_max` ticks; ends the one before. With `by_thread` a
  /// thread writes, otherwise `serve_if_half_full`. Real-time: never from the servo thread.
  driver::Result<void> begin(const std::filesystem::path& path, const RecordingInfo& info,
                             std::uint64_t ticks_max, bool by_thread);
  /// Ends the recording, if there is one. The error is that of Recorder::finish.
  /// Real-time: never from the servo thread.
  driver::Result<void> stop();

  /// Tells whether ticks are recorded. Real-time: safe.
  bool on() const noexcept { return current_.load(std::memory_order_relaxed) != nullptr; }
  /// Tells how many ticks the recording lacks. On the thread that begins and ends.
  std::uint64_t dropped() const noexcept { return recorder_ ? recorder_->dropped() : 0; }
  /// Gives the recorder; null if there is none. On the thread that begins and ends.
  Recorder* recorder() noexcept { return recorder_.get(); }

 private:
  std::unique_ptr<Recorder> recorder_;
  std::atomic<Recorder*> current_{nullptr};
  std::atomic<bool> busy_{false};
};

}  // namespace thimble::session
