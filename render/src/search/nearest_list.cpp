#include "search/nearest_list.h"

#include "compact_mesh/wide_lanes.h"
#include "search/lanes.h"

namespace thimble::render {
namespace {

template <class Surface>
void consider_any(const Surface& surface, const SearchFrame& frame,
                  std::span<const std::int32_t> list, const Eigen::Vector3d& p,
                  NearestSoFar& best) noexcept {
  if (wide_lanes()) {
    lanes_avx2::consider_list(surface, frame, list, p.data(), best);
  } else {
    lanes_plain::consider_list(surface, frame, list, p.data(), best);
  }
}

}  // namespace

void consider(const PackedSurface& surface, const SearchFrame& frame,
              std::span<const std::int32_t> list, const Eigen::Vector3d& p,
              NearestSoFar& best) noexcept {
  consider_any(surface, frame, list, p, best);
}

void consider(const ContactMesh& mesh, const SearchFrame& frame, std::span<const std::int32_t> list,
              const Eigen::Vector3d& p, NearestSoFar& best) noexcept {
  consider_any(mesh, frame, list, p, best);
}

}  // namespace thimble::render
