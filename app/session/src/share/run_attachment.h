#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "share/shared_reader.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// Keeps a viewer attached: waits for a run, tells when it ends, and goes over to the next one of
/// the same name. Used by one thread; Real-time: never from the servo thread.
class THIMBLE_EXPORT RunAttachment {
 public:
  /// Watches runs of a name; if it is empty, of the newest run there is and then of its name.
  explicit RunAttachment(std::string name) : name_(std::move(name)) {}

  /// Looks for a run if there is none or it has ended, at most four times a second: call it once
  /// per picture. Tells whether `reader` is another one now.
  bool step();

  /// Returns the run that is watched, also after its end; null before the first.
  SharedReader* reader() noexcept { return reader_.get(); }
  const std::string& name() const noexcept { return name_; }

  /// Returns whether the run has ended for good: one that is just being begun anew has not.
  bool over() const;

  /// Returns what a person must know: that a run is waited for, has ended or died, or why it cannot
  /// be watched. Empty while all is well.
  std::string notice() const;

 private:
  std::string name_;
  std::unique_ptr<SharedReader> reader_;
  std::string trouble_;
  std::chrono::steady_clock::time_point next_look_{};
};

}  // namespace thimble::session
