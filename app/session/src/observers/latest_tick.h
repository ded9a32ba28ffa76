#pragma once

#include "thimble/driver/snapshot.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// The newest tick of a run, for any number of readers on other threads.
class LatestTick final : public TickObserver {
 public:
  /// Takes one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override { snapshot_.store(record); }

  /// Returns the tick; any thread may load it.
  const driver::Snapshot<driver::TickRecord>& snapshot() const noexcept { return snapshot_; }

 private:
  driver::Snapshot<driver::TickRecord> snapshot_;
};

}  // namespace thimble::session
