#include <algorithm>
#include <bit>

#include "contact/radix_sort.h"
#include "thimble/render/contact/bvh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// What leaves hold at most.
constexpr std::size_t kLeafSize = 3;

// Gives the keys of all triangles in their Morton order, and that order unless it is their own.
std::vector<std::uint64_t> morton_order(const CompactSurface& surface, const SearchFrame&,
                                        std::vector<std::int32_t>&) {
  const auto records = surface.records();
  std::vector<std::uint64_t> keys(records.size());
  for (std::size_t t = 0; t < records.size(); ++t) keys[t] = morton_key(records[t]);
  return keys;
}

std::vector<std::uint64_t> morton_order(const ContactMesh& mesh, const SearchFrame& frame,
                                        std::vector<std::int32_t>& order) {
  std::vector<KeyedIndex> items(static_cast<std::size_t>(mesh.triangle_count()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto t = static_cast<std::int32_t>(i);
    CompactTriangle rounded{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p = corner_in(frame, mesh, t, k);
      const auto whole = [](double u) noexcept {
        return static_cast<std::int32_t>(std::clamp(u, -kLatticeHalf, kLatticeHalf));
      };
      rounded.x[k] = whole(p.x());
      rounded.y[k] = whole(p.y());
      rounded.z[k] = whole(p.z());
    }
    items[i] = {morton_key(rounded), t};
  }
  radix_sort(items);
  std::vector<std::uint64_t> keys;
  for (const KeyedIndex& item : items) {
    keys.push_back(item.key);
    order.push_back(item.index);
  }
  order.shrink_to_fit();
  return keys;
}

}  // namespace

template <class Surface>
TreeSearch<Surface>::TreeSearch(const Surface& surface, bool wide)
    : surface_(&surface), frame_(frame_of(surface)), wide_(wide) {
  const auto count = static_cast<std::size_t>(surface.triangle_count());
  std::vector<std::uint64_t> keys = morton_order(surface, frame_, order_);
  // Leaves hold 2.3 triangles in the mean and nodes 6 of their children.
  nodes_.reserve(count / 8 + 16);
  nodes_.emplace_back();
  build_node(keys, {0, count}, 0);
  nodes_.shrink_to_fit();
}

// Cuts a range where the highest bit changes in which its keys differ: in the middle of space along
// one axis. Equal keys are cut in half.
template <class Surface>
auto TreeSearch<Surface>::split(const std::vector<std::uint64_t>& keys, Range range,
                                Range& second) const -> Range {
  const std::uint64_t difference = keys[range.begin] ^ keys[range.end - 1];
  std::size_t middle = (range.begin + range.end) / 2;
  if (difference != 0) {
    const std::uint64_t bit = std::bit_floor(difference);
    const auto at = [&keys](std::size_t i) {
      return keys.begin() + static_cast<std::ptrdiff_t>(i);
    };
    const auto place = std::partition_point(at(range.begin), at(range.end),
                                            [bit](std::uint64_t key) { return !(key & bit); });
    middle = static_cast<std::size_t>(place - keys.begin());
  }
  second = {middle, range.end};
  return {range.begin, middle};
}

template <class Surface>
StepBox TreeSearch<Surface>::box_of(Range places) const noexcept {
  StepBox box;
  for (std::size_t place = places.begin; place < places.end; ++place) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d p = corner_in(frame_, *surface_, triangle_at(place), k);
      box.add(p.x(), p.y(), p.z());
    }
  }
  return box;
}

template <class Surface>
StepBox TreeSearch<Surface>::build_node(const std::vector<std::uint64_t>& keys, Range range,
                                        std::uint32_t node) {
  std::array<Range, BoxNode::kChildrenMax> parts;
  std::size_t count = 1;
  parts[0] = range;
  while (count < parts.size()) {
    const auto largest = std::max_element(
        parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
        [](const Range& a, const Range& b) { return a.end - a.begin < b.end - b.begin; });
    if (largest->end - largest->begin <= kLeafSize) break;
    *largest = split(keys, *largest, parts[count]);
    ++count;
  }
  // Siblings stand together: a query that enters one often enters the next.
  std::array<std::uint32_t, BoxNode::kChildrenMax> children{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = parts[i].end - parts[i].begin;
    if (size <= kLeafSize) {
      children[i] = leaf_of(parts[i].begin, size);
    } else {
      children[i] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.emplace_back();
    }
  }
  std::array<StepBox, BoxNode::kChildrenMax> boxes;
  StepBox whole;
  for (std::size_t i = 0; i < count; ++i) {
    // May move the nodes: no reference to one is held.
    boxes[i] = (children[i] & BoxNode::kLeaf) != 0 ? box_of(parts[i])
                                                   : build_node(keys, parts[i], children[i]);
    whole.add(boxes[i]);
  }
  nodes_[node].children = children;
  nodes_[node].set_boxes({boxes.data(), count});
  return whole;
}

// All but the building stands in bvh.cpp and is instantiated there.
template TreeSearch<ContactMesh>::TreeSearch(const ContactMesh&, bool);
template auto TreeSearch<ContactMesh>::split(const std::vector<std::uint64_t>&, Range, Range&) const
    -> Range;
template StepBox TreeSearch<ContactMesh>::box_of(Range) const noexcept;
template StepBox TreeSearch<ContactMesh>::build_node(const std::vector<std::uint64_t>&, Range,
                                                     std::uint32_t);
template TreeSearch<CompactSurface>::TreeSearch(const CompactSurface&, bool);
template auto TreeSearch<CompactSurface>::split(const std::vector<std::uint64_t>&, Range,
                                                Range&) const -> Range;
template StepBox TreeSearch<CompactSurface>::box_of(Range) const noexcept;
template StepBox TreeSearch<CompactSurface>::build_node(const std::vector<std::uint64_t>&, Range,
                                                        std::uint32_t);

}  // namespace thimble::render
