#include "gate/workspace_walls.h"

#include <algorithm>
#include <cmath>

namespace thimble::driver {

// Depth behind a wall over which an outward force fades, m. A force that ended at once would make
// the tip oscillate across the wall. [chosen: 5 N, the max. of most arms here, fades like a spring
// of 333 N/m. With the wall's 200 N/m, a latency of 3 ms makes that a negative damper of 1.6 N s/m;
// the damping removes 1.5 N s/m on average, and the arm has its own friction]
constexpr double kFade = 0.015;

WorkspaceWalls::WorkspaceWalls(const WallSettings& settings) noexcept
    : settings_(settings), min_W_(settings.min_W), max_W_(settings.max_W) {}

void WorkspaceWalls::begin_at(const Eigen::Vector3d& p_WT) noexcept {
  min_W_ = settings_.min_W;
  max_W_ = settings_.max_W;
  for (Eigen::Index i = 0; i < 3; ++i) {
    // Written so that NaN widens nothing.
    if (p_WT[i] < min_W_[i]) min_W_[i] = p_WT[i];
    if (p_WT[i] > max_W_[i]) max_W_[i] = p_WT[i];
  }
}

Eigen::Vector3d WorkspaceWalls::depth(const Eigen::Vector3d& p_WT) const noexcept {
  return p_WT - p_WT.cwiseMax(min_W_).cwiseMin(max_W_);
}

ForceCommand WorkspaceWalls::stop(const ForceCommand& command, const Eigen::Vector3d& p_WT,
                                  const Eigen::Vector3d& v_WT) const noexcept {
  ForceCommand stopped = command;
  const Eigen::Vector3d out = depth(p_WT);
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (out[i] == 0) continue;
    double& f = stopped.f_T_W[i];
    if (f * out[i] > 0) f *= std::max(0.0, 1 - std::abs(out[i]) / kFade);
    f -= settings_.stiffness * out[i];
    if (v_WT[i] * out[i] > 0) f -= settings_.damping * v_WT[i];
  }
  return stopped;
}

}  // namespace thimble::driver
