#pragma once

#include <cstdint>

#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// Changes of the scene's force law in one tick by viewers or programs.
struct LawChange {
  /// Changed setting, as TickRecord::setting.
  std::int16_t setting = driver::TickRecord::kNoSetting;
  double value = 0;  ///< Requested value of the setting.
  /// Fraction of the force that is applied.
  double gain = 1;

  /// Returns whether there is a change.
  bool any() const noexcept { return setting != driver::TickRecord::kNoSetting || gain < 1; }
};

}  // namespace thimble::session
