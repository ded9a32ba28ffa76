#include "field/point_charges.h"

#include <numbers>

namespace thimble::render {
namespace {

constexpr std::size_t kChargesMax = 64;  // [chosen: below a microsecond per tick]

}  // namespace

void PointCharges::Settings::read(SettingsReader& reader, const EffectContext&) {
  reader.list("charges", [this](SettingsReader& entry) {
    One& one = charges.emplace_back();
    entry.vector("position", one.p_O, {.unit = "m", .min = -2, .max = 2, .required = true});
    // Larger than any desk-top arm [DEVICES 3]; catches misplaced decimal points.
    entry.number("force", one.force, {.unit = "N", .min = -50, .max = 50, .required = true});
    entry.number("radius", one.radius, {.unit = "m", .min = 1e-4, .max = 1});
  });
  if (charges.size() > kChargesMax) {
    reader.reject("charges",
                  "expected at most 64 charges, found " + std::to_string(charges.size()));
  }
}

PointCharges::PointCharges(const Settings& settings, const EffectContext& context) {
  for (const Settings::One& one : settings.charges) {
    charges_.push_back({.p_W = context.p_WO + context.R_WO * one.p_O,
                        .strength = 1.5 * std::numbers::sqrt3 * one.force * one.radius * one.radius,
                        .radius = one.radius});
  }
}

}  // namespace thimble::render
