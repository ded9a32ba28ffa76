#pragma once

#include <cstddef>
#include <string>

#include "ros2/ros_peer.h"
#include "thimble/session/session.h"

namespace thimble::ros2 {

/// Returns what the topics tell of one arm of a session and, with the first arm, of the objects;
/// those that are fields or on the disk have no mesh and are left out. Precondition: the arm is
/// open. Real-time: never from the servo thread.
RosScene ros_scene(const session::Session& session, const RosOptions& options, std::size_t arm);

}  // namespace thimble::ros2
