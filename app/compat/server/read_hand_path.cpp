#include "compat/server/read_hand_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "bag/read_bag.h"
#include "hand/bag_hand.h"
#include "system/regular_file.h"

namespace thimble::compat {

driver::Result<std::vector<scene::HandWaypoint>> read_hand_path(const std::filesystem::path& file) {
  if (bag::is_bag(file)) return scene::read_bag_hand(file, {}, bag::BagAxes::kPlain);
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;  // hours at 1 kHz
  auto content = driver::read_file(file, kMaxBytes);
  if (!content) return driver::Error{file.string() + ": " + content.error().message};
  std::istringstream text(std::move(content).value());
  constexpr double kFarthest = 2;    // m, as in a scene
  constexpr double kLatest = 86400;  // s
  std::vector<scene::HandWaypoint> stations;
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    line.resize(std::min(line.find('#'), line.size()));
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    std::istringstream fields(line);
    std::string rest;
    scene::HandWaypoint station;
    if (!(fields >> rest)) continue;
    fields.clear();
    fields.seekg(0);
    rest.clear();
    fields >> station.time >> station.p_W.x() >> station.p_W.y() >> station.p_W.z();
    // Rejects NaN, too.
    const bool good = !fields.fail() && !(fields >> rest) && station.time >= 0 &&
                      station.time <= kLatest && (station.p_W.array().abs() <= kFarthest).all();
    if (!good) {
      return driver::Error{fmt::format(
          "{}:{}: expected \"t x y z\", a time from 0 to 86400 s and coordinates from -2 to 2 m.",
          file.string(), number)};
    }
    if (!stations.empty() && !(station.time > stations.back().time)) {
      return driver::Error{fmt::format("{}:{}: expected a time after that of the previous line.",
                                       file.string(), number)};
    }
    stations.push_back(station);
  }
  if (stations.empty()) {
    return driver::Error{file.string() + ": expected at least one line \"t x y z\", found none."};
  }
  return stations;
}

}  // namespace thimble::compat
