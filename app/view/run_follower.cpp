#include "view/run_follower.h"

namespace thimble::app::view {

bool RunFollower::step() {
  const bool another = runs_.step();
  notice_ = runs_.notice();
  session::SharedReader* const reader = runs_.reader();
  if (reader == nullptr) return false;
  if (another) {
    live_ = std::make_unique<LiveScene>(*reader);
    *moment_ = {};
    has_moment_ = false;
    plots_.clear();
    trail_.clear();
    serial_ = 0;
  }
  ticks_.clear();
  reader->ticks_since(serial_, ticks_);
  for (const driver::TickRecord& tick : ticks_) {
    plots_.add(tick);
    trail_.add(tick);
  }
  if (live_->update(*moment_)) has_moment_ = true;
  trail_.give(moment_->trail);
  if (notice_.empty() && reader->pause_asked()) notice_ = "Paused. Space goes on.";
  return another;
}

}  // namespace thimble::app::view
