#include "recording/recorder.h"

#include <chrono>
#include <string>
#include <utility>

#include "log/logger.h"

namespace thimble::session {

driver::Result<std::unique_ptr<Recorder>> Recorder::open(const std::filesystem::path& path,
                                                         const RecordingInfo& info,
                                                         std::uint64_t ticks_max, bool replace) {
  auto file = RecordingFile::create(path, info, {.rows_max = ticks_max}, replace);
  if (!file) return file.error();
  return std::unique_ptr<Recorder>(new Recorder(std::move(file).value()));
}

Recorder::~Recorder() {
  stop_thread();
}

void Recorder::start_thread() {
  writer_ = std::thread([this] {
    while (!stop_.load()) {
      serve();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
}

void Recorder::stop_thread() {
  stop_.store(true);
  if (writer_.joinable()) writer_.join();
}

driver::Error Recorder::full() const {
  return driver::Error{path().string() + ": the recording is full after " +
                       std::to_string(file_.rows()) +
                       " ticks; later ticks are missing. Record long runs in several files."};
}

void Recorder::serve() noexcept {
  // Two rounds, because ticks that wrap around the end of the ring are in two pieces. Ticks that
  // arrive meanwhile wait for the next call.
  for (int piece = 0; piece < 2; ++piece) {
    const auto ticks = ring_.front();
    if (ticks.empty()) return;
    // After an error the ticks are dropped, so that the servo always finds room.
    if (!error_) {
      try {
        if (auto written = file_.append(ticks); !written) error_ = written.error();
        if (!error_ && file_.left_out() > 0) error_ = full();
      } catch (const std::exception& out_of_memory) {
        error_ = driver::Error{std::string("The recording ends: ") + out_of_memory.what()};
      }
      // Reported at once, because a long run may take hours.
      if (error_)
        scene::logger().warn("{} The run continues without the recording.", error_->message);
    }
    ring_.drop(ticks.size());
  }
}

driver::Result<void> Recorder::finish() {
  stop_thread();
  while (ring_.waiting() > 0) serve();
  auto finished = file_.finish(!error_ && dropped() == 0);
  if (error_) return *error_;
  if (!finished) return finished;
  if (dropped() > 0) {
    return driver::Error{path().string() + ": the disk was too slow; " + std::to_string(dropped()) +
                         " ticks are missing. Record to a faster disk."};
  }
  return {};
}

}  // namespace thimble::session
