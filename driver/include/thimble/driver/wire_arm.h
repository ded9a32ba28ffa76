#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "thimble/driver/joint_model.h"

namespace thimble::driver {

/// Rounds currents to the whole mA of the wire, within 16 bits. Precondition: they are finite,
/// which MotorCurrents guarantees. Real-time: safe.
inline std::array<std::int16_t, 3> whole_mA(const MotorCurrents& currents) noexcept {
  std::array<std::int16_t, 3> mA{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double exact = currents.amperes()[static_cast<Eigen::Index>(i)] * 1e3;
    mA[i] = static_cast<std::int16_t>(std::lround(std::clamp(exact, -32767.0, 32767.0)));
  }
  return mA;
}

/// Is an arm made of two parts: a wire format and a geometry.
///
/// A Wire has two static functions, both noexcept: `bool decode(bytes, ArmReading&)`, total and
/// leaving the reading alone when it answers false; and `std::size_t encode(mA, bytes)`, which
/// fills a report with three motor values and tells its length. Real-time: safe.
template <class Wire, class Geometry>
class WireArm final : public Arm {
 public:
  explicit WireArm(const JointModel<Geometry>& model) : model_(model) {}

  bool decode(std::span<const std::byte> report, ArmReading& reading) const noexcept override {
    return Wire::decode(report, reading);
  }

  std::size_t encode(const MotorCurrents& currents,
                     std::span<std::byte, kReportCapacity> report) const noexcept override {
    return Wire::encode(whole_mA(currents), report);
  }

  ArmPose pose(const ArmReading& reading) const noexcept override {
    ArmPose pose;
    pose.q = model_.joint_angles(reading);
    model_.geometry.forward(pose.q, pose.p_BT, pose.J_BT);
    return pose;
  }

  const std::array<MotorDrive, 3>& drives() const noexcept override { return model_.drives; }

  /// Tells geometry, motors and encoders. Real-time: safe.
  const JointModel<Geometry>& model() const noexcept { return model_; }

 private:
  JointModel<Geometry> model_;
};

}  // namespace thimble::driver
