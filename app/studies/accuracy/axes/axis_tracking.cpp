#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "search/make_search.h"
#include "stability/draw.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/follower.h"
#include "studies/cost/cost_subjects.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using render::SearchChoice;
using render::TrackerChoice;

constexpr int kAcross = 64;                        // 16,384 triangles with edges of about 2 mm
constexpr double kHills = 4e-4;                    // m, up and down
constexpr double kDeep = 1e-3;                     // m below the ring without hills
constexpr double kTick = 1e-3;                     // s
constexpr int kTicks = 400;                        // in a stroke
constexpr int kRepeats = 100;                      // of the worst tick
constexpr double kSpeeds[] = {0.1, 0.3, 1, 2, 4};  // m/s
constexpr double kUsualSpeed = 0.3;
// Extra distance at which a triangle counts as wrong: there the spring of the other studies, 800
// N/m, has a force of 20 mN [PHYSICS 6].
const double kFelt = 0.02 / kCostSpring.stiffness;

/// The ring with bumps and pits of one triangle each, so that many triangles have similar distances
/// at some places.
const FollowedSurface& surface() {
  static const FollowedSurface one = [] {
    render::TriangleMesh mesh = kCostRing.mesh(2 * kAcross, kAcross);
    stability::Draw draw(17);
    for (Vector3d& p : mesh.vertices) p += draw.uniform(-kHills, kHills) * kCostRing.normal(p);
    FollowedSurface found;
    found.mesh = std::make_shared<const render::ContactMesh>(
        render::ContactMesh::build(mesh).value());  // still closed, because the hills are low
    found.tree = render::make_search(*found.mesh, SearchChoice::kTree);
    found.linear = render::make_search(*found.mesh, SearchChoice::kLinear);
    return found;
  }();
  return one;
}

// Returns the positions of a stroke around ring and tube at once, from outside in, one per tick.
std::vector<Vector3d> course_at(double speed) {
  std::vector<Vector3d> places;
  for (int i = 0; i < kTicks; ++i) {
    // The same distance around the ring and around the tube in each tick.
    const double way = speed * kTick * i / std::sqrt(2);
    const double around = way / (kCostRing.ring_radius + kCostRing.tube_radius);
    places.push_back(kCostRing.at(around, way / kCostRing.tube_radius, i == 0 ? kDeep : -kDeep));
  }
  return places;
}

double distance_to_edge(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d edge = b - a;
  const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (p - a - t * edge).norm();
}

// Returns the distance to a triangle, m. It is written separately, so that the truth shares no code
// with the tested methods: to the plane if the projection is inside all three edges, otherwise to
// the nearest edge.
double distance_to(std::int32_t triangle, const Vector3d& p) {
  const auto& mesh = *surface().mesh;
  const Vector3d corners[] = {mesh.position(triangle, 0), mesh.position(triangle, 1),
                              mesh.position(triangle, 2)};
  const Vector3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  bool inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& a = corners[k];
    const Vector3d& b = corners[(k + 1) % 3];
    inside = inside && n.dot((b - a).cross(p - a)) >= 0;
    nearest = std::min(nearest, distance_to_edge(p, a, b));
  }
  return inside ? std::abs(n.dot(p - corners[0])) / n.norm() : nearest;
}

// Returns the distance of the surface at each of these positions, by exhaustive search; m.
const std::vector<double>& nearest_at(double speed) {
  static std::map<double, std::vector<double>> found;
  const auto [at, fresh] = found.try_emplace(speed);
  if (!fresh) return at->second;
  for (const Vector3d& p : course_at(speed)) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::int32_t triangle = 0; triangle < surface().mesh->triangle_count(); ++triangle) {
      nearest = std::min(nearest, distance_to(triangle, p));
    }
    at->second.push_back(nearest);
  }
  return at->second;
}

// Returns the ticks with a wrong triangle, or with none although the tip is inside; in percent.
double wrong_faces(const FollowerChoice& choice, double speed) {
  const std::vector<Vector3d> places = course_at(speed);
  const std::vector<double>& nearest = nearest_at(speed);
  const auto follower = make_follower(surface(), choice);
  follower->follow(places[0]);
  int wrong = 0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const std::int32_t triangle = follower->follow(places[i]);
    const bool right = triangle >= 0 && distance_to(triangle, places[i]) <= nearest[i] + kFelt;
    wrong += right ? 0 : 1;
  }
  return 100.0 * wrong / (kTicks - 1);
}

/// The tick of a stroke with the highest cost: the follower before it, and the new position.
struct WorstTick {
  std::shared_ptr<const Follower> before;
  Vector3d p_WT{0, 0, 0};
};

WorstTick worst_tick(const FollowerChoice& choice, double speed) {
  const std::vector<Vector3d> places = course_at(speed);
  const auto follower = make_follower(surface(), choice);
  const auto last = follower->copy();
  WorstTick worst;
  double max = -1;
  follower->follow(places[0]);
  for (std::size_t i = 1; i < places.size(); ++i) {
    last->copy_state(*follower);
    follower->follow(places[i]);
    // The tick that enters always needs a search.
    if (i == 1 || !(follower->effort() > max)) continue;
    max = follower->effort();
    worst = {last->copy(), places[i]};
  }
  return worst;
}

// Repeats the worst tick; without `follows` only the reset of the follower.
Stroke work_of(const FollowerChoice& choice, double speed, bool follows) {
  const WorstTick worst = worst_tick(choice, speed);
  const std::shared_ptr<Follower> follower = worst.before->copy();
  return [worst, follower, follows] {
    double sum = 0;
    for (int i = 0; i < kRepeats; ++i) {
      follower->copy_state(*worst.before);
      if (follows) sum += follower->follow(worst.p_WT);
    }
    return sum;
  };
}

struct Way {
  const char* name;
  const char* title;
  FollowerChoice choice;
};

const Way kWays[] = {
    {"hops", "hops only", {}},
    {"hops_ring", "hops, and one ring of neighbours", {.rings = 1}},
    {"edge_planes", "edge planes (product)", {.tracker = TrackerChoice::kEdgePlanes}},
    {"offset", "offset (product)", {.tracker = TrackerChoice::kOffset}},
    {"compact", "compact (product)", {.tracker = TrackerChoice::kPacked}},
    {"god_object", "god-object (product)", {.tracker = TrackerChoice::kGodObject}},
    {"projection", "normal projection (product)", {.tracker = TrackerChoice::kNormalProjection}},
    {"tree", "nearest by tree, each tick", {.search = SearchChoice::kTree}},
    {"linear", "nearest by test of all triangles", {.search = SearchChoice::kLinear}}};

}  // namespace

AccuracyAxis tracking_axis() {
  AccuracyAxis axis;
  axis.name = "tracking";
  axis.title = "Tracking of a fast stroke over 16,384 triangles with hills: wrong triangles";
  axis.knob = "speed of the stroke";
  axis.knob_unit = "m/s";
  axis.metric = "ticks in a wrong triangle";
  axis.unit = std::string("%");
  axis.truth =
      "The nearest of all triangles in each tick. A triangle is wrong if it is "
      "farther away by more than 25 um, which at 800 N/m is the smallest noticeable "
      "force.";
  axis.felt_words = "A triangle counts as wrong only if the error can be felt.";
  axis.per = "worst tick";
  axis.cost_over_knob = true;
  axis.left_out =
      "The mean tick: see `thimble study cost`. The worst tick is the one with the "
      "largest number of hops and neighbour tests (for searches, the one farthest "
      "from the surface), found by counting, not by timing. Thin parts, where the "
      "nearest triangle may be on the wrong side: there searches without memory fall "
      "through, and trackers do not.";
  for (const Way& way : kWays) {
    AccuracyLine line{.name = way.name, .title = way.title};
    for (const double speed : kSpeeds) {
      const FollowerChoice choice = way.choice;
      AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * speed)) + "mm_s",
                          .knob = speed,
                          .error = [=] { return wrong_faces(choice, speed); },
                          .prepare = [=] { return work_of(choice, speed, true); },
                          .baseline = [=] { return work_of(choice, speed, false); }};
      point.ticks = kRepeats;
      point.is_default = choice.tracker == render::ContactChoice{}.tracker && speed == kUsualSpeed;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  axis.default_words =
      "Hops only are equally correct on this course and cheaper (part of the "
      "difference is the contact stage around the product's tracker). But they stay "
      "wrong at gaps between cells, or after a walk to the far side of a part. Only "
      "there do edge planes test the neighbours. Smooth cells (offset, compact) and "
      "the god-object choose another triangle where several in a groove are equally "
      "near: that of the smooth surface, or that to which the proxy can slide.";
  return axis;
}

}  // namespace thimble::studies
