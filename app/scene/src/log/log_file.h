#pragma once

#include <spdlog/sinks/base_sink.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::scene {

/// The file that a process logs to: a line per message with the time (ISO 8601), the level, the
/// number of the process and who says it. Only its owner can read it (mode 0600), and a file that
/// is no log is never appended to. Opened with the first message. Where it cannot be written the
/// log ends, the user is told once, and everything else goes on. From any thread. Real-time: never
/// from the servo thread.
class LogFile final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  /// Bytes of a file and number of files that are kept when it rotates: 5 MB. [chosen: an hour of
  /// touch leaves about 100 kB]
  static constexpr std::size_t kBytesMost = 1'000'000, kFilesMost = 5;

  /// How a file grows.
  enum class Growth {
    kRotates,  ///< At kBytesMost it gives way to a new one (NAME.1.log, ...).
    kEndless,  ///< As its user named it.
  };

  /// Logs to `path`; `heading` is what the process says first.
  LogFile(std::filesystem::path path, Growth growth, std::string heading);

  /// Opens the file now. The error says which file, and why not.
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
  std::shared_ptr<spdlog::sinks::sink> file_;  // once it is open
  bool ended_ = false;
};

}  // namespace thimble::scene
