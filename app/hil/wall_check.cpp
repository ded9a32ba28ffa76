#include "hil/wall_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "bringup/identify/simulated_bench.h"
#include "bringup/push_direction.h"
#include "hil/edge_of_wall.h"

namespace thimble::hil {
namespace {

constexpr const char* kName = "stiffest_wall";
// A wall takes a second, a start two to three walls: some 100 s, and 200.
constexpr int kStartsOfQuick = 33, kStartsOfFull = 65;
// Relative to the twin's, below and above. Edges of one start differ by a tenth, the median of 33
// by 2 to 3 % (Hil.JudgesTheStiffestWallToATenth).
constexpr double kAllowed = 0.1;

/// Returns the ratio of the edges of an arm to those of its twin, start by start: effects of the
/// start on both cancel.
MedianInterval over_twin(const EdgeOfWall& found, const EdgeOfWall& twin) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < found.at_start.size(); ++i) {
    ratios.push_back(found.at_start[i] / twin.at_start[i]);
  }
  return median_interval(std::move(ratios));
}

}  // namespace

HilResult check_stiffest_wall(const HilRig& rig, bool full) {
  EdgeSearch search{.direction_W = bringup::push_direction(rig.file),
                    .starts = full ? kStartsOfFull : kStartsOfQuick};
  const double law = edge_by_law(rig.file, search.speed);
  search.first = std::max(20.0, 0.25 * law);
  auto twin_bench = bringup::simulated_bench(rig.file, 0);
  if (!twin_bench) return broken_off(kName, twin_bench.error().message, nullptr);
  const auto twin = find_edge_of_wall(**twin_bench, rig.file, search, rig.stop);
  if (!twin) {
    return skipped(kName,
                   "The simulated arm of the file supports no wall, so there is no reference: " +
                       twin.error().message);
  }
  auto bench = rig.open(TipHold::kFree);
  if (!bench) return broken_off(kName, bench.error().message, nullptr);
  const auto found = find_edge_of_wall(**bench, rig.file, search, rig.stop);
  if (!found) return broken_off(kName, found.error().message, bench->get());
  const MedianInterval ratio = over_twin(*found, *twin);
  return judged(
      kName,
      fmt::format("The stiffest wall that adds no energy to a tip at {:g} mm/s has {}{:.0f} N/m "
                  "({:.0f} to {:.0f}, median of {} starts). The simulated arm of the file has "
                  "{}{:.0f} N/m, the law gives {:.0f} N/m. The median ratio of real to simulated "
                  "stiffness is {:.3f} (95 %: {:.3f} to {:.3f}).",
                  1e3 * search.speed, found->grew ? "" : "at least ", found->stiffness.median,
                  found->stiffness.low, found->stiffness.high, search.starts,
                  twin->grew ? "" : "at least ", twin->stiffness.median, law, ratio.median,
                  ratio.low, ratio.high),
      {{"stiffest_wall", found->stiffness.median, "N/m", "", ""},
       {"stiffest_wall_low", found->stiffness.low, "N/m", "", "95 % interval of the median"},
       {"stiffest_wall_high", found->stiffness.high, "N/m", "", "95 % interval of the median"},
       {"stiffest_wall_by_law", law, "N/m", "", ""},
       {"stiffest_wall_of_twin", twin->stiffness.median, "N/m", "", ""},
       {"wall_over_twin", ratio.median, "", fmt::format(">= {:g}", 1 - kAllowed), ""},
       {"wall_over_twin_above", ratio.median, "", fmt::format("<= {:.4g}", 1 / (1 - kAllowed)),
        "upper bound of the same value"},
       {"wall_over_twin_low", ratio.low, "", "", "95 % interval"},
       {"wall_over_twin_high", ratio.high, "", "", "95 % interval"},
       {"energy_given", 1e3 * found->max_energy_given, "mJ", "", "by the wall that added most"},
       {"max_force", found->max_force, "N", fmt::format("<= {:g}", kHilForceMax), ""}});
}

}  // namespace thimble::hil
