#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/energy_guard.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

// The installed arm file defines the limits of a real arm. Other sources can only tighten them.
// Real-time: none of these functions may be called from the servo thread.

/// Tightens each value of the gate of `arm` to that of `other` if it is stricter. Stricter means
/// less force, speed, rise, stall, watchdog and energy allowance, more soft start and reopen, and
/// an energy stage that is not weaker (none, passivity, bounding, in this order). Looser values,
/// and keys that `other` does not contain, are ignored. Returns one sentence per differing value,
/// with file and line: kept or ignored. `arm_path` and `other_path`: the files of both.
std::vector<std::string> tighten(ArmFile& arm, const std::filesystem::path& arm_path,
                                 const ArmFile& other, const std::filesystem::path& other_path);

/// Chooses the stronger of the energy stage of `arm` and the one requested by a scene in line
/// `line` of `scene_file`. Returns a sentence if they differ.
std::optional<std::string> tighten_energy(ArmFile& arm, const std::filesystem::path& arm_path,
                                          driver::EnergyStage wanted,
                                          const std::filesystem::path& scene_file, int line);

/// Returns the first section about the construction of the arm that differs between two arm files
/// ("joints", say); nullptr if there is none. Limits, names and the simulation may differ.
const char* differing_section(const ArmFile& one, const ArmFile& other);

}  // namespace thimble::scene
