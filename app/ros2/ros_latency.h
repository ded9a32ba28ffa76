#pragma once

#include <filesystem>
#include <string>

#include "ros2/ros_peer.h"
#include "thimble/driver/result.h"
#include "thimble/session/histogram.h"

namespace thimble::ros2 {

/// Measures the age of positions when another program computes the forces. Runs a scene on its
/// simulated arm for `duration` s of wall-clock time, under separate topics, with an answering
/// program (EchoPeer) at the other end. The age is the time from the tick that reads a position to
/// the tick that sends the force computed from it. The forces are zero. The error message has the
/// remedy. Real-time: never from the servo thread.
driver::Result<session::Histogram> measure_ros_latency(const std::string& scene,
                                                       const std::string& arm_file,
                                                       std::uint32_t domain, double duration);

}  // namespace thimble::ros2
