#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thimble::render {

/// The frames of a paged surface in the order of their last use: a ring of links, in which each
/// function takes a few ns for any number of frames.
class FrameOrder {
 public:
  /// Begins with `frames` unused frames; the lowest number is the oldest.
  explicit FrameOrder(std::size_t frames) : links_(frames + 1) {
    for (std::size_t i = 0; i <= frames; ++i) {
      links_[i] = {static_cast<std::int32_t>(i == 0 ? frames : i - 1),
                   static_cast<std::int32_t>(i == frames ? 0 : i + 1)};
    }
  }

  /// Returns the frame that was not used for the longest time. Precondition: there is a frame.
  std::int32_t oldest() const noexcept { return links_.back().newer; }

  /// Makes a frame the newest.
  void use(std::int32_t frame) noexcept {
    const auto end = static_cast<std::int32_t>(links_.size()) - 1;
    Link& own = at(frame);
    at(own.older).newer = own.newer;
    at(own.newer).older = own.older;
    own = {at(end).older, end};
    at(own.older).newer = frame;
    at(end).older = frame;
  }

 private:
  struct Link {
    std::int32_t older = 0, newer = 0;
  };
  Link& at(std::int32_t number) noexcept { return links_[static_cast<std::size_t>(number)]; }

  std::vector<Link> links_;  // the last one is between the newest and the oldest frame
};

}  // namespace thimble::render
