#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::session {

/// Point of a trajectory: position of a probe and the force on it.
struct TrajectoryPoint {
  double time = 0;             ///< Time, s.
  Eigen::Vector3d p{0, 0, 0};  ///< Position in the trajectory's frame, m.
  /// Force on the probe in the trajectory's frame, N; zero if the file has none.
  Eigen::Vector3d f{0, 0, 0};
};

/// Format of the lines of a trajectory file; published files differ.
struct TrajectoryForm {
  /// Columns: t x y z fx fy fz in any order; - for an ignored one.
  std::string columns = "t x y z";
  double metres = 1;   ///< Metres per unit of length.
  double seconds = 1;  ///< Seconds per unit of time.

  double farthest = 10;  ///< Largest distance, m; a larger one indicates a wrong unit.

  /// Returns whether forces are among the columns.
  bool has_forces() const { return columns.find("fx") != std::string::npos; }
};

/// Reads a trajectory: one point per line, numbers separated by spaces, tabs, commas or semicolons.
/// Empty lines, lines that begin with # or %, and a first line of words are ignored. Times must
/// increase; a line with the time of the previous one is ignored. The error names the line.
/// Real-time: never from the servo thread.
driver::Result<std::vector<TrajectoryPoint>> read_trajectory(const std::filesystem::path& file,
                                                             const TrajectoryForm& form);

/// Returns a point of a trajectory by linear interpolation; before the first and after the last
/// point, that point. Precondition: it has a point. `hint` is the position of the last query.
TrajectoryPoint trajectory_at(const std::vector<TrajectoryPoint>& trajectory, double time,
                              std::size_t& hint);

}  // namespace thimble::session
