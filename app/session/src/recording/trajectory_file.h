#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::session {

/// One line of a trajectory: where a probe was, and what it felt.
struct TrajectoryPoint {
  double time = 0;             ///< s
  Eigen::Vector3d p{0, 0, 0};  ///< m, in the trajectory's frame.
  Eigen::Vector3d f{0, 0, 0};  ///< On the probe, N, in the same frame; zero if the file has none.
};

/// How the lines of a trajectory file are to be read: published ones differ.
struct TrajectoryForm {
  std::string columns = "t x y z";  ///< t x y z fx fy fz in any order; - for one that is left out.
  double metres = 1;                ///< Metres per unit of length.
  double seconds = 1;               ///< Seconds per unit of time.

  double farthest = 10;  ///< m; what is beyond is taken for a wrong unit.

  /// Returns whether forces are among the columns.
  bool has_forces() const { return columns.find("fx") != std::string::npos; }
};

/// Reads a trajectory: one point a line, numbers apart by spaces, tabs, commas or semicolons; empty
/// lines, and those that begin with # or %, are left out, and so is a first line of words. Times
/// must grow; a line with the time of the one before is left out. The error names the line.
/// Real-time: never from the servo thread.
driver::Result<std::vector<TrajectoryPoint>> read_trajectory(const std::filesystem::path& file,
                                                             const TrajectoryForm& form);

/// Finds a point between two lines of a trajectory, linearly; before the first and after the last
/// it is those. Precondition: it has a point. `hint` is where the last question fell.
TrajectoryPoint trajectory_at(const std::vector<TrajectoryPoint>& trajectory, double time,
                              std::size_t& hint);

}  // namespace thimble::session
