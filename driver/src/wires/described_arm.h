#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "thimble/driver/wire_arm.h"
#include "wires/count_unwrap.h"
#include "wires/wire_table.h"

namespace thimble::driver {

/// An arm composed of a described wire and a geometry; compare WireArm, whose wire is code.
/// Real-time: safe after construction.
template <class Geometry>
class DescribedArm final : public JointArm<Geometry> {
 public:
  /// Keeps a copy of the tables, with the torque constants of the model.
  DescribedArm(const WireTable& wire, const JointModel<Geometry>& model)
      : JointArm<Geometry>(model), wire_(wire) {
    wire_.use_motors(model.drives);
  }

  bool decode(std::span<const std::byte> report, ArmReading& reading) const noexcept override {
    if (!wire_.wraps) return wire_.decode(report, reading);
    ArmReading fresh = reading;
    if (!wire_.decode(report, fresh) || !unwrap_.take(wire_.wrap, fresh.counts)) return false;
    reading = fresh;
    return true;
  }

  std::size_t encode(const MotorCurrents& currents,
                     std::span<std::byte, kReportCapacity> report) const noexcept override {
    const Eigen::Vector3d& amperes = currents.amperes();
    return wire_.encode({amperes.x(), amperes.y(), amperes.z()}, report, ++number_);
  }

 private:
  WireTable wire_;
  // An arm is used by one thread at a time.
  mutable std::uint32_t number_ = 0;  // of the last command
  mutable CountUnwrap unwrap_;        // counters of the last report
};

}  // namespace thimble::driver
