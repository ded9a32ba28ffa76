#include "view/ground_shadow.h"

#include <Eigen/Dense>

namespace thimble::view {

Eigen::AlignedBox2i ground_shadow(const Eigen::Matrix4f& view_projection,
                                  const Eigen::Matrix4f& shadow_from_world, float ground_height,
                                  const Eigen::AlignedBox2f& casters, const Eigen::Vector2i& size) {
  const Eigen::AlignedBox2i whole(Eigen::Vector2i::Zero(), size);
  if (casters.isEmpty()) return {};
  // Transform from the light's map, -1 to 1, to the ground.
  const Eigen::Matrix2f map_from_ground = shadow_from_world.topLeftCorner<2, 2>();
  const Eigen::Vector2f map_at_middle =
      shadow_from_world.block<2, 1>(0, 3) + ground_height * shadow_from_world.block<2, 1>(0, 2);
  const Eigen::Matrix2f ground_from_map = map_from_ground.inverse();
  Eigen::AlignedBox2f seen;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2f corner = casters.corner(static_cast<Eigen::AlignedBox2f::CornerType>(k));
    const Eigen::Vector2f at =
        ground_from_map * ((2 * corner.array() - 1).matrix() - map_at_middle);
    const Eigen::Vector4f clip =
        view_projection * Eigen::Vector4f(at.x(), at.y(), ground_height, 1);
    constexpr float kBeforeEye = 1e-4F;  // m: closer, the pixel of a corner overflows
    if (!(clip.w() > kBeforeEye)) return whole;
    seen.extend(Eigen::Vector2f(clip.head<2>() / clip.w()));
  }
  // One pixel more on each side, because the corners are rounded.
  const Eigen::Array2f pixels = size.cast<float>().array();
  const Eigen::Array2f max = pixels + 1;
  const auto pixel = [&](const Eigen::Vector2f& at) -> Eigen::Array2f {
    return (pixels * (0.5F * at.array() + 0.5F)).max(-1).min(max);
  };
  const Eigen::Array2f low = pixel(seen.min()).floor() - 1;
  const Eigen::Array2f high = pixel(seen.max()).ceil() + 1;
  return whole.intersection(
      Eigen::AlignedBox2i(Eigen::Vector2i(low.cast<int>()), Eigen::Vector2i(high.cast<int>())));
}

}  // namespace thimble::view
