#pragma once

#include <Eigen/Core>
#include <vector>

#include "share/shared_scene.h"
#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// One piece of an arm as it is drawn: points joined by straight bars (W, m).
using ArmLine = std::vector<Eigen::Vector3d>;

/// Finds the bars of an arm in the pose of a tick; the last point of the first line is the tip. An
/// arm of unknown build is its tip alone. Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<ArmLine> arm_lines(const SharedScene::Arm& arm,
                                              const driver::TickRecord& tick);

}  // namespace thimble::session
