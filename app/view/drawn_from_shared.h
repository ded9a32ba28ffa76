#pragma once

#include <vector>

#include "share/shared_scene.h"
#include "thimble/driver/tick_record.h"
#include "view/drawn_scene.h"

namespace thimble::view {

/// Returns the constant part of a shared scene for drawing. Real-time: never from the servo thread,
/// as below.
DrawnScene drawn_scene_of(const session::SharedScene& scene);

/// Returns the rods of an arm in the pose of a tick, from its base to its tip.
std::vector<DrawnRod> rods_of(const session::SharedScene::Arm& arm, const driver::TickRecord& tick);

}  // namespace thimble::view
