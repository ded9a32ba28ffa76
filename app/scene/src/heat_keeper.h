#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "thimble/driver/device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/heat_guard.h"

namespace thimble::scene {

// Motor heat is stored between runs under $XDG_STATE_HOME/thimble/heat (or
// ~/.local/state/thimble/heat), one file per arm, with the wall-clock time. Real-time: none of
// these functions may be called from the servo thread.

/// Returns the path of the stored heat of an arm.
std::filesystem::path heat_file(const std::string& name);

/// Heat of an arm's motors at the start of a run.
struct KnownHeat {
  /// Heat of each motor. 0: ambient temperature, 1: limit of the winding.
  std::array<double, 3> heat{};
  std::string note;  ///< Warning to the user; empty: none.
};

/// Returns the heat of an arm's motors at `now` (s since 1970), reduced by cooling since it was
/// stored. If the clock went back, there is no cooling. Without a file the motors are cold. If the
/// file is invalid, or a run did not end properly, they are at the limit.
THIMBLE_EXPORT KnownHeat load_heat(const std::string& name, const driver::HeatSettings& settings,
                                   double now);

/// Saves the heat of an arm's motors at `now` (s since 1970) atomically. `running`: a run has
/// started and not ended. Returns whether it was saved.
bool save_heat(const std::string& name, const std::array<double, 3>& heat, double now,
               bool running);

/// Returns the wall-clock time, s since 1970.
THIMBLE_EXPORT double world_time();

/// Saves an arm's heat during one run: marks the run at its start and saves the heat at its end.
class THIMBLE_EXPORT HeatKeeper {
 public:
  /// Constructs it for an arm by name, and its device, which must outlive it.
  HeatKeeper(std::string name, const driver::Device& device);
  HeatKeeper(const HeatKeeper&) = delete;
  HeatKeeper& operator=(const HeatKeeper&) = delete;
  ~HeatKeeper();

 private:
  std::string name_;
  const driver::Device& device_;
};

}  // namespace thimble::scene
