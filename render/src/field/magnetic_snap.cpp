#include "field/magnetic_snap.h"

#include <algorithm>
#include <numbers>
#include <string>

namespace thimble::render {
namespace {

constexpr std::size_t kTargetsMax = 64;  // [chosen: below a microsecond per tick]
constexpr NumberLimits kPlace{.unit = "m", .min = -2, .max = 2, .required = true};

void read_target(SettingsReader& reader, MagneticSnap::Settings::Target& target) {
  const bool line = reader.has("from") || reader.has("to");
  if (line == reader.has("point")) {
    reader.reject("", "expected either point, or from and to");
    reader.explain_unused("to", "cannot be used with point");
  } else if (line) {
    reader.vector("from", target.from_O, kPlace);
    reader.vector("to", target.to_O, kPlace);
  } else {
    reader.vector("point", target.from_O, kPlace);
    target.to_O = target.from_O;
  }
  // Larger than any desk-top arm [DEVICES 3]; catches misplaced decimal points.
  reader.number("force", target.force, {.unit = "N", .min = 0, .max = 50, .required = true});
  reader.number("capture_radius", target.radius,
                {.unit = "m", .min = 1e-4, .max = 1, .required = true});
}

}  // namespace

void MagneticSnap::Settings::read(SettingsReader& reader, const EffectContext&) {
  reader.list("targets",
              [this](SettingsReader& entry) { read_target(entry, targets.emplace_back()); });
  if (targets.size() > kTargetsMax) {
    reader.reject("targets",
                  "expected at most 64 targets, found " + std::to_string(targets.size()));
  }
}

MagneticSnap::MagneticSnap(const Settings& settings, const EffectContext& context) {
  for (const Settings::Target& target : settings.targets) {
    const Eigen::Vector3d way_W = context.R_WO * (target.to_O - target.from_O);
    const double square = way_W.squaredNorm();
    // The energy's gradient is stiffness * r * (1 - (r/R)^2), which peaks at
    // stiffness * R * 2 / (3 sqrt 3).
    targets_.push_back({.from_W = context.p_WO + context.R_WO * target.from_O,
                        .way_W = way_W,
                        .per_square = square > 0 ? 1 / square : 0,
                        .stiffness = 1.5 * std::numbers::sqrt3 * target.force / target.radius,
                        .square = target.radius * target.radius});
  }
}

double MagneticSnap::left_of(const Target& target, const Eigen::Vector3d& p_WT,
                             Eigen::Vector3d& away_W) noexcept {
  const Eigen::Vector3d s_W = p_WT - target.from_W;
  const double share = std::clamp(s_W.dot(target.way_W) * target.per_square, 0.0, 1.0);
  away_W = s_W - share * target.way_W;
  return 1 - away_W.squaredNorm() / target.square;
}

Eigen::Vector3d MagneticSnap::force(const driver::DeviceState& state) const noexcept {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d away_W;
  for (const Target& target : targets_) {
    const double left = left_of(target, state.p_WT, away_W);
    // Written so that NaN counts as beyond the radius.
    if (left > 0) sum -= target.stiffness * left * away_W;
  }
  return sum;
}

double MagneticSnap::potential(const driver::DeviceState& state) const noexcept {
  double sum = 0;
  Eigen::Vector3d away_W;
  for (const Target& target : targets_) {
    const double left = left_of(target, state.p_WT, away_W);
    if (left > 0) sum -= target.stiffness * target.square / 4 * left * left;
  }
  return sum;
}

}  // namespace thimble::render
