#pragma once

#include <algorithm>
#include <memory>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/device.h"

namespace thimble::support {

/// State and inputs of a MovedArm, stored outside so that they outlive the device.
struct Moved {
  Eigen::Vector3d p_BT{0, 0, 0};  ///< Position of the tip, m.
  std::uint16_t buttons = 0;
  Eigen::Vector3d f_T_B{0, 0, 0};  ///< Last force received, N.
  int messages = 0;
};

/// The link to an arm whose tip is where the test places it, and which accepts every force.
class MovedArm final : public driver::ArmLink {
 public:
  explicit MovedArm(Moved& moved) noexcept : moved_(moved) {}

  const driver::ArmTraits& traits() const noexcept override { return traits_; }
  driver::LinkRead read(driver::ArmSample& sample, std::int64_t) noexcept override {
    sample.pose.p_BT = moved_.p_BT;
    sample.buttons = moved_.buttons;
    // One count per micrometre, and the tremor of a hand.
    tremor_ = (tremor_ + 1) % 7;
    for (std::size_t i = 0; i < 3; ++i) {
      sample.counts[i] =
          static_cast<std::int32_t>(1e6 * moved_.p_BT[static_cast<Eigen::Index>(i)]) + tremor_;
    }
    sample.pose.J_BT = Eigen::Matrix3d::Identity();
    return {driver::LinkStatus::kOk};
  }
  driver::LinkWrite write(const driver::GatedForce& force, const driver::ArmSample&,
                          const Eigen::Matrix3d& R_WB) noexcept override {
    moved_.f_T_B = R_WB.transpose() * force.f_T_W();
    ++moved_.messages;
    return {driver::LinkStatus::kOk, 1};
  }

 private:
  Moved& moved_;
  driver::ArmTraits traits_{.has_counts = true};
  std::int32_t tremor_ = 0;
};

/// Returns settings of an arm with 5 N and 3 m/s at the world's origin.
inline driver::DeviceSettings moved_settings() {
  driver::DeviceSettings settings;
  settings.limits = {.force_max = 5,
                     .speed_max = 3,
                     .rise_max = 2000,
                     .soft_start = 0.3,
                     .stall_ns = 20'000'000,
                     .watchdog_ns = 100'000'000};
  return settings;
}

}  // namespace thimble::support
