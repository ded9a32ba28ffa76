#pragma once

#include <optional>

#include "share/shared_layout.h"
#include "thimble/driver/arm_model.h"

namespace thimble::session {

/// Writes how an arm is built into shared memory: one more than the place of the build in
/// driver::ArmGeometry, and its lengths and angles in the order of its fields. None is 0: only the
/// tip is drawn. Real-time: never from the servo thread.
void put_geometry(const std::optional<driver::ArmGeometry>& geometry, SharedArm& to);

/// Reads how an arm is built; false if that is damaged. Real-time: never from the servo thread.
bool take_geometry(const SharedArm& shared, std::optional<driver::ArmGeometry>& geometry);

}  // namespace thimble::session
