#include "search/baseline/linear_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "search/mesh_segment_test.h"
#include "search/search_answers.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Triangles tested between two branches: several vectors of any width, and few enough that a hit is
// found again cheaply.
constexpr std::size_t kBlock = 32;

}  // namespace

template <class Surface>
LinearSearchOver<Surface>::LinearSearchOver(const Surface& surface)
    : surface_(&surface), frame_(frame_of(surface)) {
  const auto count = static_cast<std::size_t>(surface.triangle_count());
  const auto padded = [](std::size_t triangles) {
    return (triangles + kBlock - 1) / kBlock * kBlock;
  };
  for (auto* side : {&min_x_, &min_y_, &min_z_, &max_x_, &max_y_, &max_z_}) {
    side->reserve(padded(room_of(surface)));
  }
  pad(padded(count));
  for (std::int32_t t = 0; t < surface.triangle_count(); ++t) fit_box(t);
}

// Resizes to this number of boxes; new ones are empty.
template <class Surface>
void LinearSearchOver<Surface>::pad(std::size_t boxes) noexcept {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (auto* side : {&min_x_, &min_y_, &min_z_}) side->resize(boxes, kInfinity);
  for (auto* side : {&max_x_, &max_y_, &max_z_}) side->resize(boxes, -kInfinity);
}

template <class Surface>
void LinearSearchOver<Surface>::fit_box(std::int32_t triangle) noexcept {
  const Vector3d a = corner_in(frame_, *surface_, triangle, 0);
  const Vector3d b = corner_in(frame_, *surface_, triangle, 1);
  const Vector3d c = corner_in(frame_, *surface_, triangle, 2);
  const Vector3f low = a.cwiseMin(b).cwiseMin(c).template cast<float>();
  const Vector3f high = a.cwiseMax(b).cwiseMax(c).template cast<float>();
  const auto i = static_cast<std::size_t>(triangle);
  min_x_[i] = low.x();
  min_y_[i] = low.y();
  min_z_[i] = low.z();
  max_x_[i] = high.x();
  max_y_[i] = high.y();
  max_z_[i] = high.z();
}

template <class Surface>
bool LinearSearchOver<Surface>::refit(std::span<const std::int32_t> triangles) noexcept {
  while (min_x_.size() < static_cast<std::size_t>(surface_->triangle_count())) {
    pad(min_x_.size() + kBlock);
  }
  for (const std::int32_t t : triangles) fit_box(t);
  return true;
}

template <class Surface>
template <class Visit>
void LinearSearchOver<Surface>::visit_reached(const Vector3d& low, const Vector3d& high,
                                              Visit visit) const noexcept {
  const Vector3f low_f = low.cast<float>();
  const Vector3f high_f = high.cast<float>();
  const float low_x = low_f.x(), low_y = low_f.y(), low_z = low_f.z();
  const float high_x = high_f.x(), high_y = high_f.y(), high_z = high_f.z();
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
      // Bitwise, so that there is no branch and the loop is vectorised.
      reached[i] = static_cast<int>(min_x[i] <= high_x) & static_cast<int>(max_x[i] >= low_x) &
                   static_cast<int>(min_y[i] <= high_y) & static_cast<int>(max_y[i] >= low_y) &
                   static_cast<int>(min_z[i] <= high_z) & static_cast<int>(max_z[i] >= low_z);
      any |= reached[i];
    }
    if (any == 0) continue;
    for (std::size_t i = 0; i < kBlock; ++i) {
      if (reached[i] != 0) visit(static_cast<std::int32_t>(block + i));
    }
  }
}

template <class Surface>
Entry LinearSearchOver<Surface>::first_entry(const Vector3d& p_from,
                                             const Vector3d& p_to) const noexcept {
  if (!within_range(p_from) || !within_range(p_to)) return {};
  const auto segment = segment_test(*surface_, frame_, p_from, p_to);
  const auto sieve = sieve_of(segment);
  FirstEntry first(segment);
  visit_reached(segment.low(), segment.high(), [&](std::int32_t reached) noexcept {
    visit_near(sieve, {&reached, 1}, [&](std::int32_t t) noexcept { first.consider(t); });
  });
  return first.entry();
}

template <class Surface>
bool LinearSearchOver<Surface>::inside(const Vector3d& p_W) const noexcept {
  if (!within_range(p_W) || !in_frame(frame_.to_steps(p_W))) return false;
  const Vector3d p_far = far_along_x(frame_, p_W);
  const auto segment = segment_test(*surface_, frame_, p_W, p_far);
  const auto sieve = sieve_of(segment);
  unsigned crossings = 0;
  visit_reached(segment.low(), segment.high(), [&](std::int32_t t) noexcept {
    crossings += count_crossings(segment, sieve, {&t, 1});
  });
  return crossings % 2 == 1;
}

template <class Surface>
SurfacePoint LinearSearchOver<Surface>::closest(const Vector3d& p_W, double radius) const noexcept {
  if (!within_range(p_W) || !(radius >= 0)) return {};
  NearestPoint nearest(*surface_, frame_, frame_.to_steps(p_W), reach_of(frame_, radius));
  constexpr std::int32_t kAtOnce = 64;
  std::array<std::int32_t, kAtOnce> list;
  const std::int32_t count = surface_->triangle_count();
  for (std::int32_t begin = 0; begin < count; begin += kAtOnce) {
    const std::int32_t size = std::min(kAtOnce, count - begin);
    std::iota(list.begin(), list.begin() + size, begin);
    nearest.consider({list.data(), static_cast<std::size_t>(size)});
  }
  return nearest.point();
}

template <class Surface>
double LinearSearchOver<Surface>::clearance(const Vector3d&) const noexcept {
  return 0;
}

template class LinearSearchOver<ContactMesh>;
template class LinearSearchOver<PackedSurface>;

}  // namespace thimble::render
