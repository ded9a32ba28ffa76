#include "recording/recording_switch.h"

#include <chrono>
#include <thread>
#include <utility>

namespace thimble::session {

driver::Result<void> RecordingSwitch::begin(const std::filesystem::path& path,
                                            const RecordingInfo& info, std::uint64_t ticks_max,
                                            bool by_thread, bool replace) {
  if (auto stopped = stop(); !stopped) return stopped;
  auto recorder = Recorder::open(path, info, ticks_max, replace);
  if (!recorder) return recorder.error();
  recorder_ = std::move(recorder).value();
  by_thread_ = by_thread;
  if (by_thread) recorder_->start_thread();
  current_.store(recorder_.get(), std::memory_order_seq_cst);
  return {};
}

driver::Result<void> RecordingSwitch::stop() {
  if (!recorder_) return {};
  current_.store(nullptr, std::memory_order_seq_cst);
  while (busy_.load(std::memory_order_seq_cst)) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  auto finished = recorder_->finish();
  recorder_.reset();
  return finished;
}

}  // namespace thimble::session
