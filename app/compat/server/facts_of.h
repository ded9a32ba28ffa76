#pragma once

#include <cstddef>
#include <string>

#include "compat/core/arm_data.h"
#include "thimble/driver/arm_link.h"
#include "thimble/scene/arm_file.h"

namespace thimble::compat {

/// Returns the properties of an arm: those of its file, and those that the arm itself reports. The
/// latter are unknown for an arm that is not open. Real-time: never from the servo thread.
ArmFacts facts_of(const scene::ArmFile& arm, const driver::ArmTraits& traits = {});

/// Gives a simulated arm its serial number, from its index. Real-time: never from the servo thread.
void number_simulated(ArmFacts& facts, std::size_t index);

/// Marks an arm as real, and sets its name. Real-time: never from the servo thread.
void name_real(ArmFacts& facts, const std::string& name);

}  // namespace thimble::compat
