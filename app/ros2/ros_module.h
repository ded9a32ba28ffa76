#pragma once

#include <memory>

#include "ros2/ros_peer.h"
#include "thimble/driver/result.h"

namespace thimble::ros2 {

/// Fails if the module is not there, cannot be loaded, or is of another version; the error says
/// what to install. Real-time: never from the servo thread.
driver::Result<void> check_ros_module();

/// Puts a run onto the wire by the module of the package thimble-ros2, which is loaded now: no
/// other part of Thimble needs a library of DDS. `channel` must outlive the peer. The error says
/// what to install. Real-time: never from the servo thread.
driver::Result<std::unique_ptr<RosPeer>> open_ros_peer(const RosOptions& options,
                                                       const RosScene& scene, RosChannel& channel);

/// Begins to answer the poses of a run with forces of nothing, stamped as they were, as another
/// program would (EchoPeer). As above.
driver::Result<std::unique_ptr<RosPeer>> open_ros_echo(const RosOptions& options);

/// The name by which the module is found, and what it is: it writes an error of at most `size`
/// bytes and returns null, or a peer. Versions must be the same, for both sides know RosChannel.
constexpr const char* kRosModuleVersion = "thimble_ros2_version";
constexpr const char* kRosModuleOpen = "thimble_ros2_open";
constexpr const char* kRosModuleEcho = "thimble_ros2_echo";
using RosModuleOpen = RosPeer* (*)(const RosOptions&, const RosScene&, RosChannel&, char* error,
                                   std::size_t size);
using RosModuleEcho = RosPeer* (*)(const RosOptions&, char* error, std::size_t size);

}  // namespace thimble::ros2
