#include "recording/replay_trajectory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "math/elementary.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"

namespace thimble::session {
namespace {

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  // Accurate for small angles too.
  return math::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

TrajectoryComparison replay_trajectory(const std::vector<TrajectoryPoint>& trajectory_W,
                                       double rate, scene::SceneObjects& objects,
                                       const std::function<void(const driver::TickRecord&)>& sink) {
  TrajectoryComparison compared;
  const double begin = trajectory_W.front().time;
  const double period = 1 / rate;
  const auto ticks =
      static_cast<std::size_t>(std::floor((trajectory_W.back().time - begin) * rate)) + 1;
  std::size_t hint = 0;
  std::vector<double> angles;
  driver::DeviceState state;
  for (std::size_t i = 0; i < ticks; ++i) {
    const TrajectoryPoint point =
        trajectory_at(trajectory_W, begin + static_cast<double>(i) * period, hint);
    state.tick = i;
    state.time_ns = std::llround(1e9 * static_cast<double>(i) * period);
    state.dt = i == 0 ? 0 : period;
    state.v_WT = i == 0 ? Eigen::Vector3d::Zero() : Eigen::Vector3d((point.p - state.p_WT) * rate);
    state.p_WT = point.p;
    state.fresh = true;
    const driver::ForceCommand command = objects.touch()(state);
    objects.serve_pages();
    const double pressed = command.f_T_W.norm(), recorded = point.f.norm();
    if (command.touch.in_contact) ++compared.touching;
    compared.force_rms += pressed * pressed;
    compared.recorded_rms += recorded * recorded;
    compared.error_rms += (command.f_T_W - point.f).squaredNorm();
    if (pressed > TrajectoryComparison::kPress && recorded > TrajectoryComparison::kPress) {
      angles.push_back(angle_between(command.f_T_W, point.f));
    } else if (std::max(pressed, recorded) > TrajectoryComparison::kPress &&
               std::min(pressed, recorded) == 0) {
      ++compared.contact_disagrees;
    }
    if (!sink) continue;
    driver::TickRecord record = driver::record_of(state, command);
    record.f_sent_W = record.f_wanted_W;  // there is no gate
    record.stage = driver::DeviceStage::kActive;
    sink(record);
  }
  compared.ticks = ticks;
  for (double* sum : {&compared.force_rms, &compared.recorded_rms, &compared.error_rms}) {
    *sum = std::sqrt(*sum / static_cast<double>(ticks));
  }
  compared.directions = angles.size();
  if (!angles.empty()) {
    const auto p99 = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() * 99 / 100);
    std::nth_element(angles.begin(), p99, angles.end());
    compared.direction_p99 = *p99;
  }
  return compared;
}

}  // namespace thimble::session
