#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// The height of a texture at one place. Textures are cut into the object: their peaks are in its
/// surface, so a height is never above 0. Otherwise contact would begin with a step of force, and a
/// tip that enters at a valley and leaves at a peak would gain energy.
struct TextureHeight {
  double height = 0;                 ///< m, <= 0
  Eigen::Vector3d slope_M{0, 0, 0};  ///< Gradient of the height by the place, M.
};

/// Effect of a texture in addition to changing the depth.
enum class TextureForm : std::uint8_t {
  kConservative,  ///< Also pushes sideways, down the slope.
  kDepthOnly,     ///< Pushes only along the object's normal: the paper's form [BP 4.2].
};
inline constexpr std::array<std::string_view, 2> kTextureFormNames{"conservative", "depth_only"};

/// Applies a height to the contact, before the surface's spring.
///
/// The height h is that of q, the material point below the tip p (surface_response.h). So it is the
/// same at every depth, and moves with the material. The texture changes the energy k d^2 / 2 of
/// the spring to k (d + h(q))^2 / 2. So it adds minus the gradient of the difference to the
/// contact's force k d n. With g = -grad d (ClosestSurfacePoint::fall_W), s = J^T grad h and J =
/// dq/dp the force becomes
///
///   k d n + k (d + h) (g - s) - k d g  =  k (d + h) (g - s) + k d (n - g).
///
/// So for any normal n the texture itself does no work around a closed path on which q moves
/// continuously, in depth or along the surface. This holds with any spring that is linear in the
/// depth; a damper only dissipates. Where n is g, the last term is 0 and the whole force does no
/// work. This is so on flat faces, on shapes, with the god-object, and at an edge or corner that
/// holds a tip. Where n is shaded, that term is the work left by the contact itself.
/// `kConservative` applies exactly this, as a tilted normal and a stretched depth. In the last term
/// d is limited to 2 (d + h), so that the force ends with d + h. At depths below twice a valley,
/// this slightly reduces the work that a shaded contact leaves. J is the plane's projection on flat
/// ground, longer by R / (R - d) on a ball, shorter where the surface is concave. `kDepthOnly`
/// keeps the normal: going up a slope costs less than going down returns.
///
/// Where the tip is above the texture, and for NaN, the depth becomes 0. The force never points
/// into the object. The proxy stays on the object's own surface. Real-time: safe.
inline void feel_height(const TextureHeight& texture, const ClosestSurfacePoint& closest,
                        TextureForm form, SurfaceResponse& response) noexcept {
  ContactState& contact = response.contact;
  const double depth = contact.depth + texture.height;
  if (form == TextureForm::kDepthOnly) {
    contact.depth = depth > 0 ? depth : 0;  // written so that NaN gives 0
    return;
  }
  if (!(depth > 0)) {
    contact.depth = 0;
    return;
  }
  const double shaded = std::min(contact.depth / depth, 2.0);
  const Eigen::Vector3d steep = closest.fall_W - closest.slope_at_tip(texture.slope_M) +
                                shaded * (contact.n_W - closest.fall_W);
  const double stretch = steep.norm();
  if (!(steep.dot(contact.n_W) > 0)) {
    contact.depth = 0;
    return;
  }
  contact.n_W = steep / stretch;
  contact.depth = depth * stretch;
}

}  // namespace thimble::render
