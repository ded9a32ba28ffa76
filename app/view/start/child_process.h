#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::view {

/// What a process of the start window writes, and what it may cost.
struct ChildChoice {
  bool keep_output =
      false;  ///< Keeps standard output for `text`; otherwise it is that of this process.
  bool keep_errors = false;  ///< Keeps standard error for `text`, and passes it on.
  bool quiet = false;        ///< Discards all output that is not kept.
  int nice = 0;              ///< Added to its niceness.
};

/// A process that ends with this one: a run, a picture, a file dialog. It has no standard input.
/// Real-time: never from the servo thread.
class ChildProcess {
 public:
  /// Starts a program with arguments. The error says why it cannot be started.
  static driver::Result<std::unique_ptr<ChildProcess>> start(
      const std::filesystem::path& program, const std::vector<std::string>& arguments,
      const ChildChoice& choice);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Ends the process by SIGTERM, which a run obeys within a tick, and waits for it; after 5 s by
  /// SIGKILL.
  ~ChildProcess();

  /// Returns the exit code of a process that has ended, 128 plus the signal if one ended it; empty
  /// while it runs. Reads its output.
  std::optional<int> ended();
  /// Returns the process id.
  pid_t pid() const { return pid_; }
  /// Returns the kept output, the last 64 KiB at most.
  const std::string& text() const { return text_; }

 private:
  ChildProcess() = default;
  void read_text();

  pid_t pid_ = 0;
  int pipe_ = -1;
  bool pass_on_ = false;
  std::optional<int> code_;
  std::string text_;
};

}  // namespace thimble::view
