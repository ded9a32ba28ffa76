#include "observers/trace.h"

#include <algorithm>

#include "prefetch_to_write.h"

namespace thimble::session {

Trace::Trace(std::uint64_t expected_ticks, std::size_t rows_max) {
  const std::uint64_t room = std::max<std::uint64_t>(rows_max, 1);
  if (expected_ticks == 0) {
    rows_.resize(room);
    return;
  }
  stride_ = (expected_ticks + room - 1) / room;
  rows_.resize((expected_ticks + stride_ - 1) / stride_);
}

void Trace::take(const driver::TickRecord& record) noexcept {
  if (until_next_ > 0) {
    --until_next_;
    return;
  }
  until_next_ = stride_ - 1;
  if (kept_ < rows_.size()) {
    rows_[kept_++] = record;
    if (kept_ < rows_.size()) prefetch_to_write(rows_[kept_]);
  } else {
    ++dropped_;
  }
}

}  // namespace thimble::session
