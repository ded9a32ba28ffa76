#include "ball/ball_step.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "ball/ball_source.h"
#include "world/active_planes.h"

namespace thimble::render {

using Eigen::Vector3d;

namespace {

// Maximum number of half-spaces that are met on the way. Each one that is met takes the solution
// farther from the tip, so none is met twice but by rounding. [chosen]
constexpr int kMeetMax = 64;

}  // namespace

BallStep ball_step(std::span<const BallFeature> features, const Vector3d& to_tip,
                   const Eigen::Matrix3d& H, double tolerance) noexcept {
  BallStep step;
  const std::size_t all = std::min(features.size(), kFeaturesMax);
  // In coordinates z = L^T y with H = L L^T, the problem is that of the closest point.
  const bool plain = H.isIdentity(0);
  Eigen::Matrix3d L = Eigen::Matrix3d::Identity();
  if (!plain) L = H.llt().matrixL();
  const auto to_z = [&](const Vector3d& n) {
    return plain ? n : Vector3d(L.triangularView<Eigen::Lower>().solve(n));
  };
  std::array<ActivePlane, kFeaturesMax> planes;
  std::array<double, kFeaturesMax> size;
  for (std::size_t i = 0; i < all; ++i) {
    const Vector3d m = to_z(features[i].n_W);
    size[i] = plain ? 1 : m.norm();
    planes[i] = {.n = m / size[i], .offset = -features[i].gap / size[i]};
  }
  const Vector3d goal = to_z(to_tip);
  // The half-spaces that hold the solution, at most three, and the one that it violates most.
  std::array<ActivePlane, 4> held;
  std::array<std::size_t, 4> number{};
  std::size_t count = 0;
  PushOut push;
  bool ended = false;
  for (int meet = 0; meet < kMeetMax && !ended; ++meet) {
    const Vector3d z = goal + push.d;
    double deepest = tolerance;
    std::size_t worst = all;
    for (std::size_t i = 0; i < all; ++i) {
      const double depth = planes[i].depth(z);
      if (!(depth > deepest)) continue;
      deepest = depth;
      worst = i;
    }
    const bool known = std::find(number.begin(), number.begin() + static_cast<long>(count),
                                 worst) != number.begin() + static_cast<long>(count);
    ended = worst == all || known;
    if (ended) break;
    held[count] = planes[worst];
    number[count++] = worst;
    push = push_out(std::span(held).first(count), goal, 0, tolerance / 4);
    if (!push.feasible) break;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (!(push.lambda[k] > 0)) continue;
      held[kept] = held[k];
      number[kept] = number[k];
      push.lambda[kept++] = push.lambda[k];
    }
    count = kept;
  }
  step.feasible = ended && push.feasible;
  if (!step.feasible) return step;
  const Vector3d z = goal + push.d;
  step.y = plain ? z : Vector3d(L.transpose().triangularView<Eigen::Upper>().solve(z));
  step.count = std::min<std::size_t>(count, 3);
  for (std::size_t k = 0; k < step.count; ++k) {
    step.active[k] = number[k];
    step.weight[k] = push.lambda[k] / size[number[k]];
  }
  return step;
}

}  // namespace thimble::render
