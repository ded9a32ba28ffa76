#pragma once

#include <string>
#include <vector>

#include "thimble/scene/arm_file.h"

namespace thimble::twin {

/// Returns how an arm file differs, in what a comparison of motions cannot show, from the one that
/// a recording was made with, a sentence each: counts, ratios, signs, home position, base. A
/// recording holds joint angles, which are right or wrong together with these. Real-time: never
/// from the servo thread.
std::vector<std::string> unseen_differences(const scene::ArmFile& recorded,
                                            const scene::ArmFile& file);

/// Returns what no comparison of motions tests, and what does, a sentence each.
std::vector<std::string> never_seen();

}  // namespace thimble::twin
