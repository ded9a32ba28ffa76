#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "thimble/render/contact/bvh.h"

namespace thimble::render {

// Boxes of a TreeSearch while they are made: in double precision, rounded outwards into its nodes.

inline float rounded_down(double v) noexcept {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) > v ? std::nextafter(f, -INFINITY) : f;
}

inline float rounded_up(double v) noexcept {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) < v ? std::nextafter(f, INFINITY) : f;
}

template <class Surface>
struct TreeSearch<Surface>::Box {
  static constexpr double kHighest = std::numeric_limits<double>::infinity();
  std::array<double, 3> min{kHighest, kHighest, kHighest};
  std::array<double, 3> max{-kHighest, -kHighest, -kHighest};

  void add(std::size_t axis, double low, double high) noexcept {
    min[axis] = std::min(min[axis], low);
    max[axis] = std::max(max[axis], high);
  }
  void add(const Box& box) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) add(axis, box.min[axis], box.max[axis]);
  }
  void add(const Eigen::Vector3d& p) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double u = p[static_cast<Eigen::Index>(axis)];
      add(axis, u, u);
    }
  }
};

}  // namespace thimble::render
