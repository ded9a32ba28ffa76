#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "contact/bvh_box.h"
#include "contact/bvh_leaf.h"
#include "contact/radix_sort.h"
#include "thimble/render/contact/bvh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

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
TreeSearch<Surface>::TreeSearch(const Surface& surface)
    : surface_(&surface), frame_(frame_of(surface)) {
  const auto count = static_cast<std::size_t>(surface.triangle_count());
  std::vector<std::uint64_t> keys = morton_order(surface, frame_, order_);
  // Leaves hold 2.5 triangles in the mean and nodes 3 of their children.
  nodes_.reserve(count / 6 + 16);
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
auto TreeSearch<Surface>::build_node(const std::vector<std::uint64_t>& keys, Range range,
                                     std::uint32_t node) -> Box {
  std::array<Range, 4> parts;
  std::size_t count = 1;
  parts[0] = range;
  while (count < 4) {
    const auto largest = std::max_element(
        parts.begin(), parts.begin() + count,
        [](const Range& a, const Range& b) { return a.end - a.begin < b.end - b.begin; });
    if (largest->end - largest->begin <= kLeafMax) break;
    *largest = split(keys, *largest, parts[count]);
    ++count;
  }
  // Siblings stand together: a query that enters one often enters the next.
  std::array<std::uint32_t, 4> children{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = parts[i].end - parts[i].begin;
    if (size <= kLeafMax) {
      children[i] = kLeaf | static_cast<std::uint32_t>(parts[i].begin << 2) |
                    static_cast<std::uint32_t>(size - 1);
    } else {
      children[i] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.emplace_back();
    }
  }
  Box whole;
  for (std::size_t i = 0; i < 4; ++i) {
    Box box;
    if (i < count && (children[i] & kLeaf) != 0) {
      for (std::size_t place = parts[i].begin; place < parts[i].end; ++place) {
        for (std::size_t k = 0; k < 3; ++k) {
          box.add(corner_in(frame_, *surface_, triangle_at(place), k));
        }
      }
    } else if (i < count) {
      // May move the nodes: no reference to one is held.
      box = build_node(keys, parts[i], children[i]);
    }
    Node& n = nodes_[node];
    if (i >= count) {
      // No segment and no ball reaches it.
      for (auto* side : {&n.min_x, &n.min_y, &n.min_z}) (*side)[i] = INFINITY;
      for (auto* side : {&n.max_x, &n.max_y, &n.max_z}) (*side)[i] = -INFINITY;
      continue;
    }
    n.min_x[i] = rounded_down(box.min[0]);
    n.min_y[i] = rounded_down(box.min[1]);
    n.min_z[i] = rounded_down(box.min[2]);
    n.max_x[i] = rounded_up(box.max[0]);
    n.max_y[i] = rounded_up(box.max[1]);
    n.max_z[i] = rounded_up(box.max[2]);
    n.children[i] = children[i];
    whole.add(box);
  }
  return whole;
}

// All but the building stands in bvh.cpp and is instantiated there.
template TreeSearch<ContactMesh>::TreeSearch(const ContactMesh&);
template auto TreeSearch<ContactMesh>::split(const std::vector<std::uint64_t>&, Range, Range&) const
    -> Range;
template auto TreeSearch<ContactMesh>::build_node(const std::vector<std::uint64_t>&, Range,
                                                  std::uint32_t) -> Box;
template TreeSearch<CompactSurface>::TreeSearch(const CompactSurface&);
template auto TreeSearch<CompactSurface>::split(const std::vector<std::uint64_t>&, Range,
                                                Range&) const -> Range;
template auto TreeSearch<CompactSurface>::build_node(const std::vector<std::uint64_t>&, Range,
                                                     std::uint32_t) -> Box;

}  // namespace thimble::render
