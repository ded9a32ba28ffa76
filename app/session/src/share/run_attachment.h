#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "share/shared_reader.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// Keeps a viewer attached: waits for a run, detects its end, and switches to the next one of the
/// same name. Used by one thread; Real-time: never from the servo thread.
class THIMBLE_EXPORT RunAttachment {
 public:
  /// Attaches to runs of a name; if it is empty, to the newest run and then to runs of its name.
  explicit RunAttachment(std::string name) : name_(std::move(name)) {}

  /// Searches for a run if there is none or it has ended, at most four times a second; call it once
  /// per picture. Returns whether `reader` has changed.
  bool step();

  /// Returns the current run, also after its end; null before the first.
  SharedReader* reader() noexcept { return reader_.get(); }
  const std::string& name() const noexcept { return name_; }

  /// Returns why a run of the name cannot be read; empty if there is no problem.
  const std::string& error() const noexcept { return error_; }

  /// Returns whether the run has ended and is not about to restart.
  bool over() const;

  /// Returns a message to show: that a run is awaited, has ended or died, or why it cannot be read.
  /// Empty without a problem.
  std::string notice() const;

 private:
  std::string name_;
  std::unique_ptr<SharedReader> reader_;
  std::string error_;
  std::chrono::steady_clock::time_point next_check_{};
};

}  // namespace thimble::session
