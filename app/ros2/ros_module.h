#pragma once

#include <memory>

#include "ros2/ros_peer.h"
#include "thimble/driver/result.h"

namespace thimble::ros2 {

/// Returns an error if the module is missing, cannot be loaded, or has another version. It names
/// the package to install. Real-time: never from the servo thread.
driver::Result<void> check_ros_module();

/// Publishes a run with the module of the package thimble-ros2. The module is loaded now, so that
/// no other part of Thimble needs a DDS library. `channel` must outlive the peer. The error names
/// the package to install. Real-time: never from the servo thread.
driver::Result<std::unique_ptr<RosPeer>> open_ros_peer(const RosOptions& options,
                                                       const RosScene& scene, RosChannel& channel);

/// Starts a peer that answers the poses of a run with zero forces, with the stamps of the poses,
/// like another program (EchoPeer). Otherwise as above.
driver::Result<std::unique_ptr<RosPeer>> open_ros_echo(const RosOptions& options);

/// Symbols of the module. Its functions return a peer, or write an error of at most `size` bytes
/// and return null. Versions must be equal, because both sides use RosChannel.
constexpr const char* kRosModuleVersion = "thimble_ros2_version";
constexpr const char* kRosModuleOpen = "thimble_ros2_open";
constexpr const char* kRosModuleEcho = "thimble_ros2_echo";
using RosModuleOpen = RosPeer* (*)(const RosOptions&, const RosScene&, RosChannel&, char* error,
                                   std::size_t size);
using RosModuleEcho = RosPeer* (*)(const RosOptions&, char* error, std::size_t size);

}  // namespace thimble::ros2
