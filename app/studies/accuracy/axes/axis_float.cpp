#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/stroked_ring.h"
#include "studies/cost/cost_subjects.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr double kPlaces[] = {0.01, 0.1, 1, 3, 10, 30, 100};  // m

// Returns the force from the ring's exact depth and normal, computed in single precision
// throughout.
Vector3d single_force(const Eigen::Vector3f& p_W, const Eigen::Vector3f& centre,
                      const Eigen::Vector3f& v_W) {
  const Eigen::Vector3f p = p_W - centre;
  const Eigen::Vector3f ring =
      static_cast<float>(kCostRing.ring_radius) * Eigen::Vector3f(p.x(), p.y(), 0).normalized();
  const Eigen::Vector3f out = p - ring;
  const float depth = static_cast<float>(kCostRing.tube_radius) - out.norm();
  if (!(depth > 0)) return {0, 0, 0};
  const Eigen::Vector3f n = out.normalized();
  const float force = static_cast<float>(kCostSpring.stiffness) * depth -
                      static_cast<float>(kCostSpring.damping) * n.dot(v_W);
  return (std::max(force, 0.0F) * n).cast<double>();
}

std::vector<Vector3d> single_forces(double place) {
  const Vector3d centre(place, place, place);
  std::vector<Vector3d> forces;
  for (const auto& state : ring_states(centre)) {
    forces.push_back(
        single_force(state.p_WT.cast<float>(), centre.cast<float>(), state.v_WT.cast<float>()));
  }
  return forces;
}

// Returns the largest change of force relative to the same ring at the origin, in percent of the
// largest force.
double difference(const std::vector<Vector3d>& here, const std::vector<Vector3d>& at_origin) {
  double error = 0;
  double size = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    error = std::max(error, (here[i] - at_origin[i]).norm());
    size = std::max(size, at_origin[i].norm());
  }
  return 100 * error / size;
}

RingTouch ring_at(render::TrackerChoice tracker, double place) {
  RingTouch ring;
  ring.choice.tracker = tracker;
  ring.p_W = Vector3d(place, place, place);
  return ring;
}

}  // namespace

AccuracyAxis float_axis() {
  AccuracyAxis axis;
  axis.name = "float";
  axis.title =
      "Single and double precision: the same ring at growing distances from the "
      "origin";
  axis.knob = "offset of the ring along x, y and z";
  axis.knob_unit = "m";
  axis.metric = "largest force error";
  axis.unit = "% of the largest force";
  axis.truth = "The same tracker at the origin.";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of force (3.5 %)";
  axis.over_cost = false;
  axis.default_words =
      "Double precision costs the same per tick, so there is no choice to make. "
      "Where memory matters, `compact` stores corners relative to their surface in "
      "few bits.";
  axis.left_out =
      "The error over the cost: a tick takes the same time in both, because it waits "
      "for memory and square roots, not for the width of numbers (see the figures).";
  using render::TrackerChoice;
  struct Line {
    const char* name;
    const char* title;
    TrackerChoice tracker;
  };
  for (const Line& one : {Line{"double", "double: edge planes", TrackerChoice::kEdgePlanes},
                          Line{"offset", "double: offset", TrackerChoice::kOffset},
                          Line{"compact", "64-byte records: compact", TrackerChoice::kPacked}}) {
    AccuracyLine line{.name = one.name, .title = one.title};
    const TrackerChoice tracker = one.tracker;
    for (const double place : kPlaces) {
      AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * place)) + "mm",
                          .knob = place,
                          .error =
                              [=] {
                                return difference(forces_on(ring_at(tracker, place)),
                                                  forces_on(ring_at(tracker, 0)));
                              },
                          .prepare = [=] { return ring_work(ring_at(tracker, place)); }};
      point.ticks = kRingTicks;
      point.is_default = tracker == render::ContactChoice{}.tracker && place == 0.1;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  AccuracyLine single{
      .name = "single", .title = "single throughout (not in the product)", .order = 1};
  for (const double place : kPlaces) {
    AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * place)) + "mm",
                        .knob = place,
                        .error = [=] { return difference(single_forces(place), single_forces(0)); },
                        .prepare = [=]() -> Stroke {
                          return [=] {
                            double sum = 0;
                            for (const Vector3d& f : single_forces(place)) sum += f.x();
                            return sum;
                          };
                        }};
    point.ticks = kRingTicks;
    point.fits = place >= 1;  // closer, rounding in the arithmetic exceeds that of the position
    single.points.push_back(std::move(point));
  }
  axis.lines.push_back(std::move(single));
  return axis;
}

}  // namespace thimble::studies
