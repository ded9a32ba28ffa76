#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <vector>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"

namespace thimble::support {

/// An arm that reports poses and accepts forces, like one behind a vendor's library: a mass on a
/// hand with a target. It measures its own velocity, its stylus is turned, and it has a gripper.
/// Joints and motors are unknown. Frame B: its base.
struct PoseArm {
  double mass = 0.1, stiffness = 300, damping = 3;  ///< kg, N/m, N s/m
  Eigen::Vector3d p_BT{0, 0, 0}, v_BT{0, 0, 0};     ///< m, m/s
  Eigen::Vector3d p_BH{0, 0, 0};                    ///< Target of the hand, m.
  Eigen::Vector3d f_T_B{0, 0, 0};                   ///< Current force of the arm, N.
  Eigen::Matrix3d R_BT = Eigen::Matrix3d::Identity();
  double gripper = 0.012;  ///< m
  double strongest = 3;    ///< Largest force of the arm, N.
  std::uint16_t buttons = 0;
  bool lost = false, silent = false, refuses = false, stuck = false;
  bool reports_no_velocity = false;      ///< Always reports a velocity of zero.
  std::vector<Eigen::Vector3d> taken_B;  ///< Every force received, N.
  std::int64_t time_ns = 0;

  /// Advances the time.
  void advance_to(std::int64_t now_ns) {
    constexpr std::int64_t kStep_ns = 50'000;
    for (; time_ns + kStep_ns <= now_ns; time_ns += kStep_ns) {
      constexpr double kStep = 1e-9 * kStep_ns;
      const Eigen::Vector3d f = f_T_B + stiffness * (p_BH - p_BT) - damping * v_BT;
      v_BT += kStep / mass * f;
      p_BT += kStep * v_BT;
    }
  }
};

/// The link to a PoseArm.
class PoseLink final : public driver::ArmLink {
 public:
  static constexpr driver::ArmTraits kTraits{
      .has_velocity = true, .has_orientation = true, .has_gripper = true};

  PoseLink(PoseArm& arm, driver::Clock& clock, const driver::ArmTraits& traits = kTraits)
      : arm_(arm), clock_(clock), traits_(traits) {}

  const driver::ArmTraits& traits() const noexcept override { return traits_; }

  driver::LinkRead read(driver::ArmSample& sample, std::int64_t) noexcept override {
    arm_.advance_to(clock_.now_ns());
    if (arm_.lost) return {driver::LinkStatus::kLost};
    if (arm_.silent) return {driver::LinkStatus::kNothing};
    if (!arm_.stuck) p_reported_ = arm_.p_BT;
    sample.pose.p_BT = p_reported_;
    sample.v_BT = arm_.reports_no_velocity ? Eigen::Vector3d(0, 0, 0) : arm_.v_BT;
    sample.R_BT = arm_.R_BT;
    sample.gripper = arm_.gripper;
    sample.buttons = arm_.buttons;
    return {driver::LinkStatus::kOk};
  }

  driver::LinkWrite write(const driver::GatedForce& force, const driver::ArmSample&,
                          const Eigen::Matrix3d& R_WB) noexcept override {
    arm_.advance_to(clock_.now_ns());
    if (arm_.lost) return {driver::LinkStatus::kLost};
    if (arm_.refuses) return {driver::LinkStatus::kRefused};
    Eigen::Vector3d f_T_B = R_WB.transpose() * force.f_T_W();
    const double scale = f_T_B.norm() > arm_.strongest ? arm_.strongest / f_T_B.norm() : 1;
    arm_.f_T_B = scale * f_T_B;
    arm_.taken_B.push_back(arm_.f_T_B);
    return {driver::LinkStatus::kOk, scale};
  }

 private:
  PoseArm& arm_;
  driver::Clock& clock_;
  driver::ArmTraits traits_;
  Eigen::Vector3d p_reported_{0, 0, 0};
};

}  // namespace thimble::support
