#pragma once

#include <Eigen/Core>
#include <vector>

#include "share/shared_scene.h"
#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// Polyline of an arm for drawing (W, m).
using ArmLine = std::vector<Eigen::Vector3d>;

/// Returns the polylines of an arm in the pose of a tick; the last point of the first line is the
/// tip. For an arm of unknown geometry only the tip is returned. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT std::vector<ArmLine> arm_lines(const SharedScene::Arm& arm,
                                              const driver::TickRecord& tick);

}  // namespace thimble::session
