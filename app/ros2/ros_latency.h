#pragma once

#include <filesystem>
#include <string>

#include "ros2/ros_peer.h"
#include "thimble/driver/result.h"
#include "thimble/session/histogram.h"

namespace thimble::ros2 {

/// Measures how old the positions are that forces answer when another program computes them: runs a
/// scene on its simulated arm for `duration` s of the world's time, under topics of its own, with
/// an answering program (EchoPeer) at the other end. A position's age goes from the tick that read
/// it to the tick that sends the force which answers it. Nothing is felt: the forces are zero. The
/// error says what to do. Real-time: never from the servo thread.
driver::Result<session::Histogram> measure_ros_latency(const std::string& scene,
                                                       const std::string& arm_file,
                                                       std::uint32_t domain, double duration);

}  // namespace thimble::ros2
