#include "transports/frame_finder.h"

#include <algorithm>

namespace thimble::driver {

FrameFinder::FrameFinder(const Framing& framing) noexcept : framing_(framing) {
  framing_.size_max = std::min(framing_.size_max, kReportCapacity);
}

void FrameFinder::push(std::span<const std::byte> bytes) noexcept {
  for (const std::byte byte : bytes) {
    if (byte == framing_.begin) {
      // A message inside a message: the end of the first was lost.
      if (growing_size_ > 0) ++torn_;
      growing_[0] = byte;
      growing_size_ = 1;
      continue;
    }
    if (growing_size_ == 0) continue;
    if (growing_size_ >= framing_.size_max) {
      ++torn_;
      growing_size_ = 0;
      continue;
    }
    growing_[growing_size_++] = byte;
    if (byte == framing_.end) {
      std::copy_n(growing_.begin(), growing_size_, newest_.begin());
      newest_size_ = growing_size_;
      growing_size_ = 0;
      ++ready_;
      ++found_;
    }
  }
}

std::size_t FrameFinder::take(std::span<std::byte> buffer, std::uint32_t& skipped) noexcept {
  if (ready_ == 0) return 0;
  skipped = ready_ - 1;
  ready_ = 0;
  const std::size_t size = std::min(newest_size_, buffer.size());
  std::copy_n(newest_.begin(), size, buffer.begin());
  return size;
}

}  // namespace thimble::driver
