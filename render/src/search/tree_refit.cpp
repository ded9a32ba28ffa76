#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "search/tree_search.h"

namespace thimble::render {

template <class Surface>
void TreeSearch<Surface>::keep_places() {
  order_.reserve(order_.empty() ? 0 : room_of(*surface_));
  places_.reserve(room_of(*surface_));
  places_.resize(static_cast<std::size_t>(surface_->triangle_count()));
  for (std::size_t place = 0; place < places_.size(); ++place) {
    places_[static_cast<std::size_t>(triangle_at(place))] = static_cast<std::uint32_t>(place);
  }
}

template <class Surface>
bool TreeSearch<Surface>::refit(std::span<const std::int32_t> triangles) noexcept {
  if (places_.empty()) return false;
  // Neighbours are in the same eights, each of which is rebuilt once. Of those with the same last
  // digits one is remembered; another is rebuilt again.
  constexpr std::size_t kRemembered = 32;
  std::array<std::uint32_t, kRemembered> done;
  done.fill(0xffffffffu);
  // New triangles are at the end, those of one print together.
  while (places_.size() < static_cast<std::size_t>(surface_->triangle_count())) {
    if (!order_.empty()) order_.push_back(static_cast<std::int32_t>(places_.size()));
    places_.push_back(static_cast<std::uint32_t>(places_.size()));
  }
  nodes_.grow(places_.size());
  for (const std::int32_t t : triangles) {
    const std::uint32_t eight =
        places_[static_cast<std::size_t>(t)] / static_cast<std::uint32_t>(BoxNode::kChildrenMax);
    if (done[eight % kRemembered] == eight) continue;
    done[eight % kRemembered] = eight;
    nodes_.refit(places_[static_cast<std::size_t>(t)],
                 [this](std::size_t place) noexcept { return box_of(place); });
  }
  return true;
}

template void TreeSearch<ContactMesh>::keep_places();
template bool TreeSearch<ContactMesh>::refit(std::span<const std::int32_t>) noexcept;
template void TreeSearch<PackedSurface>::keep_places();
template bool TreeSearch<PackedSurface>::refit(std::span<const std::int32_t>) noexcept;

}  // namespace thimble::render
