#pragma once

#include <string>

#include "compat/core/arm_data.h"
#include "thimble/driver/arm_link.h"
#include "thimble/scene/arm_file.h"

namespace thimble::compat {

/// Returns what a program is told of an arm: what its file says, and what it tells of itself; of an
/// arm that is not open, nothing is known of the latter. Real-time: never from the servo thread.
ArmFacts facts_of(const scene::ArmFile& arm, const driver::ArmTraits& traits = {});

/// Says that an arm is real, and what it is known by. Real-time: never from the servo thread.
void name_real(ArmFacts& facts, const std::string& name);

}  // namespace thimble::compat
