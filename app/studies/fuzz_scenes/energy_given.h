#pragma once

#include <algorithm>

#include "thimble/driver/energy_guard.h"

namespace thimble::studies {

/// Most energy that motors gave in any window of a run, beyond what the pressed springs held at its
/// beginning.
///
/// What damping and friction took before is no credit: a wall that oscillates for a minute after an
/// hour of rubbing gives energy. Only what the springs that are pressed hold may come back.
class EnergyGiven {
 public:
  /// Books the work done on the tip since the last tick (J), with what the springs hold now (J).
  void book(double work, double held) noexcept {
    credit_ = std::min(credit_ - work, held);
    most_ = std::max(most_, -credit_);
  }
  /// Returns the most, J; 0 of a passive scene.
  double most() const noexcept { return most_; }

 private:
  double credit_ = 0;  // J; below 0: given
  double most_ = 0;    // J
};

/// Energy (J) that a gate without an energy stage may let go in any window: what hard case 11
/// allows a guarded wall.
inline constexpr double kLetGoWithoutStage = 2e-3;

/// Returns the most energy (J) that motors behind a gate with this energy stage may give in any
/// window: the stage's account starts at its reservoir at most (and what springs hold), damps from
/// -allowance on, and at -(allowance + 2 onset) no force is left that could give more.
inline double energy_let_go(const driver::EnergyGuardSettings& stage) {
  if (stage.stage != driver::EnergyStage::kPassivity) return kLetGoWithoutStage;
  return stage.reservoir + stage.allowance + 2 * stage.onset;
}

}  // namespace thimble::studies
