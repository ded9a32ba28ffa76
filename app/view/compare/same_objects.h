#pragma once

#include "view/drawn_scene.h"

namespace thimble::view {

/// Returns whether two scenes show the same objects, so that the arms of both can be drawn in one
/// picture: as many objects, with the same names and the same meshes before the first tick. Their
/// stiffness, friction and other values may differ. Real-time: never from the servo thread.
bool have_same_objects(const DrawnScene& a, const DrawnScene& b);

}  // namespace thimble::view
