#include "recording/replay_bag.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "bag/read_bag.h"

namespace thimble::session {
namespace {

/// Reads the forces of a bag on the clock of its positions. Empty if the bag has none and no topic
/// was requested.
driver::Result<std::optional<bag::BagTopic>> read_forces(const std::filesystem::path& file,
                                                         const std::string& topic,
                                                         bag::BagTopic& positions) {
  auto forces = bag::read_bag(file, bag::BagKind::kForces, topic);
  if (!forces) {
    const bool none = forces.error().message.find("has no topic of type") != std::string::npos;
    if (topic.empty() && none) return std::optional<bag::BagTopic>();
    return forces.error();
  }
  if (forces->clock != positions.clock) {
    // One of the two topics has no stamps.
    auto again =
        bag::read_bag(file, bag::BagKind::kPositions, positions.name, bag::BagClock::kReceived);
    if (!again) return again.error();
    positions = std::move(again).value();
    forces = bag::read_bag(file, bag::BagKind::kForces, forces->name, bag::BagClock::kReceived);
    if (!forces) return forces.error();
  }
  const double ahead = 1e-9 * static_cast<double>(positions.start_ns - forces->start_ns);
  if (!(ahead <= forces->samples.back().time && -ahead <= positions.samples.back().time)) {
    return driver::Error{file.string() + ": " + positions.name + " and " + forces->name +
                         " do not overlap in time; choose topics of one run."};
  }
  return std::optional(std::move(forces).value());
}

}  // namespace

driver::Result<BagReplay> replay_bag(const std::filesystem::path& file, const BagTopics& topics,
                                     const std::filesystem::path& scene_file) {
  auto positions = bag::read_bag(file, bag::BagKind::kPositions, topics.pose);
  if (!positions) return positions.error();
  auto forces = read_forces(file, topics.wrench, *positions);
  if (!forces) return forces.error();
  std::vector<TrajectoryPoint> recorded;  // forces, stored as positions
  if (*forces) {
    const double late = 1e-9 * static_cast<double>((*forces)->start_ns - positions->start_ns);
    for (const bag::BagSample& sample : (*forces)->samples) {
      recorded.push_back({.time = late + sample.time, .p = sample.value});
    }
  }
  std::vector<TrajectoryPoint> trajectory;
  std::size_t hint = 0;
  for (const bag::BagSample& sample : positions->samples) {
    TrajectoryPoint point{.time = sample.time, .p = bag::in_world(topics.axes, sample.value)};
    if (!(point.p.array().abs() < 10).all()) {  // m, as for a trajectory; true for NaN
      return driver::Error{file.string() + ": " + positions->name +
                           " has a position more than 10 m away; expected positions in m."};
    }
    if (!recorded.empty()) {
      point.f = bag::in_world(topics.axes, trajectory_at(recorded, sample.time, hint).p);
    }
    trajectory.push_back(point);
  }
  if (trajectory.size() < 2) {
    return driver::Error{file.string() + ": " + positions->name + " has fewer than two positions."};
  }
  auto replay = touch_along(trajectory, {}, scene_file);
  if (!replay) return replay.error();
  BagReplay result{.replay = std::move(replay).value(), .has_forces = !recorded.empty()};
  result.replay.felt.info.device = "bag " + file.string();
  hint = 0;
  for (const driver::TickRecord& tick : result.replay.felt.ticks) {
    const double time = trajectory.front().time + 1e-9 * static_cast<double>(tick.time_ns);
    const Eigen::Vector3d f(tick.f_wanted_W[0], tick.f_wanted_W[1], tick.f_wanted_W[2]);
    if (result.has_forces) {
      result.error_max =
          std::max(result.error_max, (f - trajectory_at(trajectory, time, hint).f).norm());
    }
  }
  return result;
}

}  // namespace thimble::session
