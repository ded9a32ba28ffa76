#pragma once

#include <cstddef>
#include <string>

#include "ros2/ros_peer.h"
#include "thimble/session/session.h"

namespace thimble::ros2 {

/// Returns the constant data of one arm of a session for its topics; the first arm includes the
/// objects. Fields and meshes on disk are omitted, because they have no mesh in memory.
/// Precondition: the arm is open. Real-time: never from the servo thread.
RosScene ros_scene(const session::Session& session, const RosOptions& options, std::size_t arm);

}  // namespace thimble::ros2
