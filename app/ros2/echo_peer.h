#pragma once

#include <atomic>
#include <thread>

#include "dds/dds.h"
#include "ros2/dds_domain.h"
#include "ros2/ros_peer.h"

namespace thimble::ros2 {

/// A program at the other end of a run's topics, as a separate participant. It answers each pose
/// with a zero force that has the pose's stamp. With it, the run measures the age of the positions
/// that forces answer.
class EchoPeer final : public RosPeer {
 public:
  /// Takes the options of the run to answer.
  explicit EchoPeer(const RosOptions& options) : options_(options) {}
  ~EchoPeer() override;

  /// Starts to answer. Returns an error of DDS, or 0.
  dds_return_t begin();

 private:
  void serve();

  const RosOptions options_;
  DdsDomain domain_;  // must outlive its entities
  dds_entity_t participant_ = 0, waitset_ = 0, poses_ = 0, forces_ = 0;
  std::atomic<bool> leave_{false};
  std::thread thread_;
};

}  // namespace thimble::ros2
