#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/render/contact/bvh.h"

namespace thimble::render {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr std::size_t kPlaces = BoxNode::kChildrenMax;

std::size_t children_of(const BoxNode& node) noexcept {
  std::size_t count = 0;
  while (count < kPlaces && node.children[count] != 0) ++count;
  return count;
}

StepBox around(std::span<const StepBox> boxes) noexcept {
  StepBox box;
  for (const StepBox& other : boxes) box.add(other);
  return box;
}

}  // namespace

template <class Surface>
void TreeSearch<Surface>::keep_parents() {
  parents_.assign(nodes_.size(), kNone);
  leaves_.assign(static_cast<std::size_t>(surface_->triangle_count()), kNone);
  boxes_.assign(kPlaces * nodes_.size(), StepBox());
  // Children have higher numbers than the node above them.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    for (std::size_t i = 0; i < children_of(nodes_[n]); ++i) {
      const std::uint32_t child = nodes_[n].children[i];
      const std::size_t at = kPlaces * n + i;
      if ((child & BoxNode::kLeaf) == 0) {
        parents_[child] = static_cast<std::uint32_t>(at);
        boxes_[at] = around({&boxes_[kPlaces * child], children_of(nodes_[child])});
        continue;
      }
      boxes_[at] = box_of({first_place(child), end_place(child)});
      for (std::size_t place = first_place(child); place < end_place(child); ++place) {
        leaves_[static_cast<std::size_t>(triangle_at(place))] = static_cast<std::uint32_t>(at);
      }
    }
  }
}

template <class Surface>
bool TreeSearch<Surface>::refit(std::span<const std::int32_t> triangles) noexcept {
  if (leaves_.empty()) return false;
  for (const std::int32_t t : triangles) {
    std::size_t at = leaves_[static_cast<std::size_t>(t)];
    const std::uint32_t leaf = nodes_[at / kPlaces].children[at % kPlaces];
    StepBox box = box_of({first_place(leaf), end_place(leaf)});
    // Upwards as far as anything changes.
    while (box.min != boxes_[at].min || box.max != boxes_[at].max) {
      boxes_[at] = box;
      const std::size_t node = at / kPlaces;
      const std::span<const StepBox> all{&boxes_[kPlaces * node], children_of(nodes_[node])};
      nodes_[node].set_boxes(all);
      if (parents_[node] == kNone) break;
      at = parents_[node];
      box = around(all);
    }
  }
  return true;
}

template void TreeSearch<ContactMesh>::keep_parents();
template bool TreeSearch<ContactMesh>::refit(std::span<const std::int32_t>) noexcept;
template void TreeSearch<CompactSurface>::keep_parents();
template bool TreeSearch<CompactSurface>::refit(std::span<const std::int32_t>) noexcept;

}  // namespace thimble::render
