#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "view/live_scene.h"
#include "view/plots.h"

namespace thimble::app::view {

/// Follows the runs of a name, one after the other: attaches, keeps the newest moment, and takes
/// the next run when one has ended. Real-time: never from the servo thread.
class RunFollower {
 public:
  /// Follows runs of this name; empty: whatever run is newest.
  explicit RunFollower(std::string name) : name_(std::move(name)) {}

  /// Looks what is new. Tells whether another run was taken, so that all must be drawn anew.
  bool step();

  /// Gives the run, which may have ended; nullptr if there was none so far.
  SharedReader* reader() { return reader_.get(); }
  /// Gives what is drawn. Precondition: there is a reader; as for the moment.
  const DrawnScene& scene() const { return live_->scene(); }
  const DrawnMoment& moment() const { return *moment_; }
  /// Tells whether the run has told of a tick so far.
  bool has_moment() const { return has_moment_; }
  const Plots& plots() const { return plots_; }
  /// Says why nothing moves; empty if it does.
  const std::string& notice() const { return notice_; }

 private:
  bool attach();

  std::string name_;
  std::unique_ptr<SharedReader> reader_;
  std::unique_ptr<LiveScene> live_;
  std::unique_ptr<DrawnMoment> moment_ = std::make_unique<DrawnMoment>();
  bool has_moment_ = false;
  Plots plots_;
  std::uint64_t serial_ = 0;
  std::vector<driver::TickRecord> ticks_;
  std::string notice_;
  std::chrono::steady_clock::time_point next_try_{};
};

}  // namespace thimble::app::view
