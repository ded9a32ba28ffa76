#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "observers/black_box.h"
#include "observers/dent_record.h"
#include "observers/latest_tick.h"
#include "observers/pose_record.h"
#include "observers/trace.h"
#include "recording/recording_switch.h"
#include "run_loop.h"
#include "thimble/session/run_statistics.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Data that a session keeps of all its ticks.
struct KeptTicks {
  /// Allocates memory for a run of `ticks` (0: unknown) at `rate` (Hz).
  KeptTicks(std::uint64_t ticks, double rate)
      : trace(ticks, ticks == 0 ? kRowsOfEndless : Trace::kDefaultRowsMax), black_box(rate) {}

  /// Rows of the trace of a run of unknown duration: 80 MB, 5 min at 1 kHz. [chosen]
  static constexpr std::size_t kRowsOfEndless = 300'000;

  RunStatistics statistics;
  Trace trace;
  BlackBox black_box;
};

/// Observers that belong to a session; independent of each other.
struct RunRecords {
  /// Allocates memory for a run of `ticks` (0: unknown) at `rate` (Hz), as selected by `keep`.
  RunRecords(std::uint64_t ticks, double rate, Keep keep) {
    if (keep == Keep::kRun) kept = std::make_unique<KeptTicks>(ticks, rate);
  }

  /// Adds the observers to a loop, except dents, poses and recording.
  void join(RunLoop& loop) {
    loop.add(latest);
    if (!kept) return;
    loop.add(kept->statistics);
    loop.add(kept->trace);
    loop.add(kept->black_box);
  }

  LatestTick latest;
  std::unique_ptr<KeptTicks> kept;  ///< Null if only the newest tick is kept.
  /// Null if only the newest tick is kept, or if no object can dent.
  std::unique_ptr<DentRecord> dents;
  /// Null if only the newest tick is kept, or if no object moves.
  std::unique_ptr<PoseRecord> poses;
  /// Used from one thread besides the servo's, and after the run.
  RecordingSwitch recording;
};

}  // namespace thimble::session
