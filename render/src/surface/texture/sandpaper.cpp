#include "surface/texture/sandpaper.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "math/elementary.h"

namespace thimble::render {
namespace {

// Enough for heights distributed like noise, at 800 instructions per tick. [chosen]
constexpr int kWaves = 16;

std::vector<Wave> random_waves(const Sandpaper::Settings& settings, const EffectContext& context) {
  // Only the raw bits of the twister are the same with every standard library.
  std::mt19937_64 bits(static_cast<std::uint64_t>(settings.seed));
  const auto uniform = [&bits] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    // Uniform over the sphere, because height and longitude are uniform.
    const double z = 2 * uniform() - 1;
    const double turn = 2 * std::numbers::pi * uniform();
    const double across = std::sqrt(1 - z * z);
    const Eigen::Vector3d direction_O(across * math::cos(turn), across * math::sin(turn), z);
    const double wavelength = settings.wavelength * math::exp2(uniform() - 0.5);
    const Eigen::Vector3d k_M = 2 * std::numbers::pi / wavelength * (context.R_WO * direction_O);
    const double phase = 2 * std::numbers::pi * uniform();
    // A sine's mean square is half its squared amplitude; those of different waves add.
    waves.push_back(
        {settings.roughness * std::sqrt(2.0 / kWaves), k_M, phase - k_M.dot(context.p_WO)});
  }
  return waves;
}

}  // namespace

void Sandpaper::Settings::read(SettingsReader& reader, const EffectContext& context) {
  TextureSettings::read(reader);
  reader.number("wavelength", wavelength, {.unit = "m", .min = 1e-5, .max = 0.1});
  reader.number("roughness", roughness, {.unit = "m", .min = 0, .max = 0.01});
  reader.number("seed", seed, {.unit = "", .min = 0, .max = 0x1p53, .whole = true});
  if (!(wavelength > 0)) return;
  check_texture(reader, "roughness", extent(), *this, context);
}

TextureExtent Sandpaper::Settings::extent() const noexcept {
  const double amplitude = roughness * std::sqrt(2.0 / kWaves);
  return {.relief = 2 * kWaves * amplitude,
          .slope = 2 * std::numbers::pi * roughness / wavelength,
          .wavelength = wavelength / std::numbers::sqrt2};
}

Sandpaper::Sandpaper(const Settings& settings, const EffectContext& context)
    : height_(random_waves(settings, context)),
      form_(settings.form),
      roughness_(settings.roughness),
      max_roughness_(settings.roughness * texture_headroom(settings.extent(), context)),
      extent_(settings.extent()) {}

void Sandpaper::set_roughness(double roughness) noexcept {
  height_.scale(roughness / roughness_);
  roughness_ = roughness;
}

void Sandpaper::list_settings(LiveSettings& settings) {
  // By factors, which zero would lose: a fiftieth is not felt any more.
  ForceSensitivity sensitivity = texture_lever(extent_);
  sensitivity.per_force /= roughness_;
  sensitivity.per_stiffness /= roughness_;
  if (!(roughness_ > 0)) return;
  settings.add<[](Sandpaper& paper, double roughness) noexcept { paper.set_roughness(roughness); }>(
      *this, {.name = "roughness",
              .unit = "m",
              .min = roughness_ / 50,
              .max = max_roughness_,
              .value = roughness_,
              .sensitivity = sensitivity});
}

}  // namespace thimble::render
