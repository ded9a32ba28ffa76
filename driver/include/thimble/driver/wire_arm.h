#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "thimble/driver/joint_model.h"

namespace thimble::driver {

/// Rounds a number to the nearest integer, halves away from zero, as std::lround does, but without
/// a call. Precondition: |x| < 2^31. Real-time: safe.
inline std::int32_t round_half_away(double x) noexcept {
  // The largest double below one half, so that 0.49999999999999994 becomes 0.
  constexpr double kHalf = 0.49999999999999994;
  return static_cast<std::int32_t>(x + std::copysign(kHalf, x));
}

/// Rounds currents to whole mA for the wire, halves away from zero, limited to 16 bits.
/// Precondition: they are finite, which MotorCurrents guarantees. Real-time: safe.
[[gnu::always_inline]] inline std::array<std::int16_t, 3> whole_mA(
    const MotorCurrents& currents) noexcept {
  // Free of branches.
  const auto whole = [](double amperes) noexcept {
    const double kept = std::min(std::max(amperes * 1e3, -32767.0), 32767.0);
    return static_cast<std::int16_t>(round_half_away(kept));
  };
  const Eigen::Vector3d& amperes = currents.amperes();
  return {whole(amperes.x()), whole(amperes.y()), whole(amperes.z())};
}

/// The part of an arm that does not depend on its wire: geometry, motors and encoders. Real-time:
/// safe.
template <class Geometry>
class JointArm : public Arm {
 public:
  explicit JointArm(const JointModel<Geometry>& model) : model_(model) {}

  void find_pose(const ArmReading& reading, ArmPose& pose) const noexcept final {
    pose.q = model_.joint_angles(reading);
    model_.geometry.forward(pose.q, pose.p_BT, pose.J_BT);
  }

  const std::array<MotorDrive, 3>& drives() const noexcept final { return model_.drives; }

  bool has_gimbal() const noexcept final { return kCarries && model_.gimbal.has_value(); }

  void orient(const ArmReading& reading, const ArmPose& pose, Eigen::Vector3d& gimbal,
              Eigen::Matrix3d& R_BT) const noexcept final {
    if constexpr (kCarries) {
      if (!model_.gimbal) return;
      gimbal = model_.gimbal->angles(reading.auxiliary);
      R_BT = model_.geometry.last_link(pose.q, pose.p_BT) * model_.gimbal->rotation(gimbal);
    }
  }

  /// Returns geometry, motors and encoders. Real-time: safe.
  const JointModel<Geometry>& model() const noexcept { return model_; }

 private:
  static constexpr bool kCarries = requires(const Geometry& geometry, const Eigen::Vector3d& v) {
    geometry.last_link(v, v);
  };

  JointModel<Geometry> model_;
};

/// An arm composed of a wire format and a geometry.
///
/// A Wire has two static functions, both noexcept. `bool decode(bytes, ArmReading&)` accepts any
/// bytes and leaves the reading unchanged if it returns false. `std::size_t encode(mA, bytes)`
/// writes a report with three motor values and returns its length. A wire whose board finds its own
/// zero, and reports a loss of it, has a constant `kFindsZero = true`. Real-time: safe.
template <class Wire, class Geometry>
class WireArm final : public JointArm<Geometry> {
 public:
  using JointArm<Geometry>::JointArm;

  bool decode(std::span<const std::byte> report, ArmReading& reading) const noexcept override {
    return Wire::decode(report, reading);
  }

  std::size_t encode(const MotorCurrents& currents,
                     std::span<std::byte, kReportCapacity> report) const noexcept override {
    return Wire::encode(whole_mA(currents), report);
  }

  bool zero_at_power_on() const noexcept override {
    if constexpr (requires { Wire::kFindsZero; }) return !Wire::kFindsZero;
    return true;
  }
};

}  // namespace thimble::driver
