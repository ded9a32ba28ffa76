#include "studies/cost/ring_surface.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "studies/tube_mesh.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

Vector3d from_ring(const RingSurface& ring, const Vector3d& p_W) noexcept {
  return p_W - ring.ring_radius * Vector3d(p_W.x(), p_W.y(), 0).normalized();
}

}  // namespace

Vector3d RingSurface::normal(const Vector3d& p_W) const noexcept {
  return from_ring(*this, p_W).normalized();
}

double RingSurface::depth(const Vector3d& p_W) const noexcept {
  return tube_radius - from_ring(*this, p_W).norm();
}

Vector3d RingSurface::at(double around, double across, double height) const noexcept {
  const double out = (tube_radius + height) * std::cos(across);
  return {(ring_radius + out) * std::cos(around), (ring_radius + out) * std::sin(around),
          (tube_radius + height) * std::sin(across)};
}

render::TriangleMesh RingSurface::mesh(int around, int across) const {
  return tube_mesh(around, across, [this](double u, double v) { return at(u, v, 0); });
}

std::vector<driver::DeviceState> ring_stroke(const RingSurface& ring, int ticks, double dt) {
  std::vector<driver::DeviceState> states(static_cast<std::size_t>(ticks));
  for (int i = 0; i < ticks; ++i) {
    const double t = i * dt;
    const double share = static_cast<double>(i) / (ticks - 1);
    // Forth and back: at most 80 mm/s on the outer equator, zero at each turn.
    const double around = 0.08 / (ring.ring_radius + ring.tube_radius) / 4 * std::sin(4 * t);
    const double across = 2 * std::numbers::pi * share;
    const double edge = std::min(1.0, 20 * std::min(share, 1 - share));
    const double depth = -0.001 + edge * (0.002 + 0.0005 * std::sin(7 * t));
    driver::DeviceState& state = states[static_cast<std::size_t>(i)];
    state.p_WT = ring.at(around, across, -depth);
    state.tick = static_cast<std::uint64_t>(i);
    state.time_ns = std::llround(1e9 * t);
    state.dt = i > 0 ? dt : 0;
    state.fresh = true;
    if (i > 0) state.v_WT = (state.p_WT - states[static_cast<std::size_t>(i) - 1].p_WT) / dt;
  }
  return states;
}

}  // namespace thimble::studies
