#pragma once

#include <vector>

#include "thimble/driver/force_law.h"
#include "thimble/render/scene_touch.h"

namespace thimble::studies {

/// Force law of objects each of which is felt alone, with a separate proxy: the forces are added,
/// and the touch is that of the deepest contact. For comparison with one proxy for all objects.
struct AddedForces {
  std::vector<render::SceneTouch> objects;  ///< One scene per object.

  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand sum;
    for (render::SceneTouch& object : objects) {
      const driver::ForceCommand one = object(state);
      sum.f_T_W += one.f_T_W;
      if (one.touch.in_contact && one.touch.depth > sum.touch.depth) sum.touch = one.touch;
    }
    return sum;
  }
};

}  // namespace thimble::studies
