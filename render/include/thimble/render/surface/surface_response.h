#pragma once

#include <Eigen/Core>
#include <concepts>

#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"

namespace thimble::render {

/// Is what the surface stages of one object hand on to each other in one tick of contact.
struct SurfaceResponse {
  ContactState contact;            ///< As felt so far: a texture changes its depth or normal.
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Force on the hand so far, N in W.
};

/// Is a stage of Touch after the contact: a texture, the spring of the surface, a friction.
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

}  // namespace thimble::render
