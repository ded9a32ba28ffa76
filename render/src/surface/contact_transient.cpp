#include "surface/contact_transient.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/elementary.h"

namespace thimble::render {
namespace {

/// Smallest number of ticks of a period that is felt as a vibration and not as single steps
/// [chosen].
constexpr double kTicksMin = 4;
/// Share of the amplitude below which the vibration has ended [chosen: 10 mN of 10 N].
constexpr double kEnd = 1e-3;

}  // namespace

void ContactTransient::Settings::read(SettingsReader& reader, const EffectContext& context) {
  reader.number("gain", gain, {.unit = "N s/m", .min = 0, .max = kGainMax});
  reader.number("frequency", frequency, {.unit = "Hz", .min = 20, .max = 1000});
  reader.number("decay", decay, {.unit = "s", .min = 0.001, .max = 0.2});
  if (frequency * context.tick * kTicksMin > 1) {
    reader.reject(
        "frequency",
        "must not be above a quarter of the loop's rate, because a period needs four ticks");
  }
}

ContactTransient::ContactTransient(const Settings& settings, const EffectContext& context)
    : gain_(settings.gain) {
  const double angle = 2 * std::numbers::pi * settings.frequency * context.tick;
  const double fade = math::exp(-context.tick / settings.decay);
  const double first_fade = math::exp(-0.5 * context.tick / settings.decay);
  first_cos_ = first_fade * math::cos(0.5 * angle);
  first_sin_ = first_fade * math::sin(0.5 * angle);
  step_cos_ = fade * math::cos(angle);
  step_sin_ = fade * math::sin(angle);
}

void ContactTransient::touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept {
  const Eigen::Vector3d& n_W = response.contact.n_W;
  if (!touching_) {
    touching_ = true;
    const double speed = -state.v_WT.dot(n_W);
    amplitude_ = gain_ * speed;
    // Written so that NaN starts nothing.
    rings_ = speed > 0 && amplitude_ < HUGE_VAL;
    cos_ = first_cos_;
    sin_ = first_sin_;
  }
  if (!rings_) return;
  const double pressure = response.f_T_W.dot(n_W);
  const double change = std::max(amplitude_ * sin_, -std::max(pressure, 0.0));
  response.f_T_W += change * n_W;
  const double turned = step_cos_ * cos_ - step_sin_ * sin_;
  sin_ = step_sin_ * cos_ + step_cos_ * sin_;
  cos_ = turned;
  rings_ = std::max(std::abs(cos_), std::abs(sin_)) > kEnd;
}

void ContactTransient::list_settings(LiveSettings& settings) {
  // Amplitudes of a contact that has begun do not change, so the force has no step.
  settings.add<[](ContactTransient& stage, double gain) noexcept { stage.gain_ = gain; }>(
      *this, {.name = "gain", .unit = "N s/m", .min = 0, .max = kGainMax, .value = gain_});
}

}  // namespace thimble::render
