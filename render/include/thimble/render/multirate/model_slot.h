#pragma once

#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/snapshot.h"
#include "thimble/render/multirate/local_model.h"

namespace thimble::render {

/// Slot through which a slow simulation passes its newest model to the servo: one writer, any
/// number of readers, no lock. It contains no pointers, so it can be in memory shared by two
/// processes.
class THIMBLE_EXPORT ModelSlot {
 public:
  /// Publishes a model. Fails and keeps the previous one if the model has a flaw. Call from one
  /// thread. Real-time: never from the servo thread, because it creates an error text.
  driver::Result<void> publish(const LocalModel& model);

  /// Copies the newest model. Returns false and leaves `model` unchanged if there is none yet or a
  /// write is in progress; the model is then available in the next tick. A model written by another
  /// process is not checked. Real-time: safe; a few hundred instructions.
  bool newest(LocalModel& model) const noexcept;

  /// Returns the number of models published. Real-time: safe.
  std::uint64_t count() const noexcept { return snapshot_.count(); }

 private:
  /// Model as plain numbers for the Snapshot.
  struct Words {
    double p[3], f[3], stiffness[9], damping, n[3];
    std::int64_t time_ns;
  };

  driver::Snapshot<Words> snapshot_;
};

}  // namespace thimble::render
