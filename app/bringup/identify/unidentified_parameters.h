#pragma once

#include <string>
#include <vector>

#include "bringup/identify/identify.h"

namespace thimble::bringup {

/// Returns the properties of an arm that were not seen, or not distinguished from others, and the
/// reasons, a sentence or two each. Includes the detection limit, if there is one. Real-time: never
/// from the servo thread.
std::vector<std::string> unidentified_parameters(const Identified& identified);

}  // namespace thimble::bringup
