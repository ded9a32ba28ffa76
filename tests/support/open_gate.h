#pragma once

#include "support/vintage_arm.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::support {

/// Returns a gate after its soft start, whose last force was zero.
inline driver::SafetyGate open_gate(const driver::GateLimits& limits = vintage_settings().limits,
                                    const driver::EnergyGuardSettings& energy = {}) noexcept {
  driver::SafetyGate gate(limits, energy);
  constexpr double kTick = 0.01;  // s; below the threshold of a stall
  for (double t = 0; t <= limits.soft_start + kTick; t += kTick) {
    if (energy.stage == driver::EnergyStage::kNone) {
      gate.pass({0, 0, 0}, {0, 0, 0}, kTick);
    } else {
      gate.pass_guarded({0, 0, 0}, {0, 0, 0}, kTick, {});
    }
  }
  return gate;
}

}  // namespace thimble::support
