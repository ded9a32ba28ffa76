#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "studies/accuracy/axes/axes.h"
#include "studies/added_forces.h"
#include "studies/cost/cost_subjects.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/scene_touch.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using render::ObjectTouch;
using render::SceneTouch;
using render::TrackerChoice;

constexpr double kTick = 1e-3;     // s
constexpr double kDeep = 1e-3;     // m
constexpr double kSpeed = 0.05;    // m/s, of a stroking hand
constexpr double kBlock = 0.03;    // m, side of a block
constexpr double kHalfWay = 0.01;  // m on each side of a seam

const render::SurfaceChoice kSurface{.spring = {.stiffness = kCostSpring.stiffness}};

/// The positions of a tip, one per tick, with its velocities.
std::vector<driver::DeviceState> states_of(const std::vector<Vector3d>& places) {
  std::vector<driver::DeviceState> states;
  for (std::size_t i = 0; i < places.size(); ++i) {
    driver::DeviceState state;
    state.p_WT = places[i];
    if (i > 0) state.v_WT = (places[i] - places[i - 1]) / kTick;
    state.tick = i;
    state.time_ns = static_cast<std::int64_t>(i) * 1'000'000;
    states.push_back(state);
  }
  return states;
}

/// Returns a stroke of a scene over some states.
template <class Touch>
Stroke stroke_of(std::shared_ptr<Touch> touch, std::vector<driver::DeviceState> states) {
  return [touch = std::move(touch), states = std::move(states)] {
    double sum = 0;
    for (const driver::DeviceState& state : states) sum += (*touch)(state).f_T_W.x();
    return sum;
  };
}

/// The blocks of a tiled floor, whose top is z = 0, from x = -count * kBlock / 2.
SceneTouch floor_of(int count, TrackerChoice tracker) {
  std::vector<std::unique_ptr<ObjectTouch>> blocks;
  for (int i = 0; i < count; ++i) {
    render::TriangleMesh mesh;
    for (int k = 0; k < 8; ++k) {
      mesh.vertices.emplace_back((i - 0.5 * count + (k & 1)) * kBlock,
                                 ((k >> 1 & 1) - 0.5) * kBlock, ((k >> 2 & 1) - 1) * kBlock);
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    // A cube is closed, so this cannot fail.
    blocks.push_back(render::build_object_touch(mesh, {.tracker = tracker}, kSurface).value());
  }
  return SceneTouch(std::move(blocks));
}

AddedForces added_floor(int count) {
  AddedForces added;
  for (int i = 0; i < count; ++i) {
    std::vector<std::unique_ptr<ObjectTouch>> one;
    render::EntryFaceBox box;
    box.p_WO = {(i + 0.5 - 0.5 * count) * kBlock, 0, -0.5 * kBlock};
    box.half_sides = Vector3d::Constant(0.5 * kBlock);
    one.push_back(render::build_primitive_touch(box, kSurface));
    added.objects.emplace_back(std::move(one));
  }
  return added;
}

constexpr double kDepths[] = {0.2e-3, 0.5e-3, 1e-3, 2e-3, 4e-3};  // m

/// A tip that comes down, presses, and slides over the seam at x = 0, aside of the triangles'
/// edges.
std::vector<driver::DeviceState> over_seam(double depth) {
  std::vector<Vector3d> places;
  for (double z = 1e-3; z > -depth; z -= kSpeed * kTick) places.emplace_back(-kHalfWay, 0.004, z);
  for (double x = -kHalfWay; x < kHalfWay; x += kSpeed * kTick) {
    places.emplace_back(x, 0.004, -depth);
  }
  return states_of(places);
}

/// Returns the largest deviation of the force from that of a half-space, in % of the largest force.
template <class Touch>
double seam_error(Touch touch, double depth) {
  double worst = 0;
  for (const driver::DeviceState& state : over_seam(depth)) {
    const Vector3d f(0, 0, kCostSpring.stiffness * std::max(0.0, -state.p_WT.z()));
    worst = std::max(worst, (touch(state).f_T_W - f).norm());
  }
  return 100 * worst / (kCostSpring.stiffness * depth);
}

/// A line of the axis `seam`: `make` builds the touched blocks.
template <class Make>
AccuracyLine seam_line(const std::string& name, const std::string& title, Make make) {
  AccuracyLine line{.name = name, .title = title};
  for (const double depth : kDepths) {
    using Touch = decltype(make());
    AccuracyPoint point{
        .name = std::to_string(std::lround(1e4 * depth)),
        .knob = 1e3 * depth,
        .error = [=] { return seam_error(make(), depth); },
        .prepare = [=] { return stroke_of(std::make_shared<Touch>(make()), over_seam(depth)); }};
    point.ticks = static_cast<double>(over_seam(depth).size());
    line.points.push_back(std::move(point));
  }
  return line;
}

constexpr int kCounts[] = {1, 10, 100, 1000, 10'000};

/// Spheres on a grid; the middle one is the first, and the others are far from the tip.
std::shared_ptr<SceneTouch> spheres(int count) {
  constexpr double kApart = 0.03, kRadius = 0.01;
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  const int side = static_cast<int>(std::ceil(std::cbrt(count)));
  for (int i = 0; i < count; ++i) {
    const Vector3d place(i % side, i / side % side, i / (side * side));
    objects.push_back(render::build_primitive_touch(
        render::Sphere{.p_WO = kApart * place, .radius = kRadius}, kSurface));
  }
  return std::make_shared<SceneTouch>(std::move(objects));
}

/// A tip that circles above the first sphere, or presses it by `kDeep`.
std::vector<driver::DeviceState> around_sphere(bool touching) {
  std::vector<Vector3d> places{Vector3d(0, 0, 0.015)};
  const double height = touching ? 0.01 - kDeep : 0.0125;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.5 * std::sin(5e-3 * i), turn = 2e-3 * i;
    places.push_back(height * Vector3d(std::sin(angle) * std::cos(turn),
                                       std::sin(angle) * std::sin(turn), std::cos(angle)));
  }
  return states_of(places);
}

double objects_error(int count, bool touching) {
  const auto many = spheres(count), one = spheres(1);
  double worst = 0;
  for (const driver::DeviceState& state : around_sphere(touching)) {
    worst = std::max(worst, ((*many)(state).f_T_W - (*one)(state).f_T_W).norm());
  }
  return worst;
}

constexpr double kRadii[] = {0, 0.5e-3, 1e-3, 2e-3, 4e-3, 8e-3};

std::shared_ptr<SceneTouch> ring_under(double radius, bool mesh) {
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  if (mesh) {
    objects.push_back(render::build_object_touch(
                          kCostRing.mesh(kCostAround, kCostAcross),
                          {.tracker = TrackerChoice::kGodObject, .tip_radius = radius}, kSurface)
                          .value());
  } else {
    render::Torus torus;
    torus.radius = kCostRing.ring_radius;
    torus.tube = kCostRing.tube_radius;
    objects.push_back(render::build_primitive_touch(torus, kSurface, radius));
  }
  return std::make_shared<SceneTouch>(std::move(objects));
}

/// The stroke of the studies, lifted by the radius.
std::vector<driver::DeviceState> lifted_stroke(double radius) {
  std::vector<driver::DeviceState> states = ring_stroke(kCostRing, 1000, kTick);
  for (driver::DeviceState& state : states) state.p_WT += radius * kCostRing.normal(state.p_WT);
  return states;
}

/// Returns the largest deviation of the force from that of the exact ring, mN.
double radius_error(double radius, bool mesh) {
  const auto touch = ring_under(radius, mesh);
  double worst = 0;
  for (const driver::DeviceState& state : lifted_stroke(radius)) {
    const double depth = std::max(0.0, kCostRing.depth(state.p_WT) + radius);
    const Vector3d f = kCostSpring.stiffness * depth * kCostRing.normal(state.p_WT);
    worst = std::max(worst, ((*touch)(state).f_T_W - f).norm());
  }
  return 1e3 * worst;
}

}  // namespace

AccuracyAxis seam_axis() {
  AccuracyAxis axis;
  axis.name = "seam";
  axis.title = "Two flush blocks: force at the seam";
  axis.knob = "depth of the tip";
  axis.knob_unit = "mm";
  axis.metric = "largest error of the force";
  axis.unit = "% of the force";
  axis.truth = "A half-space, whose surface the tops of both blocks form.";
  axis.felt_words =
      "With one proxy for both blocks the seam cannot be felt; forces that are added drop to zero.";
  axis.default_words = "All trackers share the proxy of the world.";
  axis.left_out =
      "Curved surfaces that meet at a seam: there the error is that of each tracker on its own "
      "surface (axis tessellation).";
  for (const TrackerChoice tracker : {TrackerChoice::kEdgePlanes, TrackerChoice::kOffset,
                                      TrackerChoice::kGodObject, TrackerChoice::kPacked}) {
    const std::string name(render::kTrackerNames[static_cast<std::size_t>(tracker)]);
    axis.lines.push_back(seam_line(name, name, [=] { return floor_of(2, tracker); }));
    axis.lines.back().exact = true;
  }
  axis.lines.front().points[2].is_default = true;
  axis.lines.push_back(
      seam_line("added", "forces added, for comparison", [] { return added_floor(2); }));
  return axis;
}

AccuracyAxis objects_axis() {
  AccuracyAxis axis;
  axis.name = "objects";
  axis.title = "Many objects: cost of a tick over their number";
  axis.knob = "objects";
  axis.metric = "difference from the force of the object alone";
  axis.unit = "N";
  axis.truth = "The touched object without the others.";
  axis.felt_words = "The number of objects cannot be felt: the force is that of the object alone.";
  axis.over_cost = false;
  axis.over_knob = false;
  axis.cost_over_knob = true;
  axis.default_words = "Only fewer objects are cheaper.";
  axis.left_out = "The time to load a scene, and moving bodies.";
  for (const bool touching : {false, true}) {
    AccuracyLine line{.name = touching ? "touching" : "free",
                      .title = touching ? "pressing one of them" : "2.5 mm above one of them",
                      .exact = true};
    for (const int count : kCounts) {
      AccuracyPoint point{
          .name = std::to_string(count),
          .knob = static_cast<double>(count),
          .error = [=] { return objects_error(count, touching); },
          .prepare = [=] { return stroke_of(spheres(count), around_sphere(touching)); }};
      point.ticks = static_cast<double>(around_sphere(touching).size());
      point.is_default = touching && count == 1;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

AccuracyAxis tip_radius_axis() {
  AccuracyAxis axis;
  axis.name = "tip_radius";
  axis.title = "A tip that is a ball: error and cost over its radius";
  axis.knob = "radius of the tip";
  axis.knob_unit = "mm";
  axis.metric = "largest error of the force";
  axis.unit = "mN";
  axis.threshold = 20;
  axis.threshold_words = "the smallest noticeable force (20 mN)";
  axis.truth = "A torus whose tube is thicker by the radius of the tip.";
  axis.cost_over_knob = true;
  axis.default_words = "The radius is that of the tool.";
  axis.left_out = "Surfaces that change their shape, which only a point can touch.";
  for (const bool mesh : {true, false}) {
    AccuracyLine line{.name = mesh ? "mesh" : "shape",
                      .title = mesh ? "4,096 triangles" : "torus without a mesh",
                      .exact = !mesh};
    for (const double radius : kRadii) {
      AccuracyPoint point{
          .name = std::to_string(std::lround(1e4 * radius)),
          .knob = 1e3 * radius,
          .error = [=] { return radius_error(radius, mesh); },
          .prepare = [=] { return stroke_of(ring_under(radius, mesh), lifted_stroke(radius)); }};
      point.ticks = 1000;
      point.is_default = mesh && radius == 0;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::studies
