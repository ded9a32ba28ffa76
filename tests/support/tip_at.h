#pragma once

#include <Eigen/Core>

#include "thimble/driver/device_state.h"

namespace thimble::support {

/// Returns the state of an arm at rest with its tip at `p_WT` (W, m).
inline driver::DeviceState tip_at(const Eigen::Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return state;
}

}  // namespace thimble::support
