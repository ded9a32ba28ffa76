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
#include "thimble/session/run_statistics.h"

namespace thimble::session {

/// What a session keeps of its own run: observers that know nothing of each other.
struct RunRecords {
  /// Makes room for a run of `ticks` (0: unknown) at `rate` (Hz).
  RunRecords(std::uint64_t ticks, double rate)
      : trace(ticks, ticks == 0 ? kRowsOfEndless : Trace::kDefaultRowsMax), black_box(rate) {}

  /// Rows of the trace of a run whose end nobody knows: 80 MB, 5 min at 1 kHz. [chosen]
  static constexpr std::size_t kRowsOfEndless = 300'000;

  LatestTick latest;
  RunStatistics statistics;
  Trace trace;
  BlackBox black_box;
  std::unique_ptr<DentRecord> dents;  ///< Null if no object of the scene can dent.
  std::unique_ptr<PoseRecord> poses;  ///< Null if no object of the scene moves.
  RecordingSwitch recording;          ///< From one thread beside the servo's, and after the run.
};

}  // namespace thimble::session
