#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "body/spring/spring_network.h"

namespace thimble::render {

/// Collects the nodes within k springs of some first ones: the patch around the touched triangle
/// that is let move [BP 4.2: only in the general surrounding area of the cursor].
class RingPatch {
 public:
  /// Sets memory aside for meshes of `nodes` nodes and patches of up to `capacity`. Real-time:
  /// never from the servo thread.
  RingPatch(std::int32_t nodes, std::size_t capacity)
      : seen_in_(static_cast<std::size_t>(nodes), 0), capacity_(capacity) {
    patch_.reserve(capacity);
  }

  /// Collects `first` (nodes that exist) and what lies within `rings` springs of it, nearest
  /// first; stops where the capacity ends. Valid until the next call. Real-time: safe; bounded by
  /// the capacity times the valence.
  template <int kDof>
  std::span<const std::int32_t> around(const SpringNetwork<kDof>& network,
                                       std::span<const std::int32_t> first, int rings) noexcept {
    ++round_;
    patch_.clear();
    for (const std::int32_t node : first) add(node);
    std::size_t begin = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const std::size_t end = patch_.size();
      for (; begin < end; ++begin) {
        for (const std::int32_t node : network.neighbours(patch_[begin])) add(node);
      }
    }
    return patch_;
  }

 private:
  void add(std::int32_t node) noexcept {
    std::uint64_t& seen = seen_in_[static_cast<std::size_t>(node)];
    if (seen == round_ || patch_.size() == capacity_) return;
    seen = round_;
    patch_.push_back(node);
  }

  std::vector<std::uint64_t> seen_in_;
  std::vector<std::int32_t> patch_;
  std::size_t capacity_;
  std::uint64_t round_ = 0;
};

}  // namespace thimble::render
