#pragma once

#include <Eigen/Core>
#include <concepts>

#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"

namespace thimble::render {

/// Intermediate result that the surface stages of one object pass on in one tick of contact.
struct SurfaceResponse {
  ContactState contact;            ///< Contact so far; a texture changes its depth or normal.
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Force on the hand so far, N in W.
};

/// Stage of ContactForceLaw after the contact: a texture, the spring of the surface, or friction.
///
/// `touch` runs once in every tick of contact and changes `response`. `leave` runs once when a
/// contact has ended and resets the stage. Both are Real-time: safe.
template <class Stage>
concept SurfaceStage = requires(Stage stage, const driver::DeviceState& state,
                                SurfaceResponse& response) {
  { stage.touch(state, response) }
  noexcept->std::same_as<void>;
  { stage.leave() }
  noexcept->std::same_as<void>;
};

/// Closest point of the surface to a tip, and its derivative: the position to which a texture is
/// fixed.
///
/// M is the material: the surface as given, in the frame of the mesh. On an undeformed surface a
/// position in M equals that in W. All functions are Real-time: safe.
struct ClosestSurfacePoint {
  Eigen::Vector3d p_M{0, 0, 0};  ///< Position of the point, m.
  Eigen::Vector3d n_M{0, 0, 0};  ///< Outward unit normal at the point.
  /// Derivative of `p_M` with respect to the tip's position.
  Eigen::Matrix3d J_MT = Eigen::Matrix3d::Zero();
  /// Negative gradient of the depth with respect to the tip's position, in W. It equals the felt
  /// normal, except where that is shaded.
  Eigen::Vector3d fall_W{0, 0, 0};
  double surface_path = 0;  ///< Displacement of the surface since the last tick, m.

  /// Returns the gradient with respect to the tip's position of a quantity whose gradient in the
  /// material is `slope_M`.
  Eigen::Vector3d slope_at_tip(const Eigen::Vector3d& slope_M) const noexcept {
    return J_MT.transpose() * slope_M;
  }
};

/// Former name of ClosestSurfacePoint.
using SurfaceFoot [[deprecated("renamed to ClosestSurfacePoint")]] = ClosestSurfacePoint;

/// Returns the closest point on the plane through the proxy: exact if the surface is flat.
/// Real-time: safe.
inline ClosestSurfacePoint flat_closest_point(const ContactState& contact) noexcept {
  return {.p_M = contact.p_WP,
          .n_M = contact.n_W,
          .J_MT = Eigen::Matrix3d::Identity() - contact.n_W * contact.n_W.transpose(),
          .fall_W = contact.n_W};
}

/// Former name of `flat_closest_point`. Real-time: safe.
[[deprecated("renamed to flat_closest_point")]] inline ClosestSurfacePoint flat_foot(
    const ContactState& contact) noexcept {
  return flat_closest_point(contact);
}

/// Returns the closest point from a `Contact` stage of ContactForceLaw, or the flat one if the
/// stage provides none. Precondition: its last `update` was at `p_WT` (W, m) and touches.
/// Real-time: safe.
template <class Contact>
ClosestSurfacePoint closest_point_of(const Contact& contact, const Eigen::Vector3d& p_WT) noexcept {
  if constexpr (requires { contact.closest(p_WT); }) {
    return contact.closest(p_WT);
  } else if constexpr (requires { contact.foot(p_WT); }) {
    return contact.foot(p_WT);  // deprecated: former name of `closest` in stages of programs
  } else {
    return flat_closest_point(contact.state());
  }
}

/// Former name of `closest_point_of`. Real-time: safe.
template <class Contact>
[[deprecated("renamed to closest_point_of")]] ClosestSurfacePoint foot_of(
    const Contact& contact, const Eigen::Vector3d& p_WT) noexcept {
  return closest_point_of(contact, p_WT);
}

/// SurfaceStage that depends on the position on the surface: a texture. ContactForceLaw computes
/// the closest point for such stages only.
template <class Stage>
concept ClosestPointStage = requires(Stage stage, const ClosestSurfacePoint& closest,
                                     const driver::DeviceState& state, SurfaceResponse& response) {
  { stage.touch_at(closest, state, response) }
  noexcept->std::same_as<void>;
};

/// Deprecated: former name of ClosestPointStage. A concept cannot warn.
template <class Stage>
concept FootStage = ClosestPointStage<Stage>;

/// Position at which textures are evaluated: the closest point, as long as it moves no faster than
/// the tip's path allows.
///
/// Deep inside an object, the closest point can jump from one part of the surface to another, and
/// the texture height would jump with it. This position follows it by at most `kPathRatio` times
/// the path of tip and surface, as the felt depth does (track/path_bounded.h). While it lags behind
/// it does not depend on the tip's position, so its slope is 0 and there is no lateral force. All
/// functions are Real-time: safe.
class ClosestPointFollower {
 public:
  /// Largest ratio of the path of the position to that of the tip, as ProxyFilter::kPathRatio.
  /// [chosen]
  static constexpr double kPathRatio = 4;

  /// Returns the position at which textures are evaluated, with the tip at `p_WT` (m), `depth` (m)
  /// below the surface, and the closest point `found`.
  ClosestSurfacePoint follow(const Eigen::Vector3d& p_WT, double depth,
                             const ClosestSurfacePoint& found) noexcept {
    const double reach =
        kPathRatio * ((p_WT - p_WT_).norm() + found.surface_path) + kRounding * depth;
    const Eigen::Vector3d behind = found.p_M - p_M_;
    const double way = behind.norm();
    p_WT_ = p_WT;
    // Written so that NaN gives `found`, which produces no force (texture_height.h).
    if (!touching_ || !(way > reach)) {
      touching_ = true;
      p_M_ = found.p_M;
      return found;
    }
    p_M_ += reach / way * behind;
    return {.p_M = p_M_, .n_M = found.n_M, .fall_W = found.fall_W};
  }

  /// Resets the position after the end of a contact.
  void leave() noexcept { touching_ = false; }

 private:
  static constexpr double kRounding = 1e-10;  // Fraction of the depth, as in ProxyFilter.

  bool touching_ = false;
  Eigen::Vector3d p_WT_{0, 0, 0};
  Eigen::Vector3d p_M_{0, 0, 0};
};

/// Former name of ClosestPointFollower.
using FootFollower [[deprecated("renamed to ClosestPointFollower")]] = ClosestPointFollower;

}  // namespace thimble::render
