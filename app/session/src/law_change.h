#pragma once

#include <cstdint>

#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// What was done to the scene's force law in a tick, from outside of the scene.
struct LawChange {
  std::int16_t setting = driver::TickRecord::kNoSetting;  ///< As TickRecord::setting.
  double value = 0;                                       ///< What it was asked to become.
  double gain = 1;                                        ///< Share of the force that is felt.

  /// Returns whether anything was done.
  bool any() const noexcept { return setting != driver::TickRecord::kNoSetting || gain < 1; }
};

}  // namespace thimble::session
