#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "compact_mesh/large_pages.h"
#include "mesh/parallel_split.h"
#include "search/box_node.h"

namespace thimble::render {

/// A tree of boxes over things in a row, where each node except the last of its level has eight
/// children. The nodes of the lowest level hold eight consecutive things, those above eight
/// consecutive nodes. So no child indices are stored, and a node is one cache line.
class TreeNodes {
 public:
  /// Name of a node: its level, counted from the lowest one, in the high bits above its number.
  using Name = std::uint32_t;
  static constexpr int kNumberBits = 26;                         ///< Bits of the number in a name.
  static constexpr Name kNumber = (Name{1} << kNumberBits) - 1;  ///< Mask of the number in a name.
  static constexpr std::size_t kLevelsMax = 10;                  ///< Maximum: 8^10 things.
  static constexpr std::size_t kThingsMax = std::size_t{1}
                                            << (kNumberBits + 2);  ///< Maximum number of things.

  /// Builds the tree in linear time. `box_of(place)` returns the LatticeAabb of a thing; it is
  /// called from two threads at once. Reserves memory for things that are added later (`grow`), up
  /// to `room` in all. Precondition: one to `kThingsMax` things. Real-time: never from the servo
  /// thread.
  template <class BoxOf>
  void build(std::size_t things, BoxOf box_of, std::size_t room = 0);

  /// All nodes of a tree, in the order of memory.
  using Nodes = std::vector<BoxNode, LargePages<BoxNode>>;

  /// Takes the nodes of a tree that was built without room for more things (`all`). Returns false
  /// and does nothing if they are not as many as a tree over `things` has. Real-time: never from
  /// the servo thread.
  bool restore(std::size_t things, Nodes nodes);

  /// Returns all nodes, to store them. Real-time: safe.
  std::span<const BoxNode> all() const noexcept { return nodes_; }

  /// Sets the number of things to `things`, the new ones at the end, within the room of `build`.
  /// The caller must then `refit` each of them. Real-time: safe.
  void grow(std::size_t things) noexcept {
    counts_[0] = static_cast<std::uint32_t>(things);
    for (std::size_t level = 0; level < levels_; ++level) {
      counts_[level + 1] = (counts_[level] + 7) / 8;
    }
  }

  /// Updates the tree after the box of one thing has changed, upwards as far as anything changes.
  /// The result is the tree that `build` would make. Real-time: safe.
  template <class BoxOf>
  void refit(std::size_t place, BoxOf box_of) noexcept;

  /// Returns the name of the root. Real-time: safe.
  Name root() const noexcept { return static_cast<Name>(levels_ - 1) << kNumberBits; }
  /// Returns a node. Real-time: safe.
  const BoxNode& node(Name name) const noexcept { return nodes_[place_of(name)]; }
  /// Returns whether the children of a node are things, not nodes. Real-time: safe.
  static bool lowest(Name name) noexcept { return name <= kNumber; }
  /// Returns the name of the first child of a node that is not lowest; the others follow.
  /// Real-time: safe.
  static Name first_child(Name name) noexcept {
    return (name - (Name{1} << kNumberBits)) + 7 * (name & kNumber);
  }
  /// Returns the place of the first thing of a lowest node; the others follow. Real-time: safe.
  static std::size_t first_thing(Name name) noexcept { return std::size_t{8} * name; }

  /// Returns the number of levels. Real-time: safe.
  std::size_t levels() const noexcept { return levels_; }
  /// Returns the number of nodes of a level. Real-time: safe.
  std::size_t width(std::size_t level) const noexcept { return counts_[level + 1]; }
  /// Returns the nodes of a level. Real-time: safe.
  const BoxNode* row(std::size_t level) const noexcept { return nodes_.data() + begins_[level]; }

  /// Returns the bytes of memory held.
  std::size_t bytes() const noexcept { return nodes_.capacity() * sizeof(BoxNode); }

 private:
  std::size_t place_of(Name name) const noexcept {
    return begins_[name >> kNumberBits] + (name & kNumber);
  }

  template <class BoxOf>
  BoxNode made(std::size_t level, std::size_t number, BoxOf box_of) const noexcept;

  // Sets the levels of a tree with room for `room` things. Returns the number of its nodes.
  std::size_t set_levels(std::size_t things, std::size_t room) noexcept;

  Nodes nodes_;                                     // the highest level first
  std::array<std::uint32_t, kLevelsMax> begins_{};  // begin of each level in nodes_
  std::array<std::uint32_t, kLevelsMax + 1>
      counts_{};  // number of elements of each level, things first
  std::size_t levels_ = 1;
};

template <class BoxOf>
BoxNode TreeNodes::made(std::size_t level, std::size_t number, BoxOf box_of) const noexcept {
  constexpr std::size_t kCapacity = BoxNode::kChildrenMax;
  std::array<LatticeAabb, kCapacity> boxes;
  std::size_t count = 0;
  for (std::size_t i = kCapacity * number; count < kCapacity && i < counts_[level]; ++i) {
    boxes[count++] = level == 0 ? box_of(i) : nodes_[begins_[level - 1] + i].box();
  }
  BoxNode node;
  node.set_boxes({boxes.data(), count});
  return node;
}

inline std::size_t TreeNodes::set_levels(std::size_t things, std::size_t room) noexcept {
  counts_[0] = static_cast<std::uint32_t>(things);
  std::array<std::uint32_t, kLevelsMax + 1> most{};
  most[0] = static_cast<std::uint32_t>(std::max(things, room));
  std::size_t all = 0;
  levels_ = 0;
  do {
    counts_[levels_ + 1] = (counts_[levels_] + 7) / 8;
    most[levels_ + 1] = (most[levels_] + 7) / 8;
    all += most[++levels_];
  } while (most[levels_] > 1);
  std::size_t begin = all;
  for (std::size_t level = 0; level < levels_; ++level) {
    begin -= most[level + 1];
    begins_[level] = static_cast<std::uint32_t>(begin);
  }
  return all;
}

template <class BoxOf>
void TreeNodes::build(std::size_t things, BoxOf box_of, std::size_t room) {
  nodes_.resize(set_levels(things, room));
  for (std::size_t level = 0; level < levels_; ++level) {
    parallel_split(counts_[level + 1], [this, level, &box_of](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) nodes_[begins_[level] + i] = made(level, i, box_of);
    });
  }
}

inline bool TreeNodes::restore(std::size_t things, Nodes nodes) {
  if (things == 0 || things > kThingsMax) return false;
  TreeNodes restored;
  if (restored.set_levels(things, things) != nodes.size()) return false;
  restored.nodes_ = std::move(nodes);
  *this = std::move(restored);
  return true;
}

template <class BoxOf>
void TreeNodes::refit(std::size_t place, BoxOf box_of) noexcept {
  for (std::size_t level = 0; level < levels_; ++level) {
    place /= BoxNode::kChildrenMax;
    const BoxNode node = made(level, place, box_of);
    BoxNode& old = nodes_[begins_[level] + place];
    if (node == old) return;
    old = node;
  }
}

}  // namespace thimble::render
