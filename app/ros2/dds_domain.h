#pragma once

#include "dds/dds.h"
#include "ros2/ros_peer.h"

namespace thimble::ros2 {

/// A peer's use of a DDS domain. What stays on this computer is bound to it twice: Cyclone DDS is
/// configured to use the loopback interface only, and its sockets, which it opens on all interfaces
/// all the same, drop whatever was not sent from 127.0.0.0/8. Peers of one process share a domain,
/// which is closed with the last of them. Real-time: never from the servo thread, all of it.
class DdsDomain {
 public:
  DdsDomain() = default;
  ~DdsDomain();
  DdsDomain(const DdsDomain&) = delete;
  DdsDomain& operator=(const DdsDomain&) = delete;

  /// Opens the domain as the options ask. Returns an error of DDS, or 0. With RosReach::kNetwork
  /// Cyclone's own configuration counts (CYCLONEDDS_URI); otherwise that is ignored.
  dds_return_t open(const RosOptions& options);

 private:
  bool open_ = false;
  std::uint32_t number_ = 0;
};

}  // namespace thimble::ros2
