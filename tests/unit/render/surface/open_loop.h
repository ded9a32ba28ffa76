#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"

namespace thimble::render {

/// Net work of a closed loop, as fractions of the work in and out of the bare contact.
struct OpenLoop {
  double plain = 0;  ///< Without a texture.
  double added = 0;  ///< Due to the texture.
  bool felt = true;  ///< Whether both tips were in contact along the whole loop.
};

/// Moves two tips around the same closed path, s from 0 to a turn: one over the bare surface, one
/// over the textured. Force and its derivatives may jump where the touched feature changes: each
/// change is found by bisection, and between changes the work is integrated by Gauss' rule. `bare`
/// and `rough` take a state and return a ForceCommand.
template <class Bare, class Rough, class Way>
OpenLoop open_loop(Bare& bare, Rough& rough, const Eigen::Vector3d& outside, const Way& way,
                   int steps = 1500) {
  using Eigen::Vector3d;
  constexpr int kIn = 4000;
  constexpr double kRound = 2 * std::numbers::pi;
  const auto at = [](const Vector3d& p_WT) {
    driver::DeviceState state;
    state.p_WT = p_WT;
    state.dt = 1e-3;
    return state;
  };
  const auto go = [&](const Vector3d& p) {
    const auto textured = rough(at(p));
    const auto plain = bare(at(p));
    return std::array{plain.f_T_W, textured.f_T_W, Vector3d(plain.touch.feature, 0, 0)};
  };
  for (int i = 0; i <= kIn; ++i) go(outside + i * (way(0.0) - outside) / kIn);
  double plain = 0, added = 0, gross = 0;
  bool felt = true;
  const auto sum_over = [&](double from, double to) {
    // Four points of Gauss' rule: exact up to the seventh power.
    constexpr std::array<double, 2> kPlace{0.339981043584856, 0.861136311594053};
    constexpr std::array<double, 2> kWeight{0.652145154862546, 0.347854845137454};
    for (const int k : {-2, -1, 1, 2}) {
      const auto m = static_cast<std::size_t>(std::abs(k) - 1);
      const double s = (from + to) / 2 + (to - from) / 2 * kPlace[m] * (k < 0 ? -1 : 1);
      const double e = 1e-3;
      const Vector3d speed =
          (45 * (way(s + e) - way(s - e)) - 9 * (way(s + 2 * e) - way(s - 2 * e)) +
           (way(s + 3 * e) - way(s - 3 * e))) /
          (60 * e);
      const auto [f_bare, f_rough, feature] = go(way(s));
      const double weight = kWeight[m] * (to - from) / 2;
      plain += weight * f_bare.dot(speed);
      added += weight * (f_rough - f_bare).dot(speed);
      gross += weight * std::abs(f_bare.dot(speed));
      felt = felt && f_bare.norm() > 0 && f_rough.norm() > 0;
    }
  };
  double from = 0;
  double feature = go(way(0.0))[2].x();
  for (int i = 1; i <= steps; ++i) {
    const double to = kRound * i / steps;
    // Maximum number of changes within one step. If the touched feature depends on the path, a
    // previous one may not be found again.
    constexpr int kChangesMax = 20;
    for (int change = 0; change < kChangesMax && go(way(to))[2].x() != feature; ++change) {
      double before = from, after = to;
      while (after - before > 1e-13) {
        const double middle = (before + after) / 2;
        (go(way(middle))[2].x() == feature ? before : after) = middle;
      }
      sum_over(from, before);
      from = after;
      feature = go(way(after))[2].x();
    }
    sum_over(from, to);
    feature = go(way(to))[2].x();
    from = to;
  }
  return {plain / gross, added / gross, felt};
}

}  // namespace thimble::render
