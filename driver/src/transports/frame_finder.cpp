#include "transports/frame_finder.h"

#include <algorithm>

#include "wires/slip.h"
#include "wires/wire_table.h"

namespace thimble::driver {

FrameFinder::FrameFinder(const Framing& framing) noexcept : framing_(framing) {
  framing_.size_max = std::min(framing_.size_max, kReportCapacity);
}

void FrameFinder::push(std::span<const std::byte> bytes) noexcept {
  if (framing_.described != nullptr) return push_described(bytes);
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
    if (byte == framing_.end) emit();
  }
}

/// Makes the first bytes of the growing message the newest message.
void FrameFinder::keep(std::size_t size) noexcept {
  std::copy_n(growing_.begin(), size, newest_.begin());
  newest_size_ = size;
  ++ready_;
  ++found_;
}

/// Removes the first bytes of the growing message.
void FrameFinder::drop(std::size_t size) noexcept {
  std::copy(growing_.begin() + static_cast<std::ptrdiff_t>(size),
            growing_.begin() + static_cast<std::ptrdiff_t>(growing_size_), growing_.begin());
  growing_size_ -= size;
}

void FrameFinder::emit() noexcept {
  keep(growing_size_);
  growing_size_ = 0;
}

void FrameFinder::forget_partial() noexcept {
  if (framing_.described == nullptr || framing_.described->framing != WireFraming::kFixed) return;
  if (growing_size_ > 0) ++torn_;
  growing_size_ = 0;
}

void FrameFinder::push_described(std::span<const std::byte> bytes) noexcept {
  switch (framing_.described->framing) {
    case WireFraming::kText:
    case WireFraming::kCobs:
    case WireFraming::kSlip:
      for (const std::byte byte : bytes) take_text(byte);
      break;
    case WireFraming::kLength:
      for (const std::byte byte : bytes) take_measured(byte);
      break;
    case WireFraming::kFixed:
    case WireFraming::kHeader:
      for (const std::byte byte : bytes) take_block(byte);
      break;
  }
}

/// Takes a byte of messages that end with a mark: texts, COBS and SLIP.
void FrameFinder::take_text(std::byte byte) noexcept {
  const WireLayout& layout = *framing_.described;
  const bool text = layout.framing == WireFraming::kText;
  const auto begin = text ? layout.begin.span() : std::span<const std::byte>();
  if (begin.size() == 1 && byte == begin[0]) {
    // A message inside a message: the end of the first was lost.
    if (growing_size_ > 0) ++torn_;
    growing_[0] = byte;
    growing_size_ = 1;
    joined_ = true;
    return;
  }
  if (begin.size() == 1 && growing_size_ == 0) return;
  if (growing_size_ >= growing_.size()) {
    ++torn_;
    growing_size_ = 0;
    joined_ = false;
  }
  growing_[growing_size_++] = byte;
  const auto end = text ? layout.end_of_text() : std::span<const std::byte>();
  const auto grown = std::span<const std::byte>(growing_).first(growing_size_);
  const bool ended = text
                         ? grown.size() >= end.size() &&
                               std::equal(end.begin(), end.end(),
                                          grown.end() - static_cast<std::ptrdiff_t>(end.size()))
                         : byte == (layout.framing == WireFraming::kSlip ? kSlipEnd : std::byte{0});
  if (!ended) return;
  // The first message may have lost its beginning before the port was opened. A part of a number is
  // a number too, so it is not used.
  const bool whole = joined_ && grown.size() > (text ? 0u : 1u);
  joined_ = true;
  // The first byte of COBS is no content. The marks to ignore contain no bytes that are stuffed, so
  // they are unchanged.
  const auto content = layout.framing == WireFraming::kCobs ? grown.subspan(1) : grown;
  if (whole && !(layout.ignore.size > 0 && starts_with(content, layout.ignore.span()))) {
    emit();
  }
  growing_size_ = 0;
}

/// Takes a byte of messages of a fixed size.
void FrameFinder::take_block(std::byte byte) noexcept {
  const WireLayout& layout = *framing_.described;
  const auto begin = layout.begin.span();
  growing_[growing_size_++] = byte;
  const auto fits = [&](std::size_t from) noexcept {
    for (std::size_t i = 0; i < begin.size() && from + i < growing_size_; ++i) {
      if (growing_[from + i] != begin[i]) return false;
    }
    return true;
  };
  const bool complete = growing_size_ >= layout.size;
  if (fits(0) && !complete) return;
  // Without marks, every message of the right size is used; decoding decides.
  if (complete &&
      (layout.framing == WireFraming::kFixed || layout.is_sound({growing_.data(), growing_size_})))
    return emit();
  // The first byte is not that of a message. The message may begin within the bytes that follow.
  if (complete) ++torn_;
  std::size_t from = 1;
  while (from < growing_size_ && !fits(from)) ++from;
  drop(from);
}

/// Takes a byte of messages with a length. Behind a false beginning, several messages may wait.
void FrameFinder::take_measured(std::byte byte) noexcept {
  const WireLayout& layout = *framing_.described;
  const auto begin = layout.begin.span();
  growing_[growing_size_++] = byte;
  // Each round removes a byte or ends. A message is at most kWireSizeMax long, so there is room for
  // the next byte.
  while (growing_size_ > 0) {
    const auto grown = std::span<const std::byte>(growing_).first(growing_size_);
    const std::size_t known = std::min(begin.size(), grown.size());
    if (!std::equal(grown.begin(), grown.begin() + static_cast<std::ptrdiff_t>(known),
                    begin.begin())) {
      drop(1);
      continue;
    }
    if (grown.size() <= layout.length_at) return;
    const std::size_t length = layout.length_of(grown);
    if (length > grown.size()) return;
    if (length == 0 || !layout.is_sound(grown.first(length))) {
      ++torn_;
      drop(1);
      continue;
    }
    // Shorter messages, and those to ignore, are no reports.
    const auto content = grown.subspan(layout.length_at + 1);
    if (length >= layout.size &&
        !(layout.ignore.size > 0 && starts_with(content, layout.ignore.span()))) {
      keep(length);
    }
    drop(length);
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
