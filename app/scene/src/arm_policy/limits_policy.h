#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/energy_guard.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

// The limits of a real arm stand in its installed arm file. Whatever else speaks of limits may only
// tighten them. Real-time: never from the servo thread.

/// Tightens the gate of `arm` to whatever `other` has tighter, value by value: less force, speed,
/// rise, stall, watchdog and energy allowance, more soft start and reopen, an energy stage that is
/// not weaker (none, passivity, bounding, in this order). Looser values are ignored. Keys that
/// `other` does not name say nothing. Returns one sentence for each value that differs, with file
/// and line: kept or ignored. `arm_path` and `other_path` are the files they stand in.
std::vector<std::string> tighten(ArmFile& arm, const std::filesystem::path& arm_path,
                                 const ArmFile& other, const std::filesystem::path& other_path);

/// Chooses between the energy stage of `arm` and the one that a scene wants in its place, in line
/// `line` of `scene_file`: the stronger one stays. Returns a sentence if they differ.
std::optional<std::string> tighten_energy(ArmFile& arm, const std::filesystem::path& arm_path,
                                          driver::EnergyStage wanted,
                                          const std::filesystem::path& scene_file, int line);

/// Returns which section says what the arm is made of and differs between two arm files ("joints",
/// say); nullptr if they agree. Limits, names and how the arm is simulated may differ.
const char* differing_section(const ArmFile& one, const ArmFile& other);

}  // namespace thimble::scene
