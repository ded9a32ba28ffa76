#include "thimble/render/body/shape_choice.h"

#include <cmath>
#include <string>

#include "body/shape/print_refinement.h"
#include "body/shape/snap_base.h"

namespace thimble::render {
namespace {

// Bounds of a scene's numbers catch misplaced decimal points; they are far outside the range of a
// desk-top arm [DEVICES 3].
constexpr double kForceMax = 100;    // N
constexpr double kSpeedMax = 100;    // m/s
constexpr double kLengthMax = 1;     // m
constexpr double kLengthMin = 1e-5;  // m
constexpr double kRounding = 1e-12;  // of a limit that a scene gives in decimals

bool positive(double x) {
  return x > 0 && std::isfinite(x);
}

}  // namespace

// All comparisons are written so that NaN is refused.

void ClayChoice::read(SettingsReader& reader) {
  reader.number("yield_force", yield_force, {.unit = "N", .min = 0, .max = kForceMax});
  reader.number("radius", radius, {.unit = "m", .min = kLengthMin, .max = kLengthMax});
  if (reader.has("flow_rate")) {
    flow_rate = 0;
    reader.number("flow_rate", flow_rate, {.unit = "m/s", .min = 1e-6, .max = kSpeedMax});
  }
  if (reader.has("movement_limit")) {
    movement_limit = 0;
    reader.number("movement_limit", movement_limit, {.unit = "m", .min = 0, .max = kLengthMax});
  }
  if (reader.has("edge")) {
    edge = 0;
    reader.number("edge", edge,
                  {.unit = "m", .min = radius / PrintRefinement::kFinest, .max = kLengthMax});
  }
  std::size_t volume = keeps_volume ? 1 : 0;
  reader.choice("volume", volume, {"free", "kept"});
  keeps_volume = volume == 1;
  if (!reader.has("triangles")) return;
  double count = triangles;
  reader.number("triangles", count, {.unit = "", .min = 4, .max = kTrianglesMax, .whole = true});
  if (!(edge > 0))
    reader.reject("triangles", "needs edge, the length to which triangles are split");
  triangles = static_cast<int>(count);
}

driver::Result<void> ClayChoice::check() const {
  // Values without an upper limit may be infinite.
  if (!(yield_force >= 0) || !std::isfinite(yield_force)) {
    return driver::Error{"Clay needs a yield_force of 0 N or more."};
  }
  if (!(flow_rate > 0)) return driver::Error{"Clay needs a flow_rate above 0 m/s."};
  if (!(movement_limit >= 0)) return driver::Error{"Clay needs a movement_limit of 0 m or more."};
  if (!(radius > 0) || !std::isfinite(radius)) {
    return driver::Error{"Clay needs a radius above 0 m."};
  }
  if (!(edge == 0 ||
        (edge >= (1 - kRounding) * radius / PrintRefinement::kFinest && std::isfinite(edge)))) {
    return driver::Error{
        "Clay needs an edge of at least a sixteenth of its radius, or 0 to split no triangles."};
  }
  if (!(triangles >= 4 && triangles <= kTrianglesMax)) {
    return driver::Error{"Clay that splits its triangles needs a limit of 4 to 1000000 triangles."};
  }
  return {};
}

void SnapChoice::read(SettingsReader& reader) {
  reader.number("force", force, {.unit = "N", .min = 1e-3, .max = kForceMax});
  reader.number("depth", depth, {.unit = "m", .min = kLengthMin, .max = kLengthMax});
  reader.number("radius", radius, {.unit = "m", .min = kLengthMin, .max = kLengthMax});
  reader.number("speed", speed, {.unit = "m/s", .min = 1e-3, .max = kSpeedMax});
  double count = panels;
  reader.number("panels", count, {.unit = "", .min = 1, .max = kPanelsMax, .whole = true});
  panels = static_cast<int>(count);
  if (!(radius > depth / 2)) {
    reader.reject("radius", "must be more than half the depth, or the wall would fold");
  }
}

driver::Result<void> SnapChoice::check() const {
  if (!positive(force)) return driver::Error{"A wall that snaps needs a force above 0 N."};
  if (!positive(depth)) return driver::Error{"A wall that snaps needs a depth above 0 m."};
  if (!positive(radius) || !(radius > depth / 2)) {
    return driver::Error{
        "A wall that snaps needs a radius of more than half its depth, or it would fold."};
  }
  if (!positive(speed)) return driver::Error{"A wall that snaps needs a speed above 0 m/s."};
  if (panels < 1 || panels > kPanelsMax) {
    return driver::Error{"A wall can have 1 to " + std::to_string(kPanelsMax) + " snapped panels."};
  }
  return {};
}

SnapSettings SnapChoice::truss() const {
  // The load is proportional to the bars' stiffness.
  const double per_stiffness = SnapTruss(radius, depth / 2, 1).limit_load();
  return {.half_span = radius,
          .rise = depth / 2,
          .bar_stiffness = force / per_stiffness,
          .speed_max = speed};
}

}  // namespace thimble::render
