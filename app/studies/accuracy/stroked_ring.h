#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "studies/accuracy/accuracy_axis.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/object_touch.h"

namespace thimble::studies {

// The ring of `thimble study cost`, cut as finely as wanted, stroked and compared with itself.
// Real-time: never from the servo thread.

/// How the ring is touched.
struct RingTouch {
  render::ContactChoice choice;
  int across = 32;  ///< Triangles' edges around the tube; twice as many around the ring.
  Eigen::Vector3d p_W{0, 0, 0};  ///< Where the ring's centre is, m.
};

/// Returns the states of the stroke, one per ms, at 1 kHz.
std::vector<driver::DeviceState> ring_states(const Eigen::Vector3d& p_W = {0, 0, 0});

/// Builds the force law. Precondition: the choice goes together (the caller's duty; otherwise
/// Result::value throws).
std::unique_ptr<render::ObjectTouch> build_ring(const RingTouch& ring);

/// Returns the force (N) at each state.
std::vector<Eigen::Vector3d> forces_on(const RingTouch& ring);

/// How far the force is from that on the ring itself, where the tip is 0.2 mm deep or more.
struct RingErrors {
  double force = 0;          ///< RMS, as a share.
  double direction_p99 = 0;  ///< rad
  double jump = 0;           ///< Largest turn in a tick beyond that of the ring's own normal, rad.
};
RingErrors ring_errors(const RingTouch& ring);

/// Makes a stroke ready to be timed: `kRingTicks` ticks.
Stroke ring_work(const RingTouch& ring);
inline constexpr int kRingTicks = 4000;

/// Returns the length of an edge around the tube over the tube's radius, L / R [PHYSICS 3].
double edge_over_radius(int across);

}  // namespace thimble::studies
