#include "surface/texture/height_map.h"

#include <memory>
#include <utility>

#include "surface/texture/uv_height_map.h"

namespace thimble::render {

void HeightMap::Settings::read(SettingsReader& reader, const EffectContext& context) {
  TextureSettings::read(reader);
  std::filesystem::path file;
  reader.file("image", file);
  auto mapping = static_cast<std::size_t>(map);
  reader.choice("map", mapping, {"projected", "uv"});
  map = static_cast<Mapping>(mapping);
  if (map == Mapping::kUv) {
    for (const char* key : {"width", "along"}) {
      reader.explain_unused(key,
                            "needs map: projected; with map: uv the mesh file places the image");
    }
  } else {
    (void)reader.has("width");  // not needed with `map: uv`
    reader.number("width", width, {.unit = "m", .min = 1e-4, .max = 1, .required = true});
  }
  reader.number("height", height, {.unit = "m", .min = 0, .max = 0.05, .required = true});
  if (map == Mapping::kProjected) {
    auto chosen = static_cast<std::size_t>(along);
    reader.choice("along", chosen, {"all", "x", "y", "z"});
    along = static_cast<Along>(chosen);
  }
  if (file.empty() || !std::filesystem::is_regular_file(file)) return;  // refused already
  auto loaded = HeightImage::load(file);
  if (!loaded) {
    reader.reject("image", loaded.error().message);
    return;
  }
  image = std::make_shared<const HeightImage>(std::move(loaded).value());
  // By texture coordinates it is checked on the mesh.
  if (map == Mapping::kUv || !(width > 0)) return;
  check_texture(reader, "height", extent(), *this, context);
}

TextureExtent HeightMap::Settings::extent() const noexcept {
  const double pixel = width / static_cast<double>(image->width());
  // Two pixels are the shortest wave a picture can hold.
  return {.relief = height, .slope = height * image->slope_max() / pixel, .wavelength = 2 * pixel};
}

HeightMap::HeightMap(const Settings& settings, const EffectContext& context)
    : image_(settings.image),
      R_WO_(context.R_WO),
      p_WO_(context.p_WO),
      pixels_per_metre_(image_ ? static_cast<double>(image_->width()) / settings.width : 0),
      height_(settings.height),
      along_(settings.along),
      form_(settings.form) {
  if (!image_) return;
  extent_ = settings.extent();
  max_height_ = height_ * texture_headroom(extent_, context);
}

StageBuilder HeightMap::builder(const Settings& settings, const EffectContext& context) {
  if (settings.map == Mapping::kUv) {
    return StageBuilder::on_maps(
        [settings, context](const std::shared_ptr<const SurfaceMaps>& maps) {
          return UvHeightMap::on(maps, settings, context);
        });
  }
  return [settings, context] {
    return std::make_unique<AnyStageOf<HeightMap>>(HeightMap(settings, context));
  };
}

void HeightMap::list_settings(LiveSettings& settings) {
  if (!(height_ > 0)) return;
  ForceSensitivity sensitivity = texture_lever(extent_);
  sensitivity.per_force /= height_;
  sensitivity.per_stiffness /= height_;
  settings.add<[](HeightMap& map, double height) noexcept { map.height_ = height; }>(
      *this, {.name = "height",
              .unit = "m",
              .max = max_height_,
              .value = height_,
              .sensitivity = sensitivity});
}

TextureHeight HeightMap::at(const Eigen::Vector3d& p_M, const Eigen::Vector3d& n_M) const noexcept {
  const Eigen::Vector3d place = pixels_per_metre_ * (R_WO_.transpose() * (p_M - p_WO_));
  Eigen::Vector3d share = Eigen::Vector3d::Zero();
  // -1 for each axis that the face points against: seen from outside, the picture would be mirrored
  // there. Where a normal changes from one side to the other, the axis' share is 0.
  Eigen::Vector3d side = Eigen::Vector3d::Ones();
  if (along_ == Along::kAll) {
    const Eigen::Vector3d n_O = R_WO_.transpose() * n_M;
    share = n_O.cwiseAbs2();
    side = (n_O.array() < 0).select(-side, side);
  } else {
    share[static_cast<Eigen::Index>(along_) - 1] = 1;
  }
  double value = 0;
  Eigen::Vector3d slope_O = Eigen::Vector3d::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (share[axis] == 0) continue;
    // Seen from the tip of each axis: the next axis to the right, the one after it up. From behind,
    // the same axis is up and the other one to the left.
    const Eigen::Index right = (axis + 1) % 3, up = (axis + 2) % 3;
    const HeightImage::Sample sample = image_->at(side[axis] * place[right], place[up]);
    value += share[axis] * sample.value;
    slope_O[right] += share[axis] * side[axis] * sample.du;
    slope_O[up] += share[axis] * sample.dv;
  }
  return {.height = height_ * (value - 1),
          .slope_M = height_ * pixels_per_metre_ * (R_WO_ * slope_O)};
}

}  // namespace thimble::render
