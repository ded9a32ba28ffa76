#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "share/shared_scene.h"
#include "thimble/driver/tick_record.h"

namespace thimble::web {

/// Update as read by a page (web/live_feed.h).
struct LiveUpdate {
  nlohmann::json json;
  std::string numbers;

  template <class Number>
  std::vector<Number> array(const std::string& name) const {
    if (!json["arrays"].contains(name)) return {};
    const auto& place = json["arrays"][name];
    std::vector<Number> all(place["count"].get<std::size_t>());
    const auto offset = place["offset"].get<std::size_t>();
    if (offset + all.size() * sizeof(Number) > numbers.size()) return {};
    if (!all.empty()) std::memcpy(all.data(), numbers.data() + offset, all.size() * sizeof(Number));
    return all;
  }
};

/// Parses a message; stops at invalid data.
inline std::vector<LiveUpdate> updates_of(std::string_view message) {
  std::vector<LiveUpdate> updates;
  while (message.size() >= 8) {
    std::uint32_t sizes[2] = {0, 0};
    std::memcpy(sizes, message.data(), sizeof sizes);
    if (sizes[0] % 8 != 0 || sizes[1] % 8 != 0 || 8 + sizes[0] + sizes[1] > message.size()) break;
    LiveUpdate update;
    update.json = nlohmann::json::parse(message.substr(8, sizes[0]), nullptr, false);
    update.numbers = message.substr(8 + sizes[0], sizes[1]);
    updates.push_back(std::move(update));
    message.remove_prefix(8 + sizes[0] + sizes[1]);
  }
  return updates;
}

/// Returns the numbers of the ticks in a message, in order.
inline std::vector<std::uint32_t> ticks_of(std::string_view message) {
  std::vector<std::uint32_t> ticks;
  for (const LiveUpdate& update : updates_of(message)) {
    const auto own = update.array<std::uint32_t>("arm0.tick");
    ticks.insert(ticks.end(), own.begin(), own.end());
  }
  return ticks;
}

/// Tick in which all values follow from one number.
inline driver::TickRecord live_tick(std::uint64_t number) {
  driver::TickRecord tick;
  tick.tick = number;
  tick.time_ns = tick.due_ns = 7'000'000'000 + static_cast<std::int64_t>(number) * 1'000'000;
  tick.p_WT = tick.p_WP = {1e-5 * static_cast<double>(number % 1000), 0, 0.01};
  tick.f_sent_W = tick.f_wanted_W = {0, 0, 1e-3 * static_cast<double>(number % 1000)};
  tick.stage = driver::DeviceStage::kActive;
  return tick;
}

/// A triangle that dents, and two that are deformed permanently.
inline session::SharedScene live_scene() {
  session::SharedScene scene;
  scene.name = "small";
  scene.period_ns = 1'000'000;
  scene.force_max = 6;
  scene.arms.front().name = "vintage";
  scene.arms.front().device = "sim";
  scene.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  scene.triangles = {{0, 1, 2}, {3, 4, 5}, {4, 3, 5}};
  scene.objects.push_back({.name = "stiff", .dents = true, .vertex_count = 3, .triangle_count = 1});
  scene.objects.push_back({.name = "clay",
                           .shaped = true,
                           .first_vertex = 3,
                           .vertex_count = 3,
                           .first_triangle = 1,
                           .triangle_count = 2,
                           .max_splits = 2});
  return scene;
}

}  // namespace thimble::web
