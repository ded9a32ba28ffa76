#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "mesh/smooth_normals.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/straight_walk.h"
#include "studies/accuracy/stroked_ring.h"
#include "studies/cost/cost_subjects.h"
#include "track/edge_blending.h"

namespace thimble::studies {
namespace {

using render::BlendingChoice;
using render::BlendProfile;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kBentAcross = 32;  // edges around the tube: 4 mm long, 11 degrees between two faces
constexpr double kWalk = 0.2;    // m, across about 70 triangles

/// A ring with a shading of its triangles, for the walk.
struct ShadedRing {
  ShadedRing()
      : mesh(render::ContactMesh::build(kCostRing.mesh(2 * kBentAcross, kBentAcross)).value()),
        normals(mesh) {}
  render::ContactMesh mesh;
  render::SmoothNormals normals;
};

// Returns the largest change of the normal's rotation per length between two ticks of a straight
// walk with this step (m), degrees per mm.
template <class Shading>
double rate_jump(const Shading& shading, double step) {
  static const ShadedRing ring;
  StraightWalk walk(ring.mesh, 40, {0.3, 1, 0.2});
  const auto next = [&] {
    walk.advance(step);
    return shading.normal(ring.mesh, ring.normals, walk.triangle(), walk.weights());
  };
  Eigen::Vector3d before = next();
  Eigen::Vector3d here = next();
  double largest = 0;
  for (double gone = 0; gone < kWalk; gone += step) {
    const Eigen::Vector3d after = next();
    largest = std::max(largest, (after - 2 * here + before).norm() / step);
    before = std::exchange(here, after);
  }
  return 1e-3 * kDegrees * largest;
}

RingTouch banded_ring(BlendingChoice blending, BlendProfile profile, double band) {
  RingTouch ring;
  ring.choice.tracker = render::TrackerChoice::kEdgePlanes;
  ring.choice.blending = blending;
  if (blending != BlendingChoice::kPhong) ring.choice.profile = profile;
  ring.choice.band = band;
  ring.across = kBentAcross;
  return ring;
}

constexpr double kBands[] = {0.1, 0.2, 0.5, 1, 2, 4};  // mm
constexpr double kSteps[] = {1, 3, 10, 30, 100, 300};  // um

struct Way {
  const char* name;
  const char* title;
  BlendProfile profile;
};
constexpr Way kProfiles[] = {
    {"linear", "band with the linear profile [BP Fig. 5]", BlendProfile::kLinear},
    {"smooth", "band with the smooth profile", BlendProfile::kSmooth},
};

AccuracyLine rate_line(const std::string& name, const std::string& title,
                       std::optional<double> order, const RingTouch& ring,
                       double (*error)(double step)) {
  AccuracyLine line{.name = name, .title = title, .order = order};
  for (const double um : kSteps) {
    AccuracyPoint point{.name = std::to_string(static_cast<int>(um)) + "um",
                        .knob = um,
                        .error = [=] { return error(1e-6 * um); },
                        .prepare = [ring] { return ring_work(ring); }};
    point.ticks = kRingTicks;
    point.fits = um <= 30;  // beyond, a step is no small part of a band
    line.points.push_back(std::move(point));
  }
  return line;
}

}  // namespace

AccuracyAxis profile_axis() {
  AccuracyAxis axis;
  axis.name = "profile";
  axis.title = "Profiles of a blended band: direction, on edges of a fifth of the radius";
  axis.knob = "width of the band";
  axis.knob_unit = "mm";
  axis.metric = "direction error, 99th percentile";
  axis.unit = "degrees";
  axis.truth =
      "The exact ring (torus): the normal of each point in closed form, stroked by "
      "the same states.";
  axis.threshold = 5;  // [PHYSICS 6]
  axis.threshold_words = "a quarter of the noticeable change of direction (5 degrees)";
  axis.default_words =
      "A band reproduces the method of the paper. Scenes without the key blending "
      "have none.";
  axis.left_out =
      "How evenly the direction turns, which is the purpose of a smooth profile: see "
      "the next diagram.";
  for (const Way& way : kProfiles) {
    AccuracyLine line{.name = way.name, .title = way.title};
    for (const double mm : kBands) {
      const RingTouch ring = banded_ring(BlendingChoice::kFixedBand, way.profile, 1e-3 * mm);
      AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * mm)) + "um",
                          .knob = mm,
                          .error = [ring] { return kDegrees * ring_errors(ring).direction_p99; },
                          .prepare = [ring] { return ring_work(ring); }};
      point.ticks = kRingTicks;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

AccuracyAxis profile_rate_axis() {
  AccuracyAxis axis;
  axis.name = "profile_rate";
  axis.title = "Profiles of a blended band: how evenly the normal turns";
  axis.knob = "path of the tip per tick";
  axis.knob_unit = "um";
  axis.metric = "largest jump of the turning rate";
  axis.unit = "degrees per mm";
  axis.truth =
      "With shorter ticks, the jump of a continuous rate shrinks (slope 1), the jump "
      "of a discontinuous rate stays (slope 0), and a discontinuous normal has no "
      "finite rate (slope -1).";
  axis.felt_words =
      "No threshold for a jump of the turning rate has been published. A band of 1 "
      "mm turns by half the angle between two faces.";
  axis.default_words =
      "A band reproduces the method of the paper. Scenes without the key blending "
      "have none.";
  axis.left_out =
      "Curved paths of the hand: this one is straight on the surface, so that only "
      "the shading turns the normal.";
  const auto ring = [](BlendProfile profile) {
    return banded_ring(BlendingChoice::kFixedBand, profile, 0.001);
  };
  axis.lines.push_back(rate_line(
      "flat", "flat faces", -1,
      [] {
        RingTouch flat = banded_ring(BlendingChoice::kPhong, BlendProfile::kLinear, 0.001);
        flat.choice.blending = BlendingChoice::kFlat;
        return flat;
      }(),
      [](double step) { return rate_jump(render::Flat(), step); }));
  axis.lines.push_back(rate_line(
      "linear", "band of 1 mm, linear profile [BP Fig. 5]", 0, ring(BlendProfile::kLinear),
      [](double step) { return rate_jump(render::FixedBand{.width = 0.001}, step); }));
  axis.lines.push_back(rate_line(
      "smooth", "band of 1 mm, smooth profile", 1, ring(BlendProfile::kSmooth), [](double step) {
        return rate_jump(render::FixedBand{.width = 0.001, .profile = BlendProfile::kSmooth}, step);
      }));
  axis.lines.push_back(rate_line("phong", "Phong", 0,
                                 banded_ring(BlendingChoice::kPhong, BlendProfile::kLinear, 0.001),
                                 [](double step) { return rate_jump(render::Phong(), step); }));
  return axis;
}

}  // namespace thimble::studies
