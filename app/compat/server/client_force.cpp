#include "compat/server/client_force.h"

#include <algorithm>

namespace thimble::compat {
namespace {

/// A writer interrupted during a write must not delay a tick.
constexpr int kAttempts = 4;

double opened_further(double opened, double dt, double opening) noexcept {
  return opening > 0 ? std::min(1.0, opened + dt / opening) : 1.0;
}

}  // namespace

ClientForce::ClientForce(ArmChannel& channel, driver::ForceLaw scene, driver::Device& device,
                         bool may_activate) noexcept
    : channel_(channel),
      scene_(scene),
      device_(device),
      limits_(device.gate().limits()),
      may_activate_(may_activate),
      enablings_(channel.enablings.load()) {
  // Requests from before this run are ignored.
  ForceWritten old;
  if (channel.force.load(old)) taken_ = old.number;
  channel.taken.store(taken_);
}

driver::ForceCommand ClientForce::operator()(const driver::DeviceState& state) noexcept {
  take(state);
  driver::ForceCommand command = scene_(state);
  f_client_W_ = own_part(state);
  const bool enabled = channel_.enabled.load(std::memory_order_relaxed) != 0;
  opened_ = enabled ? opened_further(opened_, state.dt, limits_.soft_start) : 0;
  if (!enabled) {
    command.f_T_W.setZero();
    command.f_program_W.setZero();
    return command;
  }
  command.f_T_W += f_client_W_;
  command.f_program_W += f_client_W_;
  if (opened_ < 1) driver::scale(command, opened_);
  const double speed_limit = channel_.speed_limit.load(std::memory_order_relaxed);
  if (speed_limit > 0 && !(state.v_WT.norm() <= speed_limit)) {
    device_.trip(driver::Fault::kOverSpeed);
  }
  return command;
}

void ClientForce::take(const driver::DeviceState& state) noexcept {
  const std::uint32_t enablings = channel_.enablings.load(std::memory_order_relaxed);
  if (enablings != enablings_) {
    enablings_ = enablings;
    opened_ = 0;
    // The counts of a simulated arm never restart.
    if (may_activate_ && device_.fault() != driver::Fault::kNone) {
      device_.ask_to_activate(driver::HomeCheck::kPassed);
    }
  }
  ForceWritten written;
  if (!channel_.force.load(written, kAttempts) || written.number == taken_) return;
  const std::int64_t gap_ns = state.time_ns - renewed_ns_;
  if (stalled_.load(std::memory_order_relaxed)) {
    stalled_.store(false, std::memory_order_relaxed);
    own_opened_ = 0;
    own_opening_ = gap_ns > limits_.watchdog_ns ? limits_.soft_start : limits_.reopen;
  }
  taken_ = written.number;
  renewed_ns_ = state.time_ns;
  renewals_.store(renewals_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  f_asked_W_ = Eigen::Map<const Eigen::Vector3d>(written.asked.f_W.data());
}

Eigen::Vector3d ClientForce::own_part(const driver::DeviceState& state) noexcept {
  own_opened_ = opened_further(own_opened_, state.dt, own_opening_);
  const std::int64_t asked_ns = channel_.watchdog_ns.load(std::memory_order_relaxed);
  const std::int64_t max_age_ns =
      asked_ns > 0 ? std::min(asked_ns, limits_.stall_ns) : limits_.stall_ns;
  if (!f_asked_W_.isZero(0) && state.time_ns - renewed_ns_ > max_age_ns) {
    f_asked_W_.setZero();
    stalled_.store(true, std::memory_order_relaxed);
    stalls_.store(stalls_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  Eigen::Vector3d f_W = f_asked_W_;
  const double limit = channel_.force_limit.load(std::memory_order_relaxed);
  const double length = f_W.norm();
  if (limit > 0 && length > limit) f_W *= limit / length;
  return own_opened_ < 1 ? Eigen::Vector3d(f_W * own_opened_) : f_W;
}

}  // namespace thimble::compat
