#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::render {

/// What the tip of an arm feels near one place, as a simulation that is too slow for the servo
/// tells it: a force there and how it changes with the tip's way.
///
///     f(p) = f_T_W - stiffness (p - p_WR), as long as it pushes along n_W; else nothing
///
/// The surface is thus the plane where the force along n_W ends, so the tip can leave it between
/// two models, and no model pulls. While the tip is free, tell of the surface nearest to it: a
/// point of it, no force, and the stiffness that it would have. Where nothing is near, all are
/// zero.
struct LocalModel {
  Eigen::Vector3d p_WR{0, 0, 0};   ///< Reference point, in the world, m.
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Force on the hand with the tip there, in the world, N.
  /// How the force falls with the tip's way, -df/dp, N/m: symmetric, no negative eigenvalue. What
  /// has one (a bulge, over which the normal turns away) goes through `without_negative` first.
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  double damping = 0;            ///< Along n_W, while it is touched, N s/m, >= 0.
  Eigen::Vector3d n_W{0, 0, 1};  ///< Unit vector, to the free side.
  std::int64_t time_ns = 0;      ///< DeviceState::time_ns of the state it was computed for.
};

/// What is wrong with a model.
enum class ModelFlaw : std::uint8_t {
  kNone,
  kNotFinite,          ///< A number is NaN or infinite.
  kNormal,             ///< The normal is no unit vector.
  kNotSymmetric,       ///< The stiffness is no symmetric matrix.
  kNegativeStiffness,  ///< The stiffness has a negative eigenvalue: it would push away.
  kNegativeDamping,    ///< The damping is below 0.
  kNoSurface,          ///< There is a force, but no stiffness along the normal: it would never end.
};

/// Finds what is wrong with a model; the tolerances are a millionth of its largest number.
/// Real-time: safe.
THIMBLE_EXPORT ModelFlaw flaw_of(const LocalModel& model) noexcept;

/// Returns what a flaw means and what to do, in a sentence. Real-time: safe.
THIMBLE_EXPORT std::string_view describe(ModelFlaw flaw) noexcept;

/// Returns the symmetric matrix nearest to `stiffness` (N/m) that has no negative eigenvalue: its
/// symmetric part without what pushes away. A matrix that is not finite stays as it is. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT Eigen::Matrix3d without_negative(const Eigen::Matrix3d& stiffness);

}  // namespace thimble::render
