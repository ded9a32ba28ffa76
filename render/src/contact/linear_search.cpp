#include "thimble/render/contact/linear_search.h"

#include <cmath>
#include <limits>

#include "thimble/render/mesh/segment_crossing.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Triangles looked at between two branches: several vectors of any width, and few enough that a hit
// costs little to find again.
constexpr std::size_t kBlock = 32;

bool within_range(const Vector3d& p) noexcept {
  return std::abs(p.x()) <= kPositionMax && std::abs(p.y()) <= kPositionMax &&
         std::abs(p.z()) <= kPositionMax;
}

}  // namespace

LinearSearch::LinearSearch(const ContactMesh& mesh) : mesh_(&mesh) {
  const auto count = static_cast<std::size_t>(mesh.triangle_count());
  const std::size_t padded = (count + kBlock - 1) / kBlock * kBlock;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (auto* side : {&min_x_, &min_y_, &min_z_}) side->assign(padded, kInfinity);
  for (auto* side : {&max_x_, &max_y_, &max_z_}) side->assign(padded, -kInfinity);
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = static_cast<std::int32_t>(i);
    const Vector3d& a = mesh.position(t, 0);
    const Vector3d& b = mesh.position(t, 1);
    const Vector3d& c = mesh.position(t, 2);
    const Vector3f low = (a.cwiseMin(b).cwiseMin(c) - mesh.origin()).cast<float>();
    const Vector3f high = (a.cwiseMax(b).cwiseMax(c) - mesh.origin()).cast<float>();
    min_x_[i] = low.x();
    min_y_[i] = low.y();
    min_z_[i] = low.z();
    max_x_[i] = high.x();
    max_y_[i] = high.y();
    max_z_[i] = high.z();
  }
}

template <class Visit>
void LinearSearch::visit_reached(const Vector3d& p_from, const Vector3d& p_to,
                                 Visit visit) const noexcept {
  const Vector3f low = (p_from.cwiseMin(p_to) - mesh_->origin()).cast<float>();
  const Vector3f high = (p_from.cwiseMax(p_to) - mesh_->origin()).cast<float>();
  const float low_x = low.x(), low_y = low.y(), low_z = low.z();
  const float high_x = high.x(), high_y = high.y(), high_z = high.z();
  for (std::size_t block = 0; block < min_x_.size(); block += kBlock) {
    const float* const min_x = min_x_.data() + block;
    const float* const min_y = min_y_.data() + block;
    const float* const min_z = min_z_.data() + block;
    const float* const max_x = max_x_.data() + block;
    const float* const max_y = max_y_.data() + block;
    const float* const max_z = max_z_.data() + block;
    int reached[kBlock];
    int any = 0;
    for (std::size_t i = 0; i < kBlock; ++i) {
      // Bitwise, so that nothing branches and the loop becomes vector code.
      reached[i] = static_cast<int>(min_x[i] <= high_x) & static_cast<int>(max_x[i] >= low_x) &
                   static_cast<int>(min_y[i] <= high_y) & static_cast<int>(max_y[i] >= low_y) &
                   static_cast<int>(min_z[i] <= high_z) & static_cast<int>(max_z[i] >= low_z);
      any |= reached[i];
    }
    if (any == 0) continue;
    for (std::size_t i = 0; i < kBlock; ++i) {
      if (reached[i] == 0) continue;
      const auto t = static_cast<std::int32_t>(block + i);
      visit(t, crossing(p_from, p_to, mesh_->position(t, 0), mesh_->position(t, 1),
                        mesh_->position(t, 2)));
    }
  }
}

Entry LinearSearch::first_entry(const Vector3d& p_from, const Vector3d& p_to) const noexcept {
  Entry first;
  if (!within_range(p_from) || !within_range(p_to)) return first;
  visit_reached(p_from, p_to, [&](std::int32_t t, Crossing way) noexcept {
    if (way != Crossing::kEnters) return;
    const double above = -mesh_->depth(t, p_from);
    const double below = mesh_->depth(t, p_to);
    // Rounding may make either end seem to lie on the other side: such an entry is at that end.
    double parameter = 0;
    if (above > 0) parameter = below > 0 ? above / (above + below) : 1;
    if (first.triangle < 0 || parameter < first.parameter) first = {t, parameter};
  });
  return first;
}

bool LinearSearch::inside(const Vector3d& p_W) const noexcept {
  if (!within_range(p_W)) return false;
  const bool in_box = (p_W.array() >= mesh_->box_min().array()).all() &&
                      (p_W.array() <= mesh_->box_max().array()).all();
  if (!in_box) return false;
  // Along an axis, so that the boxes drop all but the triangles in the way.
  Vector3d p_far = p_W;
  p_far.x() = mesh_->box_max().x() + (mesh_->box_max() - mesh_->box_min()).norm();
  unsigned crossings = 0;
  visit_reached(p_W, p_far, [&crossings](std::int32_t, Crossing way) noexcept {
    crossings += way != Crossing::kNone;
  });
  return crossings % 2 == 1;
}

}  // namespace thimble::render
