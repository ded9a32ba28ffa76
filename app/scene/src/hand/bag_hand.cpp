#include "hand/bag_hand.h"

#include <fmt/format.h>

#include <utility>

#include "bag/read_bag.h"

namespace thimble::scene {

driver::Result<std::vector<HandWaypoint>> read_bag_hand(const std::filesystem::path& bag,
                                                        const std::string& topic,
                                                        bag::BagAxes axes) {
  constexpr double kDistanceMax = 2;  // m, as for a path in a scene
  // Ten samples per period of the fastest hand motion; one nanosecond less, because times are
  // rounded.
  constexpr double kSpacingMin = 0.01 - 1e-9;  // s [chosen]
  const auto read = bag::read_bag(bag, bag::BagKind::kPositions, topic);
  if (!read) return read.error();
  std::vector<HandWaypoint> hand;
  for (const bag::BagSample& sample : read->samples) {
    HandWaypoint waypoint;
    waypoint.time = sample.time;
    waypoint.p_W = bag::in_world(axes, sample.value);
    if (!(waypoint.p_W.array().abs() <= kDistanceMax).all()) {
      return driver::Error{fmt::format(
          "{}: {} is {:.3g} m from the origin after {:g} s; expected positions in m, within 2 m.",
          bag.string(), read->name, waypoint.p_W.norm(), sample.time)};
    }
    const bool last = &sample == &read->samples.back();
    if (!hand.empty() && waypoint.time - hand.back().time < kSpacingMin && !last) continue;
    hand.push_back(std::move(waypoint));
  }
  return hand;
}

}  // namespace thimble::scene
