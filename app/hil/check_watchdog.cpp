#include "hil/check_watchdog.h"

#include <fmt/format.h>

#include "bringup/push_direction.h"
#include "bringup/watchdog_time.h"

namespace thimble::hil {
namespace {

constexpr const char* kName = "watchdog";

}  // namespace

HilResult check_watchdog_time(const HilRig& rig) {
  const auto& wire = rig.file.simulated.wire;
  const bringup::WatchdogOrder order{
      .named = static_cast<double>(rig.file.limits.watchdog_ns) * 1e-9,
      .mass = rig.file.simulated.plant.mass,
      .coulomb = rig.file.simulated.plant.coulomb,
      .delay = static_cast<double>(wire.delay_in_ns + wire.delay_out_ns) * 1e-9,
      .workspace = rig.file.workspace,
      .direction_W = bringup::push_direction(rig.file)};
  auto opened = open_active(rig, TipHold::kFree);
  if (!opened) return broken_off(kName, opened.error().message, nullptr);
  bringup::BenchArm& bench = **opened;
  const bringup::WatchdogPush seen = bringup::observe_watchdog(bench, order, 1, rig.stop);
  switch (seen.end) {
    case bringup::WatchdogEnd::kStopped:
      break;
    case bringup::WatchdogEnd::kTooLong:
      return skipped(
          kName,
          fmt::format("A watchdog of {:.0f} ms cannot be measured on a free tip within {:.0f} mm. "
                      "The feel check measures it with a hand on the grip (--attended).",
                      1e3 * order.named, 1e3 * bringup::kWatchdogWayMax));
    case bringup::WatchdogEnd::kNoRoom:
      return skipped(kName, fmt::format("The tip is too close to a side of the workspace for a "
                                        "push of {:.0f} mm. Move it to the middle.",
                                        1e3 * bringup::kWatchdogWayMax));
    case bringup::WatchdogEnd::kTooMuch:
      return skipped(
          kName,
          fmt::format(
              "The dry friction of the arm file needs a push of {:.2f} N, which exceeds the limit.",
              seen.force));
    case bringup::WatchdogEnd::kAnswersOnly:
      return skipped(
          kName,
          "The arm sends reports only on request, so the time of its watchdog cannot be measured.");
    case bringup::WatchdogEnd::kHeld:
      return judged(kName,
                    fmt::format("The tip moved only {:.2f} mm under {:.2f} N: it is held, or its "
                                "friction is higher than the arm file says.",
                                1e3 * seen.way, seen.force),
                    {{"watchdog_way", 1e3 * seen.way, "mm", "> 0.5", ""}});
    case bringup::WatchdogEnd::kLetGo:
      return skipped(kName,
                     fmt::format("The tip moved {:.0f} mm in {:.0f} ms and was released before the "
                                 "watchdog acted: its friction is lower than the arm file says.",
                                 1e3 * seen.way, 1e3 * seen.time));
    case bringup::WatchdogEnd::kStillOn:
      return judged(
          kName,
          fmt::format("The motors were still on {:.0f} ms after the last message, when the tip had "
                      "moved {:.0f} mm and was released. The arm file says {:.0f} ms.",
                      1e3 * seen.time, 1e3 * seen.way, 1e3 * order.named),
          {{"watchdog_seen", 0, "", "== 1", ""}});
    case bringup::WatchdogEnd::kSeen:
      return judged(
          kName,
          fmt::format("The motors went off {:.0f} ms after the last message; the arm file says "
                      "{:.0f} ms.",
                      1e3 * seen.time, 1e3 * order.named),
          {{"watchdog_time", 1e3 * seen.time, "ms", fmt::format("< {:g}", 2e3 * order.named), ""}});
  }
  return broken_off(kName, "", &bench);
}

}  // namespace thimble::hil
