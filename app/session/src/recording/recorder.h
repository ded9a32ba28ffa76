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

/// Records every tick of a run; a sink for the servo loop, which never waits for the disk.
///
/// A thread of its own writes what has come every 20 ms, so a process that is killed loses less
/// than 100 ms. Where the disk or the recording is full the recording ends and the run continues;
/// the log says so at once, and `finish` again.
class Recorder {
 public:
  /// The room for ticks on their way to the disk: 8 s at 1 kHz, for disks that pause.
  static constexpr std::size_t kRingTicks = 8192;

  /// Begins a recording of at most `ticks_max` ticks. `replace` and the error are those of
  /// RecordingFile::create. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<Recorder>> open(const std::filesystem::path& path,
                                                        const RecordingInfo& info,
                                                        std::uint64_t ticks_max,
                                                        bool replace = false);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  /// Ends the thread; a recording that was not finished counts as cut off.
  ~Recorder();

  /// Takes one tick (the servo loop's sink). Real-time: safe.
  void operator()(const driver::TickRecord& tick) noexcept {
    if (!ring_.push(tick)) dropped_.fetch_add(1, std::memory_order_relaxed);
  }

  /// Lets a thread write from now on. Real-time: never from the servo thread.
  void start_thread();

  /// Writes what has come, on the caller's thread: for virtual time, in which a tick lasts as long
  /// as it computes. Not together with the thread. Real-time: no.
  void serve() noexcept;

  /// Returns how many ticks wait to be written. Real-time: safe.
  std::size_t waiting() const noexcept { return ring_.waiting(); }

  /// Writes what is left and ends the file, which is complete only if it lacks no tick. The error
  /// says after which tick the recording ended and why, or how many ticks it lacks. Real-time:
  /// never from the servo thread.
  driver::Result<void> finish();

  /// Returns how many ticks found no room, because the disk was too slow. Real-time: safe.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  const std::filesystem::path& path() const noexcept { return file_.path(); }

 private:
  explicit Recorder(RecordingFile file) : file_(std::move(file)) {}
  driver::Error full() const;
  void stop_thread();

  RecordingFile file_;
  SpscRing<driver::TickRecord> ring_{kRingTicks};
  std::atomic<std::uint64_t> dropped_{0};
  std::optional<driver::Error> trouble_;  // of whoever writes
  std::atomic<bool> stop_{false};
  std::thread writer_;
};

}  // namespace thimble::session
