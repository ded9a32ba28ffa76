#pragma once

#include <numbers>

#include "arms/hfab/hfab_report.h"
#include "arms/hfab/hfab_wire.h"
#include "thimble/driver/device.h"

namespace thimble::support {

/// The refitted vintage PHANTOM in code, so that tests of the lower layers need no file. The file
/// app/arms/vintage_phantom.yaml has the same values with their sources.
inline driver::JointModel<driver::SerialArm> vintage_model() {
  driver::JointModel<driver::SerialArm> model;
  model.geometry = {.height = 0, .length_b = 0.138, .length_c = 0.112};
  const double ratios[] = {9.0, 7.7, 7.7};
  const double signs[] = {-1, 1, -1};
  const std::int32_t home[] = {0, 7700, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    model.drives[i] = {
        .sign = signs[i], .ratio = ratios[i], .torque_constant = 0.0234, .current_max = 3};
    model.encoders[i] = {.sign = signs[i], .counts_per_motor_turn = 4000, .home_counts = home[i]};
  }
  return model;
}

/// Returns the arm's home pose: upper link level, lower link hanging.
inline Eigen::Vector3d vintage_home() {
  return {0, std::numbers::pi / 2, 0};
}

inline driver::DeviceSettings vintage_settings() {
  driver::DeviceSettings settings;
  settings.p_WB = {-0.138, 0, 0.112};  // the world's origin is the tip at home
  settings.limits = {.force_max = 5,
                     .speed_max = 3,
                     .rise_max = 2000,
                     .soft_start = 0.3,
                     .stall_ns = 20'000'000,
                     .watchdog_ns = 100'000'000};
  return settings;
}

}  // namespace thimble::support
