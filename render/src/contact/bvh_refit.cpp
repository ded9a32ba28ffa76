#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "contact/bvh_box.h"
#include "contact/bvh_leaf.h"
#include "thimble/render/contact/bvh.h"

namespace thimble::render {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

std::uint32_t place_in(std::uint32_t node, std::size_t child) noexcept {
  return node << 2 | static_cast<std::uint32_t>(child);
}

}  // namespace

template <class Surface>
void TreeSearch<Surface>::keep_parents() {
  parents_.assign(nodes_.size(), kNone);
  leaves_.assign(static_cast<std::size_t>(surface_->triangle_count()), kNone);
  for (std::size_t n = 0; n < nodes_.size(); ++n) note_parents(static_cast<std::uint32_t>(n));
}

template <class Surface>
void TreeSearch<Surface>::note_parents(std::uint32_t node) {
  const Node& n = nodes_[node];
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(n.min_x[i] <= n.max_x[i])) continue;  // empty
    if ((n.children[i] & kLeaf) == 0) {
      parents_[n.children[i]] = place_in(node, i);
      continue;
    }
    for (const std::int32_t t : leaf_at(n.children[i]).list()) {
      leaves_[static_cast<std::size_t>(t)] = place_in(node, i);
    }
  }
}

// Gives a child its box; tells whether that is another one.
template <class Surface>
bool TreeSearch<Surface>::fit_box(std::uint32_t node, std::size_t child, const Box& box) noexcept {
  Node& n = nodes_[node];
  bool changed = false;
  const auto set = [&changed, child](std::array<float, 4>& sides, float v) noexcept {
    changed |= sides[child] != v;
    sides[child] = v;
  };
  set(n.min_x, rounded_down(box.min[0]));
  set(n.min_y, rounded_down(box.min[1]));
  set(n.min_z, rounded_down(box.min[2]));
  set(n.max_x, rounded_up(box.max[0]));
  set(n.max_y, rounded_up(box.max[1]));
  set(n.max_z, rounded_up(box.max[2]));
  return changed;
}

template <class Surface>
bool TreeSearch<Surface>::refit(std::span<const std::int32_t> triangles) noexcept {
  if (leaves_.empty()) return false;
  for (const std::int32_t t : triangles) {
    std::uint32_t place = leaves_[static_cast<std::size_t>(t)];
    Box box;
    for (const std::int32_t other : leaf_at(nodes_[place >> 2].children[place & 3]).list()) {
      for (std::size_t k = 0; k < 3; ++k) box.add(corner_in(frame_, *surface_, other, k));
    }
    // Upwards as far as anything changes; rounding outwards once or at each level is the same.
    while (fit_box(place >> 2, place & 3, box)) {
      const Node& n = nodes_[place >> 2];
      place = parents_[place >> 2];
      if (place == kNone) break;
      const auto least = [](const std::array<float, 4>& v) noexcept {
        return static_cast<double>(std::min(std::min(v[0], v[1]), std::min(v[2], v[3])));
      };
      const auto most = [](const std::array<float, 4>& v) noexcept {
        return static_cast<double>(std::max(std::max(v[0], v[1]), std::max(v[2], v[3])));
      };
      box.min = {least(n.min_x), least(n.min_y), least(n.min_z)};
      box.max = {most(n.max_x), most(n.max_y), most(n.max_z)};
    }
  }
  return true;
}

template void TreeSearch<ContactMesh>::keep_parents();
template void TreeSearch<ContactMesh>::note_parents(std::uint32_t);
template bool TreeSearch<ContactMesh>::fit_box(std::uint32_t, std::size_t, const Box&) noexcept;
template bool TreeSearch<ContactMesh>::refit(std::span<const std::int32_t>) noexcept;
template void TreeSearch<CompactSurface>::keep_parents();
template void TreeSearch<CompactSurface>::note_parents(std::uint32_t);
template bool TreeSearch<CompactSurface>::fit_box(std::uint32_t, std::size_t, const Box&) noexcept;
template bool TreeSearch<CompactSurface>::refit(std::span<const std::int32_t>) noexcept;

}  // namespace thimble::render
