#pragma once

#include <spdlog/sinks/base_sink.h>

#include <mutex>
#include <string>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Standard error as the whole process shares it: whole lines, and below them one line of progress
/// that stays the last one. From any thread. Real-time: never from the servo thread.
class THIMBLE_EXPORT Console {
 public:
  /// Writes a line, above the progress if one is shown.
  void write(std::string_view line);
  /// Shows a line of progress in place of the one before; an empty one takes it away.
  void show(std::string progress);

 private:
  std::mutex mutex_;
  std::string progress_;
};

/// Returns the one console of this process.
THIMBLE_EXPORT Console& console();

/// What a logger says on the console, each message in lines of its own.
class ConsoleSink final : public spdlog::sinks::base_sink<std::mutex> {
 private:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}
};

}  // namespace thimble::scene
