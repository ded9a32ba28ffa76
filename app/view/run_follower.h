#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "share/run_attachment.h"
#include "view/live_scene.h"
#include "view/marks/tip_trail.h"
#include "view/plots.h"

namespace thimble::app::view {

/// Keeps the newest moment of the runs that are watched, one after the other.
/// Real-time: never from the servo thread.
class RunFollower {
 public:
  /// Keeps `runs`, which must outlive this.
  explicit RunFollower(session::RunAttachment& runs) : runs_(runs) {}

  /// Looks what is new. Tells whether another run was taken, so that all must be drawn anew.
  bool step();

  /// Gives the run, which may have ended; nullptr if there was none so far.
  session::SharedReader* reader() { return runs_.reader(); }
  /// Gives what is drawn. Precondition: there is a reader; as for the moment.
  const DrawnScene& scene() const { return live_->scene(); }
  const DrawnMoment& moment() const { return *moment_; }
  /// Returns whether the run has told of a tick so far.
  bool has_moment() const { return has_moment_; }
  const Plots& plots() const { return plots_; }
  /// Says why nothing moves; empty if it does.
  const std::string& notice() const { return notice_; }

 private:
  session::RunAttachment& runs_;
  std::unique_ptr<LiveScene> live_;
  std::unique_ptr<DrawnMoment> moment_ = std::make_unique<DrawnMoment>();
  bool has_moment_ = false;
  Plots plots_;
  TipTrail trail_;
  std::uint64_t serial_ = 0;
  std::vector<driver::TickRecord> ticks_;
  std::string notice_;
};

}  // namespace thimble::app::view
