#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "recording/recording_file.h"
#include "spsc_ring.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Records every tick of a run. A sink for the servo loop that never waits for the disk.
///
/// A separate thread writes new ticks every 20 ms, so a process that is killed loses less than 100
/// ms. If the disk or the recording is full, the recording ends and the run continues. The log
/// reports it at once, and `finish` again.
class Recorder {
 public:
  /// Capacity for ticks that are not yet written: 8 s at 1 kHz, for disks that pause.
  static constexpr std::size_t kRingTicks = 8192;

  /// Starts a recording of at most `ticks_max` ticks. `replace` and the error are those of
  /// RecordingFile::create. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Recorder>> open(const std::filesystem::path& path,
                                                        const RecordingInfo& info,
                                                        std::uint64_t ticks_max,
                                                        bool replace = false);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  /// Ends the thread; an unfinished recording counts as cut off.
  ~Recorder();

  /// Receives one tick (the servo loop's sink). Real-time: safe.
  void operator()(const driver::TickRecord& tick) noexcept {
    if (!ring_.push(tick)) dropped_.fetch_add(1, std::memory_order_relaxed);
  }

  /// Starts the thread that writes. Real-time: never from the servo thread.
  void start_thread();

  /// Writes the waiting ticks on the caller's thread, for virtual time, in which a tick lasts as
  /// long as it computes. Cannot be combined with the thread. Real-time: no.
  void serve() noexcept;

  /// Returns the number of ticks not yet written. Real-time: safe.
  std::size_t waiting() const noexcept { return ring_.waiting(); }

  /// Writes the remaining ticks and closes the file, which is complete only if no tick is missing.
  /// The error says after which tick the recording ended and why, or how many ticks are missing.
  /// Real-time: never from the servo thread.
  driver::Result<void> finish();

  /// Returns the number of ticks lost because the disk was too slow. Real-time: safe.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  const std::filesystem::path& path() const noexcept { return file_.path(); }

 private:
  explicit Recorder(RecordingFile file) : file_(std::move(file)) {}
  driver::Error full() const;
  void stop_thread();

  RecordingFile file_;
  SpscRing<driver::TickRecord> ring_{kRingTicks};
  std::atomic<std::uint64_t> dropped_{0};
  std::optional<driver::Error> error_;  // Error of the writing thread.
  std::atomic<bool> stop_{false};
  std::thread writer_;
};

}  // namespace thimble::session
