#include "compat/server/read_hand_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "bag/read_bag.h"
#include "hand/bag_hand.h"
#include "system/regular_file.h"

namespace thimble::compat {

driver::Result<HandFile> read_hand_path(const std::filesystem::path& file) {
  HandFile hand;
  if (bag::is_bag(file)) {
    auto path = scene::read_bag_hand(file, {}, bag::BagAxes::kPlain);
    if (!path) return path.error();
    hand.path = std::move(path).value();
    return hand;
  }
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;  // hours at 1 kHz
  auto content = driver::read_file(file, kMaxBytes);
  if (!content) return driver::Error{file.string() + ": " + content.error().message};
  std::istringstream text(std::move(content).value());
  constexpr double kFarthest = 2;    // m, as in a scene
  constexpr double kLatest = 86400;  // s
  std::vector<scene::HandWaypoint>& stations = hand.path;
  bool any_buttons = false;
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
    const bool four = !fields.fail();
    long buttons = 0;
    const bool has_buttons = four && static_cast<bool>(fields >> rest);
    if (has_buttons) {
      char* end = nullptr;
      buttons = std::strtol(rest.c_str(), &end, 10);
      if (*end != 0) buttons = -1;
    }
    // Rejects NaN, too.
    const bool good = four && !(fields >> rest) && station.time >= 0 && station.time <= kLatest &&
                      (station.p_W.array().abs() <= kFarthest).all() && buttons >= 0 &&
                      buttons <= std::numeric_limits<std::uint16_t>::max();
    if (!good) {
      return driver::Error{fmt::format(
          "{}:{}: expected \"t x y z\" or \"t x y z buttons\", a time from 0 to 86400 s, "
          "coordinates from -2 to 2 m, and buttons from 0 to 65535.",
          file.string(), number)};
    }
    if (!stations.empty() && !(station.time > stations.back().time)) {
      return driver::Error{fmt::format("{}:{}: expected a time after that of the previous line.",
                                       file.string(), number)};
    }
    stations.push_back(station);
    hand.buttons.push_back({station.time, static_cast<std::uint16_t>(buttons)});
    any_buttons = any_buttons || has_buttons;
  }
  if (stations.empty()) {
    return driver::Error{file.string() + ": expected at least one line \"t x y z\", found none."};
  }
  if (!any_buttons) hand.buttons.clear();
  return hand;
}

}  // namespace thimble::compat
