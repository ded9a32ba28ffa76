#pragma once

#include <Eigen/Core>
#include <atomic>
#include <vector>

#include "bringup/bench_arm.h"
#include "hil/median_interval.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::hil {

/// Parameters of the search for the stiffest wall that a free arm renders stably.
struct EdgeSearch {
  /// Unit vector of the world along which the tip oscillates (`bringup::push_direction`).
  Eigen::Vector3d direction_W{0, 1, 0};
  double speed = 0.03;      ///< Mean speed of the tip at the wall after a kick, m/s.
  double speed_span = 0.2;  ///< Total range of the starts' speeds, relative to the mean.
  double first = 100;       ///< First stiffness, N/m.
  double last = 20000;      ///< Max. stiffness, N/m.
  double coarse = 1.2;      ///< Factor between steps until the first wall that grows.
  double factor = 1.08;     ///< Factor between steps after that.
  int starts = 33;          ///< Number of starts of the search, 1 or more.
};

/// Result of the search.
struct EdgeOfWall {
  /// Median over the starts of the stiffness at the edge, between a wall that came to rest and the
  /// next, which grew, N/m.
  MedianInterval stiffness;
  std::vector<double> at_start;  ///< Edge from each start, in order, N/m.
  bool grew = false;  ///< The search reached the edge; else it ended at its last stiffness.
  double max_energy_given = 0;  ///< Max. energy that a wall gave the tip, J.
  double max_force = 0;         ///< Max. force sent, N.
  int walls = 0;                ///< Number of walls tried.
};

/// Raises the stiffness of a wall in coarse steps until the first that grows, which is removed at
/// once. Then searches for the edge from each start, by fine steps up or down from the median of
/// the previous starts.
///
/// Each wall is a spring about the present tip position, switched on while the tip moves after a
/// kick of the motors: no hand holds the arm. A start is the speed of the tip and the position of
/// the wall between two encoder steps. Both determine whether a stiff wall comes to rest, and every
/// arm is tested with the same starts. A wall grew if the oscillation some periods later is as wide
/// as at the beginning. It also grew if it gave the tip ten times the energy of the kick (an
/// observer sums force times motion). It is then removed within that tick. A tip that moves more
/// than 6 mm away also ends the search. The tip is held weakly across that direction. No force
/// exceeds 0.95 N. The device is idle before and after. Fails on a fault, if the tip does not stay,
/// or if even the first wall grows. Real-time: never from the servo thread.
driver::Result<EdgeOfWall> find_edge_of_wall(bringup::BenchArm& bench, const scene::ArmFile& file,
                                             const EdgeSearch& search,
                                             const std::atomic<bool>& stop);

/// Returns the prediction of the law, (b + 4 c / (pi v)) / L, N/m [PHYSICS 1.4]. It is the
/// stiffness at which dry friction c and viscous friction b no longer stop an oscillation of the
/// kick's speed v. L is the latency of the arm file's loop. Too low for late loops, by a third at 4
/// ms: friction reduces the kick's speed before so soft a wall reverses the tip.
double edge_by_law(const scene::ArmFile& file, double speed);

}  // namespace thimble::hil
