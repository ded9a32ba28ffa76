#pragma once

#include "thimble/driver/snapshot.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Newest tick of a run, for any number of readers on other threads.
class LatestTick final : public TickObserver {
 public:
  /// Receives one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override { snapshot_.store(record); }

  /// Returns the newest tick; any thread may load it.
  const driver::Snapshot<driver::TickRecord>& snapshot() const noexcept { return snapshot_; }

 private:
  driver::Snapshot<driver::TickRecord> snapshot_;
};

}  // namespace thimble::session
