#include "limits_in_force.h"

#include <fmt/format.h>

#include "energy_guard_settings.h"
#include "setup.h"

namespace thimble::session {
namespace {

std::string hold_text(const driver::HoldToRun& hold) {
  if (!hold.named()) return "none";
  std::string words;
  for (int button = 0; button < 16; ++button) {
    if ((hold.buttons >> button & 1) != 0) words += fmt::format(" or button {}", button + 1);
  }
  words = words.empty() ? "" : words.substr(4);
  if (hold.by_caller) words += words.empty() ? "a key" : " and a key";
  return words;
}

std::string power_text(const driver::GateLimits& limits) {
  if (limits.power_max <= 0) return "mean power: none";
  return fmt::format("mean power {:g} W over {:g} s", limits.power_max, limits.power_time);
}

}  // namespace

std::string limits_in_force(const Setup& setup, std::size_t arm) {
  const driver::Device& device = setup.device(arm);
  const driver::GateLimits& limits = device.gate().limits();
  const driver::DeviceSettings& settings = device.settings();
  const auto ms = [](std::int64_t ns) { return 1e-6 * static_cast<double>(ns); };
  const auto& walls = settings.walls;
  return fmt::format(
      "Active limits: {:g} N, {:g} m/s, {}, rise {:g} N/s, soft start {:g} s and {:g} s after a "
      "stall, stall at {:g} ms, stall fault at {:g} ms, silence fault at {:g} ms, energy stage {}, "
      "force held without new counts for at most {:g} s, walls of {:g} N/m from ({:g}, {:g}, {:g}) "
      "to ({:g}, {:g}, {:g}) mm with a fault {:g} mm behind them, enabling input: {}, feel check: "
      "{}.",
      limits.force_max, limits.speed_max, power_text(limits), limits.rise_max, limits.soft_start,
      limits.reopen, ms(limits.stall_ns), ms(limits.watchdog_ns), ms(settings.silence_limit_ns),
      scene::kEnergyStageNames[static_cast<std::size_t>(settings.energy.stage)],
      settings.motion.max_hold, walls.stiffness, 1e3 * walls.min_W.x(), 1e3 * walls.min_W.y(),
      1e3 * walls.min_W.z(), 1e3 * walls.max_W.x(), 1e3 * walls.max_W.y(), 1e3 * walls.max_W.z(),
      1e3 * walls.beyond, hold_text(settings.hold), name(setup.feel_check(arm)));
}

}  // namespace thimble::session
