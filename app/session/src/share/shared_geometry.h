#pragma once

#include <optional>

#include "share/shared_layout.h"
#include "thimble/driver/arm_model.h"

namespace thimble::session {

/// Writes the geometry of an arm into shared memory: one plus its index in driver::ArmGeometry, and
/// its lengths and angles in the order of its fields. 0 means none: only the tip is drawn.
/// Real-time: never from the servo thread.
void put_geometry(const std::optional<driver::ArmGeometry>& geometry, SharedArm& to);

/// Reads the geometry of an arm; returns false if it is damaged. Real-time: never from the servo
/// thread.
bool take_geometry(const SharedArm& shared, std::optional<driver::ArmGeometry>& geometry);

}  // namespace thimble::session
