#include "share/live_knobs.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

namespace thimble::session {
namespace {

// Friction is at most sqrt(3) times the force of the surface, at a right angle to it. So their sum
// changes by at most twice the change of the surface's force.
constexpr double kWithFriction = 2;

double length(const std::array<double, 3>& v) noexcept {
  return Eigen::Map<const Eigen::Vector3d>(v.data()).norm();
}

}  // namespace

LiveKnobs::LiveKnobs(const scene::Scene& scene, render::SceneTouch& touch) {
  const scene::DeclaredLimits& declared = scene.arms.front().arm.declared;
  for (std::size_t i = 0; i < touch.size() && knobs_.size() <= kKnobsMax; ++i) {
    render::LiveSettings settings(declared.stiffness, declared.damping);
    touch.object(i).list_settings(settings);
    std::ptrdiff_t stiffness = -1;
    for (const render::LiveSetting& setting : settings.list()) {
      if (setting.name == "stiffness") stiffness = static_cast<std::ptrdiff_t>(knobs_.size());
      Knob knob{.name = scene.objects[i].name + ": " + setting.name,
                .setting = setting,
                .now = setting.value,
                .target = setting.value};
      // An object may have two effects of one kind; their names get numbers.
      const auto taken = [&](const std::string& name) {
        return std::any_of(knobs_.begin(), knobs_.end(),
                           [&](const Knob& other) { return other.name == name; });
      };
      const std::string first = knob.name;
      for (int number = 2; taken(knob.name); ++number) {
        knob.name = first + " " + std::to_string(number);
      }
      knobs_.push_back(std::move(knob));
    }
    for (Knob& knob : knobs_) {
      if (knob.name.starts_with(scene.objects[i].name + ": ")) knob.stiffness = stiffness;
    }
  }
  if (knobs_.size() > kKnobsMax) knobs_.resize(kKnobsMax);
}

std::vector<SharedScene::Knob> LiveKnobs::described() const {
  std::vector<SharedScene::Knob> described;
  for (const Knob& knob : knobs_) {
    described.push_back({.name = knob.name,
                         .unit = knob.setting.unit,
                         .min = knob.setting.min,
                         .max = knob.setting.max,
                         .initial = knob.setting.value});
  }
  return described;
}

bool LiveKnobs::step(KnobRequests& requests, const KnobTick& last, double dt) noexcept {
  bool turning = false;
  change_ = {};
  for (std::size_t i = 0; i < knobs_.size(); ++i) {
    const double wanted = requests.knob_wanted(i).value_or(knobs_[i].target);
    if (wanted == knobs_[i].target) continue;
    turning = true;
    if (change_.setting != driver::TickRecord::kNoSetting)
      break;  // the next tick starts this change
    knobs_[i].target = wanted;
    change_.setting = static_cast<std::int16_t>(i);
    change_.value = wanted;
  }
  for (std::size_t i = 0; i < knobs_.size(); ++i) {
    Knob& knob = knobs_[i];
    if (knob.target == knob.now) continue;
    turning = true;
    const render::ForceSensitivity& sensitivity = knob.setting.sensitivity;
    const double stiffness =
        knob.stiffness >= 0 && static_cast<std::size_t>(knob.stiffness) < knobs_.size()
            ? knobs_[static_cast<std::size_t>(knob.stiffness)].now
            : 0;
    const double newtons =
        std::abs(sensitivity.per_depth * last.depth) + sensitivity.per_speed * length(last.v_WT) +
        sensitivity.per_force * length(last.f_wanted_W) +
        (last.in_contact ? sensitivity.per_stiffness * stiffness : 0) + sensitivity.always;
    double max_step = (knob.setting.max - knob.setting.min) * dt / kTurnTime;
    // Written so that NaN changes nothing.
    if (!(newtons >= 0)) continue;
    if (newtons > 0) max_step = std::min(max_step, kForceRate / kWithFriction * dt / newtons);
    const double way = knob.target - knob.now;
    // Ends exactly at the requested value.
    knob.now = std::abs(way) <= max_step ? knob.target : knob.now + std::copysign(max_step, way);
    knob.setting.set(knob.setting.stage, knob.now);
    requests.store_knob(i, knob.now);
  }
  return turning;
}

}  // namespace thimble::session
