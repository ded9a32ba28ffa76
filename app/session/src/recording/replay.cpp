#include "recording/replay.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_command.h"

namespace thimble::session {
namespace {

Eigen::Vector3d vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}
std::array<double, 3> plain(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

ReplayComparison replay(std::span<const driver::TickRecord> recorded, scene::SceneObjects& objects,
                        const std::function<void(const driver::TickRecord&)>& sink) {
  ReplayComparison comparison;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const driver::TickRecord& then = recorded[i];
    driver::DeviceState state;
    state.time_ns = then.time_ns;
    state.tick = then.tick;
    // As the device reckons it, so that it is the same to the bit.
    state.dt = i == 0 ? 0 : static_cast<double>(then.time_ns - recorded[i - 1].time_ns) * 1e-9;
    state.p_WT = vector(then.p_WT);
    state.v_WT = vector(then.v_WT);
    state.q = vector(then.q);
    state.counts = then.counts;
    state.buttons = then.buttons;
    state.fresh = then.fresh;
    state.has_orientation = then.q_WT != driver::TipQuaternion{};
    state.q_WT = then.q_WT;
    state.R_WT = driver::rotation_of(then.q_WT);
    state.gimbal = then.gimbal;
    state.has_gripper = then.has_gripper;
    state.gripper = then.gripper;
    const driver::ForceCommand command = objects.touch()(state);
    objects.serve_pages();

    ++comparison.ticks;
    const auto f_W = plain(command.f_T_W);
    using Bits = std::array<std::uint64_t, 3>;
    if (std::bit_cast<Bits>(f_W) != std::bit_cast<Bits>(then.f_wanted_W)) {
      ++comparison.differing;
      if (!comparison.first) comparison.first = then.tick;
      const double difference = (command.f_T_W - vector(then.f_wanted_W)).norm();
      // Written so that NaN counts as the largest.
      if (!(difference <= comparison.largest)) comparison.largest = difference;
    }
    if (!sink) continue;
    driver::TickRecord now = then;
    now.f_wanted_W = f_W;
    now.in_contact = command.touch.in_contact;
    now.object = command.touch.object;
    now.feature = command.touch.feature;
    now.depth = command.touch.depth;
    now.p_WP = plain(command.touch.p_WP);
    now.n_W = plain(command.touch.n_W);
    now.hops = command.touch.hops;
    sink(now);
  }
  return comparison;
}

std::optional<std::size_t> first_gap(std::span<const driver::TickRecord> recorded) {
  const auto gap =
      std::adjacent_find(recorded.begin(), recorded.end(),
                         [](const auto& a, const auto& b) { return b.tick != a.tick + 1; });
  if (gap == recorded.end()) return {};
  return static_cast<std::size_t>(gap - recorded.begin());
}

}  // namespace thimble::session
