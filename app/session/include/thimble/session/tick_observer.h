#pragma once

#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// Observer of the ticks of a run. A session calls its observers once per tick, in the order in
/// which they were added, after the force of the tick was sent.
///
/// `take` runs on the servo's thread. It must not allocate, lock, access files or wait, and its
/// duration must not grow with the run. It passes data to other threads without waiting
/// (driver::Snapshot, an atomic), or the data is read after the run.
class THIMBLE_EXPORT TickObserver {
 public:
  virtual ~TickObserver() = default;

  /// Receives one tick. Real-time: must be safe.
  virtual void take(const driver::TickRecord& record) noexcept = 0;
};

}  // namespace thimble::session
