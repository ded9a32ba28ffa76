#pragma once

#include <atomic>
#include <thread>

#include "dds/dds.h"
#include "ros2/dds_domain.h"
#include "ros2/ros_peer.h"

namespace thimble::ros2 {

/// A program at the other end of a run's topics, as a participant of its own: it answers each pose
/// with no force at all, stamped as the pose was, so that the run can tell how old the positions
/// are that forces answer.
class EchoPeer final : public RosPeer {
 public:
  /// Takes the options of the run that it answers.
  explicit EchoPeer(const RosOptions& options) : options_(options) {}
  ~EchoPeer() override;

  /// Begins to answer. Returns an error of DDS, or 0.
  dds_return_t begin();

 private:
  void serve();

  const RosOptions options_;
  DdsDomain domain_;  // outlives what is in it
  dds_entity_t participant_ = 0, waitset_ = 0, poses_ = 0, forces_ = 0;
  std::atomic<bool> leave_{false};
  std::thread thread_;
};

}  // namespace thimble::ros2
