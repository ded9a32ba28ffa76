#include "thimble/driver/wire_link.h"

#include <cstddef>
#include <span>
#include <utility>

#include "thimble/driver/wire_arm.h"

namespace thimble::driver {
namespace {

constexpr LinkStatus link_status(TransportStatus status) noexcept {
  switch (status) {
    case TransportStatus::kOk:
      return LinkStatus::kOk;
    case TransportStatus::kNothing:
      return LinkStatus::kNothing;
    case TransportStatus::kLost:
      return LinkStatus::kLost;
    case TransportStatus::kRefused:
      break;
  }
  return LinkStatus::kRefused;
}

/// Returns the number of motors that an arm has: those before the first absent one (MotorDrive).
int motors_of(const std::array<MotorDrive, 3>& drives) noexcept {
  int motors = 0;
  while (motors < 3 && drives[static_cast<std::size_t>(motors)].sign != 0) ++motors;
  return motors;
}

}  // namespace

WireLink::WireLink(std::unique_ptr<Transport> transport, std::unique_ptr<const Arm> arm)
    : transport_(std::move(transport)),
      arm_(std::move(arm)),
      traits_{.has_joints = true,
              .has_counts = true,
              .has_orientation = arm_->has_gimbal(),
              .has_gimbal = arm_->has_gimbal(),
              .zero_at_power_on = arm_->zero_at_power_on(),
              .axes = motors_of(arm_->drives()),
              .motors = arm_->drives()},
      drives_(arm_->drives()) {}

LinkRead WireLink::read(ArmSample& sample, std::int64_t deadline_ns) noexcept {
  std::array<std::byte, kReportCapacity> buffer;
  const TransportRead read = transport_->read_latest(buffer, deadline_ns);
  if (read.status != TransportStatus::kOk) return {link_status(read.status), read.skipped};
  ArmReading reading;
  if (!arm_->decode(std::span<const std::byte>(buffer).first(read.size), reading)) {
    return {LinkStatus::kRejected, read.skipped};
  }
  if (is_repeated(reading)) return {LinkStatus::kRepeated, read.skipped};
  arm_->find_pose(reading, sample.pose);
  sample.counts = reading.counts;
  sample.buttons = reading.buttons;
  if (traits_.has_gimbal) arm_->orient(reading, sample.pose, sample.gimbal, sample.R_BT);
  return {LinkStatus::kOk, read.skipped};
}

bool WireLink::is_repeated(const ArmReading& reading) noexcept {
  if (!reading.number) return false;
  const bool same = number_ == reading.number;
  // The number of a board that does not change it means nothing.
  if (number_ && !same) numbered_ = true;
  number_ = reading.number;
  return same && numbered_;
}

LinkWrite WireLink::write(const GatedForce& force, const ArmSample& sample,
                          const Eigen::Matrix3d& R_WB) noexcept {
  currents_ = MotorCurrents(force, R_WB, sample.pose.J_BT, drives_);
  std::array<std::byte, kReportCapacity> report;
  const std::size_t size = arm_->encode(currents_, report);
  const auto status = transport_->write(std::span<const std::byte>(report).first(size));
  return {link_status(status), currents_.scale()};
}

LinkStatus WireLink::settled() noexcept {
  return link_status(transport_->settled());
}

void WireLink::limit_currents(const std::array<MotorDrive, 3>& limits) noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i].current_max = limits[i].current_max;
}

}  // namespace thimble::driver
