#pragma once

#include <Eigen/Core>
#include <concepts>

#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// The place on the surface below a tip, and how it moves with the tip: what a texture is fixed to.
///
/// M is the material: the surface as it was given, in the frame that the mesh stands in. Where the
/// surface has kept its shape a place of M is one of W. All Real-time: safe.
struct SurfaceFoot {
  Eigen::Vector3d p_M{0, 0, 0};                    ///< The place, m.
  Eigen::Vector3d n_M{0, 0, 0};                    ///< Outward unit normal there.
  Eigen::Matrix3d J_MT = Eigen::Matrix3d::Zero();  ///< Derivative of `p_M` by the tip's place.
  double surface_path = 0;                         ///< Path of the surface since the last tick, m.

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
          .J_MT = Eigen::Matrix3d::Identity() - contact.n_W * contact.n_W.transpose()};
}

/// Returns the foot that a `Contact` stage of Touch tells of, or the flat one if it tells of none.
/// Precondition: its last `update` was at `p_WT` (W, m) and touches. Real-time: safe.
template <class Contact>
SurfaceFoot foot_of(const Contact& contact, const Eigen::Vector3d& p_WT) noexcept {
  if constexpr (requires { contact.foot(p_WT); }) {
    return contact.foot(p_WT);
  } else {
    return flat_foot(contact.state());
  }
}

/// A SurfaceStage that depends on the place of the surface: a texture. Touch finds the foot for
/// such stages, and for no others.
template <class Stage>
concept FootStage = requires(Stage stage, const SurfaceFoot& foot, const driver::DeviceState& state,
                             SurfaceResponse& response) {
  { stage.touch_at(foot, state, response) }
  noexcept->std::same_as<void>;
};

}  // namespace thimble::render
