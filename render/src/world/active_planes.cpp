#include "world/active_planes.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Squared sine below which planes count as parallel: their common line is not known. [chosen]
constexpr double kParallel = 1e-14;

// A subset of up to three planes, and its combination that lies on all of them.
struct Subset {
  std::array<std::size_t, 3> plane{};
  std::size_t size = 0;
  std::array<double, 3> lambda{};
};

// Solves G x = b for the Gram matrix G of the subset's normals. Returns false if it is singular.
bool solve_gram(std::span<const ActivePlane> planes, const Subset& subset,
                const std::array<double, 3>& b, std::array<double, 3>& x) noexcept {
  const auto g = [&](std::size_t i, std::size_t k) {
    return planes[subset.plane[i]].n.dot(planes[subset.plane[k]].n);
  };
  if (subset.size == 1) {
    x[0] = b[0];
    return true;
  }
  if (subset.size == 2) {
    const double c = g(0, 1);
    // 1 - c^2 without cancellation.
    const double sine_squared =
        planes[subset.plane[0]].n.cross(planes[subset.plane[1]].n).squaredNorm();
    if (!(sine_squared > kParallel)) return false;
    x[0] = (b[0] - c * b[1]) / sine_squared;
    x[1] = (b[1] - c * b[0]) / sine_squared;
    return true;
  }
  // The point d on all three planes, then its combination: x = N^-1 d, d = N^-T b.
  const Vector3d& n0 = planes[subset.plane[0]].n;
  const Vector3d& n1 = planes[subset.plane[1]].n;
  const Vector3d& n2 = planes[subset.plane[2]].n;
  const Vector3d n12 = n1.cross(n2), n20 = n2.cross(n0), n01 = n0.cross(n1);
  const double volume = n0.dot(n12);
  if (!(volume * volume > kParallel)) return false;
  const Vector3d d = (b[0] * n12 + b[1] * n20 + b[2] * n01) / volume;
  x = {d.dot(n12) / volume, d.dot(n20) / volume, d.dot(n01) / volume};
  return true;
}

}  // namespace

PushOut push_out(std::span<const ActivePlane> planes, const Vector3d& p, double lift,
                 double tolerance) noexcept {
  PushOut best;
  const std::size_t count = planes.size();
  if (count == 0) return best;
  if (count == 1) {
    best.lambda[0] = std::max(0.0, planes[0].depth(p) + lift);
    best.d = best.lambda[0] * planes[0].n;
    return best;
  }
  std::array<double, kPlanesMax> depth;
  double deepest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    depth[i] = planes[i].depth(p) + lift;
    deepest = std::max(deepest, depth[i]);
  }
  const double slack = tolerance + 1e-13 * deepest;
  double least_violation = std::numeric_limits<double>::infinity();
  // Takes the subset if it satisfies all planes; else keeps it if none was better.
  const auto take = [&](const Subset& subset) {
    PushOut push;
    for (std::size_t i = 0; i < subset.size; ++i) {
      push.d += subset.lambda[i] * planes[subset.plane[i]].n;
      push.lambda[subset.plane[i]] = subset.lambda[i];
    }
    double violation = 0;
    for (std::size_t i = 0; i < count; ++i) {
      violation = std::max(violation, depth[i] - planes[i].n.dot(push.d));
    }
    if (violation < least_violation) {
      least_violation = violation;
      best = push;
    }
    return violation <= slack;
  };
  const auto attempt = [&](Subset subset) {
    std::array<double, 3> b{};
    for (std::size_t i = 0; i < subset.size; ++i) b[i] = depth[subset.plane[i]];
    if (!solve_gram(planes, subset, b, subset.lambda)) return false;
    for (std::size_t i = 0; i < subset.size; ++i) {
      if (!(subset.lambda[i] >= 0)) return false;
    }
    return take(subset);
  };
  // The subset whose lambdas are not negative, and that satisfies all planes, is the solution of
  // this convex problem; it is unique up to rounding.
  if (take({})) return best;
  for (std::size_t i = 0; i < count; ++i) {
    if (attempt({.plane = {i}, .size = 1})) return best;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) {
      if (attempt({.plane = {i, k}, .size = 2})) return best;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) {
      for (std::size_t m = k + 1; m < count; ++m) {
        if (attempt({.plane = {i, k, m}, .size = 3})) return best;
      }
    }
  }
  best.feasible = false;
  return best;
}

SharedForce shared_force_of(std::span<const ActivePlane> planes, std::span<const double> stiffness,
                            const PushOut& push) noexcept {
  SharedForce force;
  Subset subset;
  double sum = 0, weighted = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double squared = push.lambda[i] * push.lambda[i];
    if (!(squared > 0)) continue;
    if (subset.size < 3) subset.plane[subset.size++] = i;
    sum += squared;
    weighted += squared * stiffness[i];
  }
  if (!(sum > 0)) return force;
  const double k = weighted / sum;
  std::array<double, 3> slope{};
  bool equal = true;
  for (std::size_t i = 0; i < subset.size; ++i) {
    const std::size_t plane = subset.plane[i];
    force.part[plane] = k * push.lambda[plane];
    slope[i] = 2 * push.lambda[plane] * (stiffness[plane] - k) / sum;
    equal = equal && stiffness[plane] == stiffness[subset.plane[0]];
  }
  if (!equal) {
    // lambda = G^-1 (depths), and a depth falls by 1 for each m along its normal.
    std::array<double, 3> by_depth{};
    if (solve_gram(planes, subset, slope, by_depth)) {
      const double half = push.d.squaredNorm() / 2;
      for (std::size_t i = 0; i < subset.size; ++i) {
        force.part[subset.plane[i]] += half * by_depth[i];
      }
    }
  }
  for (std::size_t i = 0; i < planes.size(); ++i) force.f_W += force.part[i] * planes[i].n;
  return force;
}

}  // namespace thimble::render
