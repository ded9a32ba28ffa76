#include "view/overlays/force_marks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace thimble::view {
namespace {

constexpr double kWeakest = 0.06;  // of the strongest force; weaker arrows are omitted [chosen]

/// Returns the spacing of a field's samples, m: the maximum length of an arrow.
double spacing(const std::vector<FieldSample>& field) {
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < field.size(); ++i) {
    const double apart = (field[i].p_W - field[i - 1].p_W).norm();
    if (apart > 1e-9) min = std::min(min, apart);
  }
  return std::isfinite(min) ? min : 0.01;
}

double strongest_of(const std::vector<FieldSample>& field) {
  double max = 0;
  for (const FieldSample& sample : field) max = std::max(max, sample.f_W.norm());
  return max;
}

}  // namespace

Colour force_colour(double share) {
  const float s = static_cast<float>(std::clamp(share, 0.0, 1.0));
  const auto mix = [](const Colour& a, const Colour& b, float t) {
    return Colour{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
  };
  return s < 0.5F ? mix(kDepthColour, kProxyColour, 2 * s)
                  : mix(kProxyColour, kForceColour, 2 * s - 1);
}

double strongest_force(const DrawnScene& scene, const DrawnMoment& moment) {
  double max = strongest_of(scene.field);
  for (const TrailPoint& point : moment.trail) max = std::max(max, point.force);
  if (!(max > 1e-6) || !std::isfinite(max)) return 0;
  const double power = std::pow(10, std::floor(std::log10(max)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (max <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

void add_field(const DrawnScene& scene, double strongest, ColouredMesh& mesh) {
  const double max = strongest_of(scene.field);
  if (!(max > 0) || !(strongest > 0)) return;
  const double apart = spacing(scene.field);
  for (const FieldSample& sample : scene.field) {
    const double force = sample.f_W.norm();
    if (!(force > kWeakest * max)) continue;
    const double length = 0.9 * apart * std::pow(force / max, 0.7);
    const Eigen::Vector3d half = 0.5 * length / force * sample.f_W;
    add_arrow(sample.p_W - half, sample.p_W + half, 0.022 * apart, force_colour(force / strongest),
              mesh);
  }
}

void add_trail(std::span<const TrailPoint> trail, double strongest, double radius,
               ColouredMesh& mesh) {
  std::vector<Eigen::Vector3d> points;
  std::vector<Colour> colours;
  for (const TrailPoint& point : trail) {
    points.push_back(point.p_WT);
    colours.push_back(force_colour(strongest > 0 ? point.force / strongest : 0));
  }
  add_tube(points, colours, radius, mesh);
}

}  // namespace thimble::view
