#pragma once

#include "support/random.h"
#include "view/camera.h"

namespace thimble::view {

/// Returns a camera with a random direction, and a target and a distance up to bounds, m.
inline Camera any_camera(support::Random& random, double target, double distance) {
  Camera camera;
  camera.p_WTarget = random.in_box(target);
  camera.yaw = random.uniform(-3, 3);
  camera.pitch = random.uniform(-1.4, 1.4);
  camera.distance = random.uniform(0.05, distance);
  return camera;
}

}  // namespace thimble::view
