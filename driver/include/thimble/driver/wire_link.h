#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/export.h"
#include "thimble/driver/transport.h"

namespace thimble::driver {

/// Link to an arm that consists of a wire (Transport) and a wire format with a geometry (Arm).
/// Converts a gated force into motor currents by tau = J_BT^T f.
class THIMBLE_EXPORT WireLink final : public ArmLink {
 public:
  /// Constructs a link from an open transport and the arm connected to it. Real-time: never from
  /// the servo thread.
  WireLink(std::unique_ptr<Transport> transport, std::unique_ptr<const Arm> arm);

  const ArmTraits& traits() const noexcept override { return traits_; }
  LinkRead read(ArmSample& sample, std::int64_t deadline_ns) noexcept override;
  LinkWrite write(const GatedForce& force, const ArmSample& sample,
                  const Eigen::Matrix3d& R_WB) noexcept override;
  LinkStatus settled() noexcept override;
  bool numbers_reports() const noexcept override { return numbered_; }
  MotorCurrents currents() const noexcept override { return currents_; }
  void limit_currents(const std::array<MotorDrive, 3>& limits) noexcept override;

 private:
  bool is_repeated(const ArmReading& reading) noexcept;

  std::unique_ptr<Transport> transport_;
  std::unique_ptr<const Arm> arm_;
  ArmTraits traits_;
  std::array<MotorDrive, 3> drives_;  // With the current limits that apply now.
  MotorCurrents currents_;            // Currents of the last write.
  bool numbered_ = false;             // True once two reports had different numbers.
  std::optional<std::uint16_t> number_;
};

}  // namespace thimble::driver
