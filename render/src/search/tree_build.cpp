#include <utility>

#include "compact_mesh/block_order.h"
#include "mesh/parallel_split.h"
#include "search/tree_search.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Returns the spatial order of the triangles, in which eight consecutive ones are neighbours; empty
// if they are already in this order.
std::vector<std::int32_t> order_of(const PackedSurface&, const SearchFrame&) {
  return {};
}

std::vector<std::int32_t> order_of(const ContactMesh& mesh, const SearchFrame& frame) {
  std::vector<PlacedIndex> items(static_cast<std::size_t>(mesh.triangle_count()));
  parallel_split(items.size(), [&](std::size_t begin, std::size_t end) noexcept {
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<std::int32_t>(i);
      const Eigen::Vector3f middle = (corner_in(frame, mesh, t, 0) + corner_in(frame, mesh, t, 1) +
                                      corner_in(frame, mesh, t, 2))
                                         .cast<float>();
      items[i] = {{middle.x(), middle.y(), middle.z()}, t};
    }
  });
  order_in_blocks(items);
  std::vector<std::int32_t> order;
  order.reserve(items.size());
  for (const PlacedIndex& item : items) order.push_back(item.index);
  return order;
}

}  // namespace

template <class Surface>
TreeSearch<Surface>::TreeSearch(const Surface& surface, bool wide)
    : surface_(&surface),
      frame_(frame_of(surface)),
      wide_(wide),
      order_(order_of(surface, frame_)) {
  const auto count = static_cast<std::size_t>(surface.triangle_count());
  nodes_.build(
      count, [this](std::size_t place) noexcept { return box_of(place); }, room_of(surface));
}

template <class Surface>
TreeSearch<Surface>::TreeSearch(const Surface& surface, TreeNodes nodes, bool wide)
    : surface_(&surface),
      frame_(frame_of(surface)),
      wide_(wide),
      order_(order_of(surface, frame_)),
      nodes_(std::move(nodes)) {}

template <class Surface>
LatticeAabb TreeSearch<Surface>::box_of(std::size_t place) const noexcept {
  LatticeAabb box;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d p = corner_in(frame_, *surface_, triangle_at(place), k);
    box.add(p.x(), p.y(), p.z());
  }
  return box;
}

// All functions but the constructor are in tree_search.cpp and instantiated there.
template TreeSearch<ContactMesh>::TreeSearch(const ContactMesh&, bool);
template LatticeAabb TreeSearch<ContactMesh>::box_of(std::size_t) const noexcept;
template TreeSearch<PackedSurface>::TreeSearch(const PackedSurface&, bool);
template TreeSearch<PackedSurface>::TreeSearch(const PackedSurface&, TreeNodes, bool);
template LatticeAabb TreeSearch<PackedSurface>::box_of(std::size_t) const noexcept;

}  // namespace thimble::render
