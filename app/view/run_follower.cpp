#include "view/run_follower.h"

#include <fmt/core.h>

namespace thimble::view {

bool RunFollower::step(double dt) {
  const bool another = runs_.step();
  notice_ = runs_.notice();
  session::SharedReader* const reader = runs_.reader();
  if (reader == nullptr) return false;
  if (another) {
    live_ = std::make_unique<LiveScene>(*reader);
    *newest_ = {};
    has_moment_ = false;
    plots_.clear();
    ring_.clear();
    head_ = PlayHead::of_run();
    trail_.clear();
    serial_ = 0;
  }
  ticks_.clear();
  reader->ticks_since(serial_, ticks_);
  for (const driver::TickRecord& tick : ticks_) {
    plots_.add(tick);
    trail_.add(tick);
  }
  if (live_->update(*newest_)) {
    has_moment_ = true;
    trail_.copy_to(newest_->trail);
    ring_.keep(*newest_);
  }
  if (!ring_.empty()) {
    head_.set_span(ring_.oldest(), ring_.newest());
    head_.step(dt);
    // A stopped head is at a kept moment, so that the displayed time is that of the picture.
    if (!head_.live() && !head_.plays()) head_.settle(ring_.time_of_step(head_.time(), 0));
    if (!head_.live()) ring_.show(head_.time(), *then_);
  }
  if (notice_.empty()) notice_ = reader->notice();
  if (notice_.empty() && reader->pause_asked()) notice_ = "Paused. Press space to continue.";
  return another;
}

std::string RunFollower::kept() const {
  if (ring_.empty()) return "";
  return fmt::format("The window stores the last {:.0f} s: {} moments, {:.1f} MB.",
                     ring_.newest() - ring_.oldest(), ring_.moments(),
                     1e-6 * static_cast<double>(ring_.bytes()));
}

}  // namespace thimble::view
