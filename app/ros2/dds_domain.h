#pragma once

#include "dds/dds.h"
#include "ros2/ros_peer.h"

namespace thimble::ros2 {

/// A peer's use of a DDS domain. Local-only traffic is enforced twice: Cyclone DDS is configured to
/// use only the loopback interface, and its sockets, which it opens on all interfaces nevertheless,
/// drop all packets not sent from 127.0.0.0/8. Peers of one process share a domain, which is closed
/// with the last of them. Real-time: no function may be called from the servo thread.
class DdsDomain {
 public:
  DdsDomain() = default;
  ~DdsDomain();
  DdsDomain(const DdsDomain&) = delete;
  DdsDomain& operator=(const DdsDomain&) = delete;

  /// Opens the domain according to the options. Returns an error of DDS, or 0. With
  /// RosReach::kNetwork Cyclone's own configuration applies (CYCLONEDDS_URI); otherwise it is
  /// ignored.
  dds_return_t open(const RosOptions& options);

 private:
  bool open_ = false;
  std::uint32_t number_ = 0;
};

}  // namespace thimble::ros2
