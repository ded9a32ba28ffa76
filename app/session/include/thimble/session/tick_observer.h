#pragma once

#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// An observer of a run's ticks. A session tells each of its observers of every tick, in the order
/// in which they were added, once the force of the tick was sent.
///
/// `take` runs on the servo's thread and belongs to its tick: no heap, lock, file or waiting, and a
/// time that does not grow with the run. What it keeps for others it hands on without waiting
/// (driver::Snapshot, an atomic), or is looked at after the run.
class THIMBLE_EXPORT TickObserver {
 public:
  virtual ~TickObserver() = default;

  /// Takes one tick. Real-time: must be safe.
  virtual void take(const driver::TickRecord& record) noexcept = 0;
};

}  // namespace thimble::session
