#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "studies/accuracy/accuracy_axis.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/object_touch.h"

namespace thimble::studies {

// The ring of `thimble study cost` with a chosen number of triangles, stroked and compared with the
// exact ring. Real-time: never from the servo thread.

/// Settings of the contact with the ring.
struct RingTouch {
  render::ContactChoice choice;
  int across = 32;               ///< Triangle edges around the tube; twice as many around the ring.
  Eigen::Vector3d p_W{0, 0, 0};  ///< Centre of the ring, m.
};

/// Returns the states of the stroke, one per ms, at 1 kHz.
std::vector<driver::DeviceState> ring_states(const Eigen::Vector3d& p_W = {0, 0, 0});

/// Builds the force law. Precondition: the settings are compatible (otherwise Result::value
/// throws).
std::unique_ptr<render::ObjectTouch> build_ring(const RingTouch& ring);

/// Returns the force (N) at each state.
std::vector<Eigen::Vector3d> forces_on(const RingTouch& ring);

/// Errors of the force against that of the exact ring, where the depth is at least 0.2 mm.
struct RingErrors {
  double force = 0;          ///< RMS, as a fraction.
  double direction_p99 = 0;  ///< rad
  double jump = 0;           ///< Largest rotation within a tick beyond the exact normal's, rad.
};
RingErrors ring_errors(const RingTouch& ring);

/// Prepares a stroke for timing: `kRingTicks` ticks.
Stroke ring_work(const RingTouch& ring);
inline constexpr int kRingTicks = 4000;

/// Returns the length of an edge around the tube divided by the tube's radius, L / R [PHYSICS 3].
double edge_over_radius(int across);

}  // namespace thimble::studies
