#pragma once

#include <cstdint>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::support {

/// Returns the ticks of a scripted run at 1 kHz: free, then in contact from tick `down` up to but
/// not including `up`. Depth and force are largest half-way.
inline std::vector<driver::TickRecord> scripted_run(std::uint64_t ticks, std::uint64_t down,
                                                    std::uint64_t up) {
  std::vector<driver::TickRecord> run(ticks);
  for (std::uint64_t i = 0; i < ticks; ++i) {
    driver::TickRecord& tick = run[i];
    tick.tick = i;
    tick.time_ns = tick.due_ns = static_cast<std::int64_t>(i) * 1'000'000;
    tick.fresh = true;
    tick.stage = driver::DeviceStage::kActive;
    tick.in_contact = i >= down && i < up;
    if (!tick.in_contact) continue;
    const auto before = static_cast<double>(i - down), after = static_cast<double>(up - i);
    tick.depth = 1e-5 * (before < after ? before : after);
    tick.f_sent_W = tick.f_wanted_W = {0, 0, 800 * tick.depth};
  }
  return run;
}

/// Passes a run to an observer, as a session does.
inline void feed(session::TickObserver& observer, const std::vector<driver::TickRecord>& run) {
  for (const driver::TickRecord& tick : run) observer.take(tick);
}

}  // namespace thimble::support
