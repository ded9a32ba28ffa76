#pragma once

#include <string>
#include <vector>

#include "bringup/identify/identify.h"

namespace thimble::bringup {

/// Returns what was not seen of an arm, or not told from something else, and why, a sentence or two
/// each: with the size above which it would have been seen, where there is one. Real-time: never
/// from the servo thread.
std::vector<std::string> not_identified(const Identified& identified);

}  // namespace thimble::bringup
