#pragma once

#include <algorithm>

#include "thimble/driver/energy_guard.h"

namespace thimble::studies {

/// Maximum energy from the motors in any window of a run, beyond the energy of the compressed
/// springs at its beginning.
///
/// Energy that damping and friction absorbed before is no credit: a wall that oscillates for a
/// minute after an hour of rubbing adds energy. Only the energy of compressed springs may return.
class EnergyGiven {
 public:
  /// Adds the work done on the tip since the last tick (J), with the present energy of the springs
  /// (J).
  void book(double work, double held) noexcept {
    credit_ = std::min(credit_ - work, held);
    max_ = std::max(max_, -credit_);
  }
  /// Returns the maximum, J; 0 for a passive scene.
  double max() const noexcept { return max_; }

 private:
  double credit_ = 0;  // J; below 0: energy was added
  double max_ = 0;     // J, maximum so far
};

/// Energy (J) that a gate without an energy stage may release in any window: the bound of hard case
/// 11 for a guarded wall.
inline constexpr double kLetGoWithoutStage = 2e-3;

/// Returns the maximum energy (J) that motors behind a gate with this energy stage may add in any
/// window. The stage's account starts no higher than its reservoir plus the energy of springs. It
/// damps below -allowance, and at -(allowance + 2 onset) no force is left that could add more.
inline double energy_let_go(const driver::EnergyGuardSettings& stage) {
  if (stage.stage != driver::EnergyStage::kPassivity) return kLetGoWithoutStage;
  return stage.reservoir + stage.allowance + 2 * stage.onset;
}

}  // namespace thimble::studies
