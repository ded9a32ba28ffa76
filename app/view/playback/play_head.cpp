#include "view/playback/play_head.h"

#include <algorithm>

namespace thimble::view {

void PlayHead::set_span(double begin, double end) {
  begin_ = begin;
  end_ = std::max(begin, end);
  if (!spanned_) time_ = begin_;
  spanned_ = true;
  time_ = std::clamp(time_, begin_, end_);
}

void PlayHead::step(double dt) {
  if (!plays_ || live_) return;
  time_ += speed_ * dt;
  if (time_ < end_) return;
  time_ = end_;
  plays_ = false;
  live_ = run_;
}

void PlayHead::go(double time) {
  live_ = run_ && time >= end_;
  if (live_) plays_ = false;
  time_ = std::clamp(time, begin_, end_);
}

void PlayHead::stop_at(double time) {
  go(time);
  stop();
}

void PlayHead::toggle() {
  if (live_) {
    time_ = end_;
    live_ = false;
    return;
  }
  plays_ = !plays_;
  if (plays_ && !run_ && time_ >= end_) time_ = begin_;
}

void PlayHead::set_speed(double speed) {
  speed_ = std::clamp(speed, kSlowest, kFastest);
}

}  // namespace thimble::view
