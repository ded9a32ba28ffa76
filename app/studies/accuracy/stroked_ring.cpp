#include "studies/accuracy/stroked_ring.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "studies/cost/cost_subjects.h"
#include "thimble/render/build_object_touch.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr double kDeepEnough = 2e-4;  // m; below, a relative error is meaningless

// Returns the force of the exact ring at a state around the origin.
Vector3d true_force(const driver::DeviceState& state) {
  const double depth = kCostRing.depth(state.p_WT);
  const Vector3d n = kCostRing.normal(state.p_WT);
  return std::max(kCostSpring.stiffness * depth - kCostSpring.damping * n.dot(state.v_WT), 0.0) * n;
}

// Returns the angle between two forces, rad; 0 if one of them is zero.
double angle_between(const Vector3d& f, const Vector3d& g) {
  return std::atan2(f.cross(g).norm(), f.dot(g));
}

}  // namespace

std::vector<driver::DeviceState> ring_states(const Vector3d& p_W) {
  auto states = ring_stroke(kCostRing, kRingTicks, 0.001);
  for (driver::DeviceState& state : states) state.p_WT += p_W;
  return states;
}

std::unique_ptr<render::ObjectTouch> build_ring(const RingTouch& ring) {
  render::TriangleMesh mesh = kCostRing.mesh(2 * ring.across, ring.across);
  for (Vector3d& p : mesh.vertices) p += ring.p_W;
  return render::build_object_touch(mesh, ring.choice, {.spring = kCostSpring}).value();
}

std::vector<Vector3d> forces_on(const RingTouch& ring) {
  const auto touch = build_ring(ring);
  std::vector<Vector3d> forces;
  for (const auto& state : ring_states(ring.p_W)) forces.push_back(touch->update(state).f_T_W);
  return forces;
}

RingErrors ring_errors(const RingTouch& ring) {
  const auto forces = forces_on(ring);
  const auto states = ring_states();
  std::vector<double> angles;
  double squares = 0;
  double jump = 0;
  for (std::size_t i = 1; i < states.size(); ++i) {
    jump = std::max(jump, angle_between(forces[i - 1], forces[i]) -
                              angle_between(true_force(states[i - 1]), true_force(states[i])));
    if (kCostRing.depth(states[i].p_WT) < kDeepEnough) continue;
    const Vector3d truth = true_force(states[i]);
    squares += (forces[i] - truth).squaredNorm() / truth.squaredNorm();
    const double cosine =
        forces[i].norm() > 0 ? forces[i].normalized().dot(kCostRing.normal(states[i].p_WT)) : 0.0;
    angles.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)));
  }
  std::sort(angles.begin(), angles.end());
  return {.force = std::sqrt(squares / static_cast<double>(angles.size())),
          .direction_p99 = angles[angles.size() * 99 / 100],
          .jump = jump};
}

Stroke ring_work(const RingTouch& ring) {
  const std::shared_ptr<render::ObjectTouch> touch = build_ring(ring);
  return [touch, states = ring_states(ring.p_W)] {
    double sum = 0;
    for (const auto& state : states) sum += touch->update(state).f_T_W.x();
    return sum;
  };
}

double edge_over_radius(int across) {
  return 2 * std::sin(std::numbers::pi / across);
}

}  // namespace thimble::studies
