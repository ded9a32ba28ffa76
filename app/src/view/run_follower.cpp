#include "view/run_follower.h"

#include <utility>

namespace thimble::app::view {
namespace {

constexpr std::chrono::milliseconds kBetweenTries{500};

}  // namespace

bool RunFollower::attach() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_try_) return false;
  next_try_ = now + kBetweenTries;
  auto found = SharedReader::attach(name_);
  if (!found) {
    if (reader_ == nullptr) notice_ = found.error().message;
    return false;
  }
  std::unique_ptr<SharedReader> next = std::move(found).value();
  // The one that has ended may still be there.
  const bool ended = next->state() == RunState::kEnded;
  if (reader_ != nullptr && (ended || next->scene().began_ns == reader_->scene().began_ns)) {
    return false;
  }
  live_.reset();  // refers to the reader
  reader_ = std::move(next);
  live_ = std::make_unique<LiveScene>(*reader_);
  *moment_ = {};
  has_moment_ = false;
  plots_.clear();
  serial_ = 0;
  return true;
}

bool RunFollower::step() {
  bool another = false;
  if (reader_ == nullptr || reader_->state() == RunState::kEnded) another = attach();
  if (reader_ == nullptr) return another;
  ticks_.clear();
  reader_->ticks_since(serial_, ticks_);
  for (const driver::TickRecord& tick : ticks_) plots_.add(tick);
  if (live_->update(*moment_)) has_moment_ = true;
  if (reader_->state() != RunState::kEnded) {
    notice_ = reader_->pause_asked() ? "Paused. Space goes on." : "";
  } else if (reader_->died()) {
    notice_ = "The run's process has died. Waiting for the next run.";
  } else {
    notice_ = "The run has ended. Waiting for the next one.";
  }
  return another;
}

}  // namespace thimble::app::view
