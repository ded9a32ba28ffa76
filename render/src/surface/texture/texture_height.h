#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// The height of a texture at one place. Textures are cut into the object: their peaks lie in
/// its surface, so a height is never above 0. Else contact would begin with a step of force, and
/// whoever comes in by a valley and leaves by a peak would take energy with him.
struct TextureHeight {
  double height = 0;                 ///< m, <= 0
  Eigen::Vector3d slope_M{0, 0, 0};  ///< Its gradient in the place, M.
};

/// What a texture does besides changing the depth.
enum class TextureForm : std::uint8_t {
  kConservative,  ///< Pushes aside as well, down the slope.
  kDepthOnly,     ///< Pushes along the object's normal only: the paper's form [BP 4.2].
};
inline constexpr std::array<std::string_view, 2> kTextureFormNames{"conservative", "depth_only"};

/// Makes a height felt, before the surface's spring.
///
/// The height h is that of the foot q, the place of the material below the tip p
/// (surface_response.h), so it is the same at every depth, and rides on what carries the material.
/// The texture changes the energy k d^2 / 2 of the spring into k (d + h(q))^2 / 2, so to the force
/// k d n of the contact it adds minus the gradient of the difference. With g = -grad d
/// (SurfaceFoot::fall_W), s = J^T grad h and J = dq/dp the force becomes
///
///   k d n + k (d + h) (g - s) - k d g  =  k (d + h) (g - s) + k d (n - g).
///
/// So whatever the normal n, the texture by itself does no work around a closed way on which q
/// moves continuously, in depth or along the surface, with any spring that is linear in the depth,
/// and a damper takes out energy only. Where n is g (flat faces, shapes, the god-object, what holds
/// a tip in a hollow) the last part is 0 and the whole force does none; where n is shaded that part
/// is what the contact leaves open by itself. `kConservative` hands on just that, as a tilted
/// normal and a stretched depth. In the last part d is at most 2 (d + h), so that the force ends
/// with d + h: less than twice as deep as a valley a shaded contact leaves open a little less by
/// it. J is the plane's projection on flat ground, longer by R / (R - d) on a ball, shorter in a
/// hollow. `kDepthOnly` leaves the normal alone: going up a slope costs less than going down gives
/// back.
///
/// Where the tip is above the texture, and for NaN, the depth becomes 0. The force never points
/// into the object. The proxy stays on the object's own surface. Real-time: safe.
inline void feel_height(const TextureHeight& texture, const SurfaceFoot& foot, TextureForm form,
                        SurfaceResponse& response) noexcept {
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
  const Eigen::Vector3d steep =
      foot.fall_W - foot.slope_at_tip(texture.slope_M) + shaded * (contact.n_W - foot.fall_W);
  const double stretch = steep.norm();
  if (!(steep.dot(contact.n_W) > 0)) {
    contact.depth = 0;
    return;
  }
  contact.n_W = steep / stretch;
  contact.depth = depth * stretch;
}

}  // namespace thimble::render
