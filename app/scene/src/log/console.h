#pragma once

#include <spdlog/sinks/base_sink.h>

#include <cstdio>
#include <mutex>
#include <string>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Standard error of the process: whole lines, and below them one progress line. From any thread.
/// Real-time: never from the servo thread.
class THIMBLE_EXPORT Console {
 public:
  /// Writes a line, above the progress line if one is shown.
  void write(std::string_view line);
  /// Replaces the progress line; an empty one removes it.
  void show(std::string progress);
  /// Writes printable text to a stream. If it is a terminal, the text appears above the progress
  /// line, which disappears while the last line of the text is incomplete.
  void print(std::FILE* stream, std::string_view text);

 private:
  std::mutex mutex_;
  std::string progress_;
  bool partial_ = false;  // the last line printed at a terminal is incomplete
};

/// Returns the only console of this process.
THIMBLE_EXPORT Console& console();

/// Log sink that writes each message to the console in separate lines.
class ConsoleSink final : public spdlog::sinks::base_sink<std::mutex> {
 private:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}
};

}  // namespace thimble::scene
