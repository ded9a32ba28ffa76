#pragma once

#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/snapshot.h"
#include "thimble/render/multirate/local_model.h"

namespace thimble::render {

/// Where a slow simulation leaves its newest model for the servo: one writer, any number of
/// readers, no lock. It holds no pointer, so it may lie in memory that two processes share.
class THIMBLE_EXPORT ModelSlot {
 public:
  /// Publishes a model. Fails, and the one before stays, if it has a flaw. From one thread.
  /// Real-time: never from the servo thread, for the sake of the sentence that it makes.
  driver::Result<void> publish(const LocalModel& model);

  /// Copies the newest model. False, and `model` stays, if there is none yet or if it is just being
  /// written; it is there in the next tick. What another process wrote is not checked.
  /// Real-time: safe; a few hundred instructions.
  bool newest(LocalModel& model) const noexcept;

  /// Returns how many models were published. Real-time: safe.
  std::uint64_t count() const noexcept { return snapshot_.count(); }

 private:
  /// A model as plain numbers: what a Snapshot copies.
  struct Words {
    double p[3], f[3], stiffness[9], damping, n[3];
    std::int64_t time_ns;
  };

  driver::Snapshot<Words> snapshot_;
};

}  // namespace thimble::render
