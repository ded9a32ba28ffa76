#pragma once

#include <Eigen/Core>
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

/// Says what a texture does besides changing the depth.
enum class TextureForm : std::uint8_t {
  kConservative,  ///< Pushes aside as well, down the slope.
  kDepthOnly,     ///< Pushes along the object's normal only: the paper's form [BP 4.2].
};
inline constexpr std::array<std::string_view, 2> kTextureFormNames{"conservative", "depth_only"};

/// Makes a height felt, before the surface's spring.
///
/// The height h is that of the foot q, the place of the material below the tip p
/// (surface_response.h), so it is the same at every depth, and rides on what carries the material.
/// With depth d, whose gradient is -n, the spring holds the energy k (d(p) + h(q(p)))^2 / 2; so its
/// force is k (d + h) (n - J^T grad h), with J = dq/dp. `kConservative` hands on just that: the
/// normal tilts to (n - s) / |n - s|, s = J^T grad h, and the depth stretches to (d + h) |n - s|.
/// Any spring that is linear in the depth then does no work around a closed way, in depth or along
/// the surface, and a damper takes out energy only. J is the plane's projection on flat ground,
/// longer by R / (R - d) on a ball, shorter in a hollow. `kDepthOnly` leaves the normal alone:
/// going up a slope costs less than going down gives back.
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
  const Eigen::Vector3d steep = contact.n_W - foot.slope_at_tip(texture.slope_M);
  const double stretch = steep.norm();
  if (!(depth > 0 && steep.dot(contact.n_W) > 0)) {
    contact.depth = 0;
    return;
  }
  contact.n_W = steep / stretch;
  contact.depth = depth * stretch;
}

}  // namespace thimble::render
