#include "recording/bag_export.h"

#include <array>
#include <utility>
#include <vector>

#include "bag/write_bag.h"
#include "log/progress.h"

namespace thimble::session {

driver::Result<void> export_bag(const Recording& recording, const std::filesystem::path& folder) {
  if (recording.ticks.empty())
    return driver::Error{"The recording is empty; there is nothing to write."};
  // A recording written by another program may have negative times; a bag cannot.
  if (recording.ticks.front().time_ns < 0) {
    return driver::Error{"The recording begins before time zero, which a bag cannot store."};
  }
  bag::BagTrack poses, sent, wanted;
  poses.name = "/pose";
  sent.name = "/wrench";
  wanted.name = "/wrench_wanted";
  sent.kind = wanted.kind = bag::BagKind::kForces;
  const auto vector = [](const std::array<double, 3>& v) {
    return Eigen::Vector3d(v[0], v[1], v[2]);
  };
  for (const driver::TickRecord& tick : recording.ticks) {
    bag::BagMessage pose{.time_ns = tick.time_ns, .value = vector(tick.p_WT)};
    double length2 = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      pose.q[i] = tick.q_WT[i];
      length2 += pose.q[i] * pose.q[i];
    }
    if (!(length2 > 0)) pose.q = {1, 0, 0, 0};  // unknown orientation
    poses.messages.push_back(pose);
    sent.messages.push_back({.time_ns = tick.time_ns, .value = vector(tick.f_sent_W)});
    wanted.messages.push_back({.time_ns = tick.time_ns, .value = vector(tick.f_wanted_W)});
  }
  scene::Progress progress("bag");
  return bag::write_bag(folder, {std::move(poses), std::move(sent), std::move(wanted)},
                        [&progress](double share) { progress.set_share(share); });
}

}  // namespace thimble::session
