#include "vendors/slot_link.h"

#include <algorithm>

namespace thimble::driver {
namespace {

/// Interval of checks for a new state while a read waits, ns. [chosen: a tenth of a tick]
constexpr std::int64_t kLook_ns = 100'000;

}  // namespace

LinkRead SlotLink::read(ArmSample& sample, std::int64_t deadline_ns) noexcept {
  while (true) {
    if (is_lost()) return {LinkStatus::kLost};
    const std::uint64_t before = taken_.number;
    if (newest_.take(taken_)) {
      sample = taken_.sample;
      return {LinkStatus::kOk, static_cast<std::uint32_t>(taken_.number - before - 1)};
    }
    const std::uint64_t rejected = rejected_.load(std::memory_order_relaxed);
    if (rejected != rejected_seen_) {
      rejected_seen_ = rejected;
      return {LinkStatus::kRejected};
    }
    const std::int64_t now_ns = clock_.now_ns();
    if (now_ns >= deadline_ns) return {LinkStatus::kNothing};
    clock_.sleep_until_ns(std::min(deadline_ns, now_ns + kLook_ns));
  }
}

LinkWrite SlotLink::write(const GatedForce& force, const ArmSample&,
                          const Eigen::Matrix3d& R_WB) noexcept {
  if (is_lost()) return {LinkStatus::kLost};
  const double length = force.f_T_W().norm();
  const double scale = length > max_force_ ? max_force_ / length : 1;
  // A refused force must not be sent when the arm takes forces again.
  const bool refuses = refuses_.load(std::memory_order_acquire);
  const bool taken =
      box_.put(refuses ? Eigen::Vector3d(0, 0, 0)
                       : Eigen::Vector3d(scale * (R_WB.transpose() * force.f_T_W())));
  ring();
  // Meanwhile the arm has zero force.
  if (!taken || (refuses && length > 0)) return {LinkStatus::kRefused};
  return {LinkStatus::kOk, scale};
}

LinkStatus SlotLink::settled() noexcept {
  if (box_.zero_settled()) return LinkStatus::kOk;
  return is_lost() ? LinkStatus::kLost : LinkStatus::kNothing;
}

void SlotLink::publish(const ArmSample& sample) noexcept {
  NumberedSample fresh{sample, ++published_};
  fresh.sample.pose.q = sample.pose.p_BT;  // as in VendorPoseArm
  newest_.put(fresh);
}

void SlotLink::reject() noexcept {
  rejected_.fetch_add(1, std::memory_order_relaxed);
}

void SlotLink::lose() noexcept {
  lost_.store(true, std::memory_order_release);
}

bool SlotLink::is_lost() const noexcept {
  return lost_.load(std::memory_order_acquire);
}

}  // namespace thimble::driver
