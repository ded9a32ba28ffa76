#pragma once

#include <string>
#include <vector>

#include "thimble/scene/arm_file.h"

namespace thimble::twin {

/// Lists the differences between an arm file and the file of a recording that a comparison of
/// motions cannot show, a sentence each. They are counts, ratios, signs, home position and base. A
/// recording holds joint angles, which are correct or wrong together with these. Real-time: never
/// from the servo thread.
std::vector<std::string> unseen_differences(const scene::ArmFile& recorded,
                                            const scene::ArmFile& file);

/// Lists the properties that no comparison of motions tests, and the tests for them, a sentence
/// each.
std::vector<std::string> never_seen();

}  // namespace thimble::twin
