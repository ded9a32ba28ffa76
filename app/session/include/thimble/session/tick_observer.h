#pragma once

#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// Whoever looks on at the ticks of a run: called once per tick on the servo thread, after the
/// force was sent.
class TickObserver {
 public:
  virtual ~TickObserver() = default;
  /// Takes the record of one tick. Real-time: safe.
  virtual void take(const driver::TickRecord& record) noexcept = 0;
};

}  // namespace thimble::session
