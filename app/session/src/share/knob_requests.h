#pragma once

#include <cstddef>
#include <optional>

namespace thimble::session {

/// Source of requested knob values, which receives the current ones; called on the servo's thread.
class KnobRequests {
 public:
  virtual ~KnobRequests() = default;

  /// Returns the requested value of a knob, within its bounds; empty if there is none or it is
  /// invalid. Real-time: must be safe.
  virtual std::optional<double> knob_wanted(std::size_t knob) const noexcept = 0;
  /// Receives the current value of a knob. Real-time: must be safe.
  virtual void store_knob(std::size_t knob, double now) noexcept = 0;
};

}  // namespace thimble::session
