#include "observers/black_box.h"

#include <algorithm>
#include <cmath>

#include "prefetch_to_write.h"

namespace thimble::session {

BlackBox::BlackBox(double rate)
    : ticks_(static_cast<std::size_t>(std::ceil((kBefore + kAfter) * rate))),
      after_(static_cast<std::size_t>(std::ceil(kAfter * rate))) {}

void BlackBox::take(const driver::TickRecord& tick) noexcept {
  const bool faulty = tick.fault != driver::Fault::kNone;
  const bool begins = faulty && !faulty_;
  faulty_ = faulty;
  if (full_.load(std::memory_order_acquire)) return;
  ticks_[next_] = tick;
  if (++next_ == ticks_.size()) next_ = 0;
  prefetch_to_write(ticks_[next_]);
  ++taken_;
  if (begins && !fault_came_) {
    fault_came_ = true;
    left_ = after_;
  } else if (fault_came_ && --left_ == 0) {
    full_.store(true, std::memory_order_release);
  }
}

std::vector<driver::TickRecord> BlackBox::release() {
  std::vector<driver::TickRecord> kept;
  if (!fault_came_) return kept;
  const std::uint64_t count = std::min<std::uint64_t>(taken_, ticks_.size());
  kept.reserve(count);
  for (std::uint64_t i = taken_ - count; i < taken_; ++i) kept.push_back(ticks_[i % ticks_.size()]);
  taken_ = 0;
  next_ = 0;
  fault_came_ = false;
  full_.store(false, std::memory_order_release);
  return kept;
}

}  // namespace thimble::session
