#include <Eigen/Core>
#include <memory>
#include <string>

#include "body/dent/bendable_polygon.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/cost/cost_subjects.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr int kAround = 32, kAcross = 16;  // 512 vertices: the maximum that can move at once
constexpr int kTicks = 200;
constexpr std::int32_t kTriangle = 2;
constexpr double kPress = 0.003;  // m

/// A soft ring that is repeatedly pressed at the middle of a triangle and released.
class SoftRing {
 public:
  SoftRing(int rings, bool whole, double reach) : body_(build(rings, whole, reach)) {
    for (std::size_t k = 0; k < 3; ++k) middle_ += body_.mesh().position(kTriangle, k) / 3;
    n_ = body_.mesh().cell(kTriangle).face.n;
  }

  /// Advances by tick `tick` of the press and returns the force on the hand, N.
  Vector3d step(int tick) noexcept {
    const double share = static_cast<double>(tick % kTicks) / kTicks;
    const double depth = kPress * (share < 0.5 ? 2 * share : 2 - 2 * share);
    body_.touch(kTriangle, Vector3d::Constant(1.0 / 3), middle_ - depth * n_);
    return body_.f_T_W();
  }

 private:
  static render::BendablePolygon build(int rings, bool whole, double reach) {
    // Cannot fail: a ring is closed, and the settings are valid.
    auto mesh = render::ContactMesh::build(kCostRing.mesh(kAround, kAcross)).value();
    render::DentSettings settings;
    settings.rings = rings;
    settings.whole = whole;
    settings.reach = reach;
    settings.remainder = 1e-5;  // so that the number of rounds does not dominate
    return render::BendablePolygon::build(
               std::make_shared<const render::ContactMesh>(std::move(mesh)), settings)
        .value();
  }

  render::BendablePolygon body_;
  Vector3d middle_{0, 0, 0};
  Vector3d n_{0, 0, 1};
};

double error_of(int rings, double reach) {
  SoftRing some(rings, false, reach);
  SoftRing all(0, true, reach);
  double error = 0;
  double size = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    const Vector3d truth = all.step(tick);
    error = std::max(error, (some.step(tick) - truth).norm());
    size = std::max(size, truth.norm());
  }
  return 100 * error / size;
}

}  // namespace

AccuracyAxis rings_axis() {
  AccuracyAxis axis;
  axis.name = "rings";
  axis.title = "Size of the moving patch of a dent: rings of vertices around the hand";
  axis.knob = "moving rings";
  axis.metric = "largest force error";
  axis.unit = "% of the largest force";
  axis.truth =
      "The same body with every vertex moving (compared with dense eigenvalues in PhysicsOfDents).";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of force (3.5 %)";
  axis.default_words =
      "Three rings cover all of the dent that can be seen; for the force fewer would "
      "suffice.";
  axis.left_out =
      "The visible shape of a dent that ends too early: the diagram shows only the "
      "force.";
  struct Reach {
    const char* name;
    const char* title;
    double reach;
  };
  for (const Reach& reach : {Reach{"even", "even springs", 1}, Reach{"wide", "wide dent", 4}}) {
    AccuracyLine line{.name = reach.name, .title = reach.title, .order = {}, .points = {}};
    for (int rings = 0; rings <= 6; ++rings) {
      const double by = reach.reach;
      line.points.push_back({.name = std::to_string(rings),
                             .knob = static_cast<double>(rings),
                             .error = [=] { return error_of(rings, by); },
                             .prepare = [=]() -> Stroke {
                               const auto ring = std::make_shared<SoftRing>(rings, false, by);
                               return [ring] {
                                 double sum = 0;
                                 for (int tick = 0; tick < kTicks; ++tick) {
                                   sum += ring->step(tick).x();
                                 }
                                 return sum;
                               };
                             },
                             .ticks = kTicks,
                             .is_default = by == 1 && rings == render::DentSettings{}.rings,
                             .law = {}});
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::studies
