#include "surface/texture/uv_height_map.h"

#include <string>
#include <utility>

#include "thimble/render/effect/map_settings.h"

namespace thimble::render {

driver::Result<StageBuilder> UvHeightMap::on(const std::shared_ptr<const SurfaceMaps>& maps,
                                             const HeightMap::Settings& settings,
                                             const EffectContext& context) {
  auto map = SurfaceMap::of_image(maps, settings.image, SurfaceMap::Missing::kWhite,
                                  "the texture height_map with map: uv");
  if (!map) return map.error();
  MapSettings checked;
  check_texture(checked, "texture: height_map: height", extent_of(**map, settings), settings,
                context);
  if (!checked.mistakes().empty()) {
    return driver::Error{checked.mistakes().front() + " (by the texture coordinates of " +
                         (*map)->steepest() + ")."};
  }
  return StageBuilder([map = std::move(map).value(), settings, context] {
    return std::make_unique<AnyStageOf<UvHeightMap>>(UvHeightMap(map, settings, context));
  });
}

UvHeightMap::UvHeightMap(std::shared_ptr<const SurfaceMap> map, const HeightMap::Settings& settings,
                         const EffectContext& context)
    : map_(std::move(map)),
      height_(settings.height),
      extent_(extent_of(*map_, settings)),
      max_height_(height_ * texture_headroom(extent_, context)),
      form_(settings.form),
      shortest_(shortest_wave(settings, context)) {}

TextureExtent UvHeightMap::extent_of(const SurfaceMap& map, const HeightMap::Settings& settings) {
  // Two pixels are the shortest wave a picture can hold. A picture without slope has none.
  return {.relief = settings.height,
          .slope = settings.height * map.slope_max(),
          .wavelength = map.slope_max() > 0 ? 2 * map.pixel_min() : 1};
}

void UvHeightMap::list_settings(LiveSettings& settings) {
  if (!(height_ > 0)) return;
  ForceSensitivity sensitivity = texture_lever(extent_);
  sensitivity.per_force /= height_;
  sensitivity.per_stiffness /= height_;
  settings.add<[](UvHeightMap& map, double height) noexcept { map.height_ = height; }>(
      *this, {.name = "height",
              .unit = "m",
              .max = max_height_,
              .value = height_,
              .sensitivity = sensitivity});
}

}  // namespace thimble::render
