#include "surface/texture/sines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thimble::render {
namespace {

// Bounds catch misplaced decimal points; the total effect is checked separately.
constexpr double kAmplitudeMax = 0.05;                       // m
constexpr double kWavelengthMin = 1e-5, kWavelengthMax = 1;  // m
constexpr std::size_t kWavesMax = 64;  // 12,000 instructions per tick [chosen: a few us]

std::vector<Wave> waves_of(const Sines::Settings& settings, const EffectContext& context) {
  std::vector<Wave> waves;
  for (const Sines::Settings::One& one : settings.waves) {
    const Eigen::Vector3d k_M =
        2 * std::numbers::pi / one.wavelength * (context.R_WO * one.direction.stableNormalized());
    // Waves begin at the object's place, so that it can be moved without a change.
    waves.push_back({one.amplitude, k_M, one.phase - k_M.dot(context.p_WO)});
  }
  return waves;
}

void read_wave(SettingsReader& reader, Sines::Settings::One& wave) {
  reader.number("amplitude", wave.amplitude,
                {.unit = "m", .min = 0, .max = kAmplitudeMax, .required = true});
  double frequency = 0;
  if (reader.has("wavelength") == reader.has("frequency")) {
    reader.reject("", "expected either wavelength (m) or frequency (waves per metre)");
  } else if (reader.has("wavelength")) {
    reader.number("wavelength", wave.wavelength,
                  {.unit = "m", .min = kWavelengthMin, .max = kWavelengthMax, .required = true});
  } else {
    reader.number(
        "frequency", frequency,
        {.unit = "1/m", .min = 1 / kWavelengthMax, .max = 1 / kWavelengthMin, .required = true});
    if (frequency > 0) wave.wavelength = 1 / frequency;
  }
  reader.vector("direction", wave.direction, {.unit = "", .min = -1e3, .max = 1e3});
  reader.number("phase", wave.phase, {.unit = "rad", .min = -10, .max = 10});
  if (!(wave.direction.stableNorm() > 0)) {
    reader.reject("direction", "expected a direction, found zeros");
  }
}

}  // namespace

void Sines::Settings::read(SettingsReader& reader, const EffectContext& context) {
  TextureSettings::read(reader);
  reader.list("waves", [this](SettingsReader& entry) {
    waves.emplace_back();
    read_wave(entry, waves.back());
  });
  if (waves.size() > kWavesMax) {
    reader.reject("waves", "expected at most 64 waves, found " + std::to_string(waves.size()));
  }
  for (const One& wave : waves) {
    if (!(wave.wavelength > 0)) return;  // refused already
  }
  check_texture(reader, "waves", extent(), *this, context);
}

TextureExtent Sines::Settings::extent() const noexcept {
  TextureExtent extent{.wavelength = kWavelengthMax};
  for (const One& wave : waves) {
    extent.relief += 2 * wave.amplitude;
    extent.slope += 2 * std::numbers::pi * wave.amplitude / wave.wavelength;
    extent.wavelength = std::min(extent.wavelength, wave.wavelength);
  }
  return extent;
}

Sines::Sines(const Settings& settings, const EffectContext& context)
    : height_(waves_of(settings, context)),
      form_(settings.form),
      max_gain_(texture_headroom(settings.extent(), context)),
      extent_(settings.extent()) {}

void Sines::set_gain(double gain) noexcept {
  height_.scale(gain / gain_);
  gain_ = gain;
}

void Sines::list_settings(LiveSettings& settings) {
  // By factors, which zero would lose: a fiftieth is not felt any more.
  settings.add<[](Sines& sines, double gain) noexcept { sines.set_gain(gain); }>(
      *this, {.name = "gain",
              .unit = "",
              .min = 0.02,
              .max = max_gain_,
              .value = 1,
              .sensitivity = texture_lever(extent_)});
}

}  // namespace thimble::render
