#pragma once

#include <Eigen/Core>
#include <concepts>

#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"

namespace thimble::render {

/// What the surface stages of one object hand on to each other in one tick of contact.
struct SurfaceResponse {
  ContactState contact;            ///< As felt so far: a texture changes its depth or normal.
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Force on the hand so far, N in W.
};

/// A stage of ContactForceLaw after the contact: a texture, the spring of the surface, a friction.
///
/// `touch` runs once in every tick of contact and changes `response`; `leave` runs once when a
/// contact has ended and forgets what belongs to it. Both are Real-time: safe.
template <class Stage>
concept SurfaceStage = requires(Stage stage, const driver::DeviceState& state,
                                SurfaceResponse& response) {
  { stage.touch(state, response) }
  noexcept->std::same_as<void>;
  { stage.leave() }
  noexcept->std::same_as<void>;
};

/// The place on the surface below a tip, and how it moves with the tip: what a texture is fixed to.
///
/// M is the material: the surface as it was given, in the frame that the mesh stands in. Where the
/// surface has kept its shape a place of M is one of W. All Real-time: safe.
struct SurfaceFoot {
  Eigen::Vector3d p_M{0, 0, 0};                    ///< The place, m.
  Eigen::Vector3d n_M{0, 0, 0};                    ///< Outward unit normal there.
  Eigen::Matrix3d J_MT = Eigen::Matrix3d::Zero();  ///< Derivative of `p_M` by the tip's place.
  /// How fast the depth falls with the tip's place: minus its gradient, W. The normal that is felt
  /// where that is this gradient; beside it where the normal is shaded.
  Eigen::Vector3d fall_W{0, 0, 0};
  double surface_path = 0;  ///< Path of the surface since the last tick, m.

  /// Returns the gradient in the tip's place of a quantity whose gradient in the material is
  /// `slope_M`.
  Eigen::Vector3d slope_at_tip(const Eigen::Vector3d& slope_M) const noexcept {
    return J_MT.transpose() * slope_M;
  }
};

/// Returns the foot on the plane through the proxy: exact where the surface is flat.
/// Real-time: safe.
inline SurfaceFoot flat_foot(const ContactState& contact) noexcept {
  return {.p_M = contact.p_WP,
          .n_M = contact.n_W,
          .J_MT = Eigen::Matrix3d::Identity() - contact.n_W * contact.n_W.transpose(),
          .fall_W = contact.n_W};
}

/// Returns the foot that a `Contact` stage of ContactForceLaw tells of, or the flat one if it tells
/// of none. Precondition: its last `update` was at `p_WT` (W, m) and touches. Real-time: safe.
template <class Contact>
SurfaceFoot foot_of(const Contact& contact, const Eigen::Vector3d& p_WT) noexcept {
  if constexpr (requires { contact.foot(p_WT); }) {
    return contact.foot(p_WT);
  } else {
    return flat_foot(contact.state());
  }
}

/// A SurfaceStage that depends on the place of the surface: a texture. ContactForceLaw finds the
/// foot for such stages, and for no others.
template <class Stage>
concept FootStage = requires(Stage stage, const SurfaceFoot& foot, const driver::DeviceState& state,
                             SurfaceResponse& response) {
  { stage.touch_at(foot, state, response) }
  noexcept->std::same_as<void>;
};

/// The place that textures are felt at: the foot, as long as it moves no faster than the tip's path
/// allows.
///
/// Where cells of a surface meet deep inside, the foot jumps, and a height would jump with it. This
/// place follows it by at most `kPathRatio` times the path of tip and surface, as the felt depth
/// does (track/path_bounded.h). While it is behind it does not depend on the tip's place, so its
/// slope is 0 and nothing pushes aside. All Real-time: safe.
class FootFollower {
 public:
  /// Path of the place per path of the tip, as ProxyFilter::kPathRatio. [chosen]
  static constexpr double kPathRatio = 4;

  /// Returns the foot that is felt with the tip at `p_WT` (m), `depth` (m) below the surface, where
  /// `found` was found.
  SurfaceFoot follow(const Eigen::Vector3d& p_WT, double depth, const SurfaceFoot& found) noexcept {
    const double reach =
        kPathRatio * ((p_WT - p_WT_).norm() + found.surface_path) + kRounding * depth;
    const Eigen::Vector3d behind = found.p_M - p_M_;
    const double way = behind.norm();
    p_WT_ = p_WT;
    // Written so that NaN takes what was found: no force comes of it (texture_height.h).
    if (!touching_ || !(way > reach)) {
      touching_ = true;
      p_M_ = found.p_M;
      return found;
    }
    p_M_ += reach / way * behind;
    return {.p_M = p_M_, .n_M = found.n_M, .fall_W = found.fall_W};
  }

  /// Forgets the place: the contact has ended.
  void leave() noexcept { touching_ = false; }

 private:
  static constexpr double kRounding = 1e-10;  // of the depth, as ProxyFilter

  bool touching_ = false;
  Eigen::Vector3d p_WT_{0, 0, 0};
  Eigen::Vector3d p_M_{0, 0, 0};
};

}  // namespace thimble::render
