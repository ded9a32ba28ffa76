#pragma once

#include <spdlog/sinks/base_sink.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::scene {

/// Log file of a process: one line per message with time (ISO 8601), level, process id and logger.
/// Only its owner can read it (mode 0600), and a file that is not a log is never appended to.
/// Opened with the first message. If it cannot be written, logging to it ends, the user is informed
/// once, and the program continues. From any thread. Real-time: never from the servo thread.
class LogFile final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  /// Largest size of a file, bytes, and number of files kept by rotation: 5 MB. [chosen: an hour of
  /// touch produces about 100 kB]
  static constexpr std::size_t kBytesMax = 1'000'000, kFilesMax = 5;

  /// Growth of a log file.
  enum class Growth {
    kRotates,  ///< Replaced by a new file at kBytesMax (NAME.1.log, ...).
    kEndless,  ///< Unlimited; for a file named by the user.
  };

  /// Constructs a log to `path`; `heading` is the first message of the process.
  LogFile(std::filesystem::path path, Growth growth, std::string heading);

  /// Opens the file now. The error names the file and the reason.
  driver::Result<void> open();

  const std::filesystem::path& path() const noexcept { return path_; }

 private:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}
  void open_it();
  void end(const std::string& why);

  std::filesystem::path path_;
  Growth growth_;
  std::string heading_;
  std::shared_ptr<spdlog::sinks::sink> file_;  // Set once it is open.
  bool ended_ = false;
};

}  // namespace thimble::scene
