#include "body/shape/surface_patch.h"

#include <algorithm>

namespace thimble::render {

SurfacePatch::SurfacePatch(std::span<const Eigen::Vector3d> first_places, std::size_t capacity,
                           std::size_t vertices_max)
    : first_places_(first_places), capacity_(capacity) {
  seen_in_.reserve(std::max(first_places.size(), vertices_max));
  seen_in_.resize(first_places.size(), 0);
  patch_.reserve(capacity);
}

std::span<const std::int32_t> SurfacePatch::around(const ContactMesh& mesh, std::int32_t triangle,
                                                   const Eigen::Vector3d& place,
                                                   double radius) noexcept {
  if (++round_ == 0) {
    // The counter has overflowed: clear the marks, once in 2^32 rounds.
    std::fill(seen_in_.begin(), seen_in_.end(), 0);
    round_ = 1;
  }
  patch_.clear();
  const auto add = [&](std::int32_t vertex, bool near) {
    std::uint32_t& seen = seen_in_[static_cast<std::size_t>(vertex)];
    if (seen == round_ || patch_.size() == capacity_) return;
    seen = round_;
    if (near) patch_.push_back(vertex);
  };
  for (const std::int32_t vertex : mesh.corners(triangle)) add(vertex, true);
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    for (const std::int32_t t : mesh.fan(patch_[i])) {
      for (const std::int32_t vertex : mesh.corners(t)) {
        const auto v = static_cast<std::size_t>(vertex);
        if (seen_in_[v] == round_) continue;
        add(vertex, (first_places_[v] - place).squaredNorm() < radius * radius);
      }
    }
  }
  return patch_;
}

}  // namespace thimble::render
