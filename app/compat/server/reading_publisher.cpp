#include "compat/server/reading_publisher.h"

#include <cmath>
#include <numbers>
#include <variant>

#include "compat/core/shared_wait.h"
#include "thimble/driver/orientation.h"

namespace thimble::compat {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

void put(const Eigen::Matrix3d& matrix, std::array<double, 9>& to) noexcept {
  Eigen::Map<RowMajor>(to.data()) = matrix;
}

}  // namespace

Eigen::Matrix3d jacobian_of(const scene::ArmFile& arm, const Eigen::Vector3d& q) noexcept {
  Eigen::Vector3d p_BT;
  Eigen::Matrix3d J_BT = Eigen::Matrix3d::Zero();
  std::visit([&](const auto& build) { build.forward(q, p_BT, J_BT); }, arm.model.geometry);
  return arm.R_WB * J_BT;
}

ReadingPublisher::ReadingPublisher(ArmChannel& channel, const ClientForce& client,
                                   const driver::Device& device, const scene::ArmFile& arm) noexcept
    : channel_(channel),
      client_(client),
      device_(device),
      arm_(arm),
      counters_(device.gate_counters()) {}

void ReadingPublisher::take(const driver::TickRecord& record) noexcept {
  reading_.tick = record.tick;
  reading_.time_ns = record.time_ns;
  reading_.p_WT = record.p_WT;
  reading_.v_WT = record.v_WT;
  reading_.q = record.q;
  reading_.gimbal = record.gimbal;
  reading_.gripper = record.gripper;
  reading_.counts = record.counts;
  reading_.buttons = record.buttons;
  Eigen::Map<Eigen::Vector3d>(reading_.f_client_W.data()) = client_.f_client_W();
  reading_.f_asked_W = record.f_wanted_W;
  reading_.f_sent_W = record.f_sent_W;
  reading_.heat = record.heat;
  reading_.stalled = client_.stalled();
  reading_.stage = record.stage;
  reading_.fault = record.fault;
  reading_.link = record.link;
  turn(record);
  if (device_.traits().has_joints) find_jacobian(record);
  look_at_gate();
  // A person who is moved by an arm lets it. If the arm cannot reach the point, the hand stays.
  if (hand_of_ != nullptr && (hand_is_free_ || channel_.regulated.load() != 0)) {
    hand_of_->lead(Eigen::Map<const Eigen::Vector3d>(record.p_WT.data()));
  }
  time_ns_ = record.time_ns;
  channel_.reading.store(reading_);
  channel_.taken.store(client_.taken());
  channel_.ticks.fetch_add(1);
  if (channel_.waiting.load() != 0) wake_all(channel_.ticks);
}

void ReadingPublisher::turn(const driver::TickRecord& record) noexcept {
  if (!device_.traits().has_orientation) return;
  const Eigen::Matrix3d R_WT = driver::rotation_of(record.q_WT);
  const double dt = 1e-9 * static_cast<double>(record.time_ns - time_ns_);
  if (time_ns_ != 0 && dt > 0) {
    // The rotation of one tick is small: its antisymmetric part gives axis and sine.
    const Eigen::Matrix3d turned = R_WT * R_WT_.transpose();
    const Eigen::Vector3d w_W =
        Eigen::Vector3d(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0),
                        turned(1, 0) - turned(0, 1)) /
        (2 * dt);
    const double corner = arm_.velocity_corner_frequency;
    const double way = corner > 0 ? 1 - std::exp(-2 * std::numbers::pi * corner * dt) : 1;
    w_WT_ += way * (w_W - w_WT_);
  }
  R_WT_ = R_WT;
  put(R_WT, reading_.R_WT);
  Eigen::Map<Eigen::Vector3d>(reading_.w_WT.data()) = w_WT_;
}

void ReadingPublisher::find_jacobian(const driver::TickRecord& record) noexcept {
  put(jacobian_of(arm_, Eigen::Map<const Eigen::Vector3d>(record.q.data())), reading_.J_WT);
}

void ReadingPublisher::look_at_gate() noexcept {
  const driver::GateCounters& now = device_.gate_counters();
  reading_.cuts.limited = now.limited != counters_.limited;
  reading_.cuts.rise_limited = now.rise_limited != counters_.rise_limited;
  reading_.cuts.soft_started = now.soft_started != counters_.soft_started;
  reading_.cuts.damped = now.damped != counters_.damped || now.bounded != counters_.bounded;
  counters_ = now;
}

}  // namespace thimble::compat
