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

/// What a session keeps of all of its ticks.
struct KeptTicks {
  /// Makes room for a run of `ticks` (0: unknown) at `rate` (Hz).
  KeptTicks(std::uint64_t ticks, double rate)
      : trace(ticks, ticks == 0 ? kRowsOfEndless : Trace::kDefaultRowsMax), black_box(rate) {}

  /// Rows of the trace of a run whose end nobody knows: 80 MB, 5 min at 1 kHz. [chosen]
  static constexpr std::size_t kRowsOfEndless = 300'000;

  RunStatistics statistics;
  Trace trace;
  BlackBox black_box;
};

/// What a session keeps of its own run: observers that know nothing of each other.
struct RunRecords {
  /// Makes room for a run of `ticks` (0: unknown) at `rate` (Hz), of which it keeps as much as
  /// `keep` says.
  RunRecords(std::uint64_t ticks, double rate, Keep keep) {
    if (keep == Keep::kRun) kept = std::make_unique<KeptTicks>(ticks, rate);
  }

  /// Lets a loop tell them of each tick, apart from dents, poses and recording.
  void join(RunLoop& loop) {
    loop.add(latest);
    if (!kept) return;
    loop.add(kept->statistics);
    loop.add(kept->trace);
    loop.add(kept->black_box);
  }

  LatestTick latest;
  std::unique_ptr<KeptTicks> kept;    ///< Null if the newest tick alone is kept.
  std::unique_ptr<DentRecord> dents;  ///< Null likewise, and if no object of the scene can dent.
  std::unique_ptr<PoseRecord> poses;  ///< Null likewise, and if no object of the scene moves.
  RecordingSwitch recording;          ///< From one thread beside the servo's, and after the run.
};

}  // namespace thimble::session
