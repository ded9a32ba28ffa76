#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "thimble/driver/device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/heat_guard.h"

namespace thimble::scene {

// The heat of an arm's motors outlasts a run: it is kept under $XDG_STATE_HOME/thimble/heat (or
// ~/.local/state/thimble/heat), one file for each arm, with the time of the world.
// Real-time: never from the servo thread.

/// Returns the file that keeps the heat of an arm of this name.
std::filesystem::path heat_file(const std::string& name);

/// The heat of an arm's motors at the start of a run.
struct KnownHeat {
  std::array<double, 3> heat{};  ///< 0: as cold as the room, 1: the winding's limit
  std::string note;              ///< What the user should know of it; empty: nothing.
};

/// Returns the heat of an arm's motors at `now` (s since 1970), cooled by the time since it was
/// kept; a clock that went back counts as no time. No file: cold. A file that cannot be understood,
/// and a run that did not end properly: at the limit.
THIMBLE_EXPORT KnownHeat load_heat(const std::string& name, const driver::HeatSettings& settings,
                                   double now);

/// Keeps the heat of an arm's motors at `now` (s since 1970). `running` says that a run has begun
/// and has not ended. The file is written whole or not at all. Returns whether it was written.
bool save_heat(const std::string& name, const std::array<double, 3>& heat, double now,
               bool running);

/// Returns the time of the world, s since 1970.
THIMBLE_EXPORT double world_time();

/// A keeper of an arm's heat for one run: it marks the run when it begins and keeps the heat when
/// it ends.
class THIMBLE_EXPORT HeatKeeper {
 public:
  /// Takes an arm by name, and the device that must outlive it.
  HeatKeeper(std::string name, const driver::Device& device);
  HeatKeeper(const HeatKeeper&) = delete;
  HeatKeeper& operator=(const HeatKeeper&) = delete;
  ~HeatKeeper();

 private:
  std::string name_;
  const driver::Device& device_;
};

}  // namespace thimble::scene
