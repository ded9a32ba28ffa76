#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>

#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/stroked_ring.h"

namespace thimble::studies {
namespace {

using render::BlendingChoice;
using render::TrackerChoice;

constexpr int kAcross[] = {8, 12, 16, 24, 32, 48, 64};
// Coarser rings have places without contact, where the force has no direction.
constexpr int kAcrossTouched[] = {24, 28, 32, 40, 48, 56, 64};
constexpr int kDefaultAcross = 32;
// Orders are visible only if triangles are much smaller than the curvature.
constexpr int kFitsFrom = 24;

struct Way {
  const char* name;
  const char* title;
  TrackerChoice tracker;
  std::optional<BlendingChoice> blending;
  std::optional<bool> curved;
  double force_order;  // 0: no expected order
  double direction_order;
};

// The flat normal deviates by up to L / R within a triangle; the smooth normal and the depth below
// the triangles by (L / R)^2 [PHYSICS 3]. The flat force contains both errors, and the depth below
// the smooth surface is better where triangles are similar, so no order is expected of either. Nor
// of the 99th percentile of smooth directions, which depends on few places.
constexpr Way kWays[] = {
    {"flat", "flat", TrackerChoice::kEdgePlanes, BlendingChoice::kFlat, false, 0, 1},
    {"band", "blended band", TrackerChoice::kEdgePlanes, BlendingChoice::kSizedBand, false, 2, 0},
    {"phong", "Phong", TrackerChoice::kEdgePlanes, BlendingChoice::kPhong, false, 2, 0},
    {"curved", "Phong, curved depth", TrackerChoice::kEdgePlanes, BlendingChoice::kPhong, true, 0,
     0},
    {"offset", "offset", TrackerChoice::kOffset, {}, {}, 0, 0},
    {"compact", "compact", TrackerChoice::kPacked, {}, {}, 0, 0},
};

// Returns whether this is the default of a scene without settings: the first line of each tracker
// has no blending.
bool is_product_default(const Way& way) {
  return way.tracker == render::ContactChoice{}.tracker &&
         way.blending.value_or(BlendingChoice::kFlat) == BlendingChoice::kFlat;
}

RingTouch ring_of(const Way& way, int across) {
  RingTouch ring;
  ring.choice.tracker = way.tracker;
  ring.choice.blending = way.blending;
  ring.choice.curved_depth = way.curved;
  ring.across = across;
  return ring;
}

enum class Wrong { kForce, kDirection, kJump };

AccuracyAxis axis_of(Wrong wrong) {
  const bool direction = wrong != Wrong::kForce;
  AccuracyAxis axis;
  axis.knob = "edge length over radius of curvature, L/R";
  axis.truth =
      "The exact ring (torus): depth and normal of each point in closed form, "
      "stroked by the same states.";
  axis.default_words =
      "It is the method of the paper. On a scan with edges of a tenth of the radius, "
      "its direction error cannot be felt, and it does not depend on the normals of "
      "the mesh. --quality reference uses Phong with curved depth.";
  for (const Way& way : kWays) {
    AccuracyLine line{.name = way.name, .title = way.title, .order = {}, .points = {}};
    const double order = wrong == Wrong::kJump ? 0
                         : direction           ? way.direction_order
                                               : way.force_order;
    if (order > 0) line.order = order;
    for (const int across : direction ? std::span<const int>(kAcrossTouched) : std::span(kAcross)) {
      const RingTouch ring = ring_of(way, across);
      AccuracyPoint point{.name = std::to_string(across),
                          .knob = edge_over_radius(across),
                          .error = {},
                          .prepare = [ring] { return ring_work(ring); }};
      point.error = [ring, wrong] {
        const RingErrors errors = ring_errors(ring);
        if (wrong == Wrong::kForce) return 100 * errors.force;
        const double angle = wrong == Wrong::kJump ? errors.jump : errors.direction_p99;
        return angle * 180 / std::numbers::pi;
      };
      point.ticks = kRingTicks;
      point.is_default = is_product_default(way) && across == kDefaultAcross;
      point.fits = across >= kFitsFrom;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace

AccuracyAxis tessellation_axis() {
  AccuracyAxis axis = axis_of(Wrong::kForce);
  axis.name = "tessellation";
  axis.title = "Mesh resolution by contact method: force";
  axis.metric = "force error, RMS";
  axis.unit = std::string("%");
  axis.threshold = 3.5;  // half of 7 % [PHYSICS 6, after Pang, Tan, Durlach 1991]
  axis.threshold_words = "half the noticeable change of force (3.5 %)";
  axis.left_out =
      "Other shapes: the ring has an exact reference on its concave and convex "
      "sides. Sharp edges and deep presses, where trackers differ.";
  return axis;
}

AccuracyAxis tessellation_direction_axis() {
  AccuracyAxis axis = axis_of(Wrong::kDirection);
  axis.name = "tessellation_direction";
  axis.title = "Mesh resolution by contact method: direction";
  axis.metric = "direction error, 99th percentile";
  axis.unit = "degrees";
  axis.threshold = 5;  // [PHYSICS 6]
  axis.threshold_words = "a quarter of the noticeable change of direction (5 degrees)";
  axis.left_out = "Jumps from tick to tick over edges: see the next diagram.";
  return axis;
}

AccuracyAxis tessellation_jump_axis() {
  AccuracyAxis axis = axis_of(Wrong::kJump);
  axis.name = "tessellation_jump";
  axis.title = "Mesh resolution by contact method: jumps over edges";
  axis.metric = "largest turn of the force in a tick";
  axis.unit = "degrees";
  axis.truth =
      "The exact ring, on which the same stroke turns the force by at most 0.2 "
      "degrees in a tick. This turn is subtracted.";
  axis.threshold = 5;  // [PHYSICS 6]
  axis.threshold_words = "a quarter of the noticeable change of direction (5 degrees)";
  axis.default_words =
      "It is the method of the paper. Edges of a tenth of the radius turn the force "
      "by 6 degrees, a third of the change that a hand can notice without sight (18 "
      "degrees). With any blending the turn is less than one degree.";
  axis.left_out = "Faster strokes, which cross the same edges in fewer ticks.";
  return axis;
}

}  // namespace thimble::studies
