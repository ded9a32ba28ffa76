#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "search/tree_nodes.h"

namespace thimble::render {

/// A part of a tree that a query still has to examine.
struct Waiting {
  TreeNodes::Name node;
  float near;  ///< Parameter of the segment, or squared distance in steps.
};

/// Stack of the parts that a query still has to examine. All is Real-time: safe.
class NodeStack {
 public:
  void push(const Waiting& part) noexcept {
    if (size_ < kStackMax) items_[size_++] = part;
  }
  bool empty() const noexcept { return size_ == 0; }
  Waiting pop() noexcept { return items_[--size_]; }

 private:
  // A path from the root leaves at most seven others waiting on each level.
  static constexpr std::size_t kStackMax = (BoxNode::kChildrenMax - 1) * TreeNodes::kLevelsMax;
  // Not initialised: it is larger than the data that most queries read.
  std::array<Waiting, kStackMax> items_;
  std::size_t size_ = 0;
};

}  // namespace thimble::render
