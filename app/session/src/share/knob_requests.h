#pragma once

#include <cstddef>
#include <optional>

namespace thimble::session {

/// Who wants knobs turned, and is told how far they are; asked by the servo's thread.
class KnobRequests {
 public:
  virtual ~KnobRequests() = default;

  /// Returns what a knob shall be: within its bounds, or empty if nobody wants anything of it, or
  /// nonsense. Real-time: must be safe.
  virtual std::optional<double> knob_wanted(std::size_t knob) const noexcept = 0;
  /// Takes what a knob is now. Real-time: must be safe.
  virtual void store_knob(std::size_t knob, double now) noexcept = 0;
};

}  // namespace thimble::session
