#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "surface/texture/height_image.h"
#include "surface/texture/texture_limits.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_table.h"

namespace thimble::render {

/// Makes a surface of a grey picture: white lies in the object's surface, black deepest below. A
/// FootStage.
///
/// The picture is laid on in the object's frame, along one axis or along all three at once, each
/// counting by the square of the normal's part along it; it repeats. Laid on along all, it reads
/// the same way round on every face, seen from outside; along one axis, as seen from that axis'
/// tip. On flat faces that is conservative. Where a curved face turns from one axis to the next,
/// the change of the parts is left out: about (height / radius of curvature) of the force. All
/// textures: texture_height.h.
class THIMBLE_EXPORT HeightMap {
 public:
  static constexpr std::string_view kGroup = "texture";
  static constexpr std::string_view kName = "height_map";
  static constexpr EffectOrder kOrder = EffectOrder::kDepth;

  /// Says along which axes of the object the image is laid on: on every face from its own side, or
  /// from one side alone.
  enum class Along : std::uint8_t { kAll, kX, kY, kZ };

  struct Settings : TextureSettings {
    std::shared_ptr<const HeightImage> image;  ///< Its heights.
    double width = 0;                          ///< Of the picture on the surface, m.
    double height = 0;                         ///< From black to white, m.
    Along along = Along::kAll;                 ///< Where it is laid from.

    /// Reads `form`, `hand_speed`, `image`, `width`, `height`, `along`.
    /// Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
    /// Returns how high and steep it is. Precondition: it has an image and a width. Real-time:
    /// safe.
    TextureExtent extent() const noexcept;
  };

  /// Precondition: there is an image. Real-time: never from the servo thread.
  HeightMap(const Settings& settings, const EffectContext& context);

  /// See FootStage. Real-time: safe.
  void touch_at(const SurfaceFoot& foot, const driver::DeviceState&,
                SurfaceResponse& response) const noexcept {
    feel_height(at(foot.p_M, foot.n_M), foot, form_, response);
  }
  /// The same on a flat surface. Real-time: safe.
  void touch(const driver::DeviceState& state, SurfaceResponse& response) const noexcept {
    touch_at(flat_foot(response.contact), state, response);
  }
  void leave() const noexcept {}

  /// Lists the height. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings);

  /// Finds the height at a place (M, m) of a surface with the normal `n_M`. NaN gives NaN.
  /// Real-time: safe; 16 pixels for each axis that counts.
  TextureHeight at(const Eigen::Vector3d& p_M, const Eigen::Vector3d& n_M) const noexcept;

 private:
  std::shared_ptr<const HeightImage> image_;
  Eigen::Matrix3d R_WO_;
  Eigen::Vector3d p_WO_;
  double pixels_per_metre_;
  double height_;
  double height_most_ = 0;
  TextureExtent extent_;  // of the first height
  Along along_;
  TextureForm form_;
};

}  // namespace thimble::render
