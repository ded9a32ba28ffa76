#pragma once

#include <cstdint>
#include <string>

#include "dds/dds.h"
#include "ros2/message_check.h"
#include "ros2/ros_peer.h"
#include "ros_messages.h"

namespace thimble::ros2 {

/// Takes the messages that come for a run, judges them, and hands the newest good one of each kind
/// on. In a run that is stepped, what its writer knows to have arrived before it asks for a step
/// counts in that step. Not thread-safe.
class MessageTaker {
 public:
  /// Makes a reader for each topic that the options ask for. The options and the channel must
  /// outlive it; the participant takes the readers with it.
  MessageTaker(dds_entity_t participant, const RosOptions& options, RosChannel& channel);
  /// Returns the first error of DDS; 0: none.
  dds_return_t error() const noexcept { return error_; }
  /// Wakes a set of waiters when a message has come. Returns an error of DDS, or 0.
  dds_return_t attach(dds_entity_t waitset) const;

  /// Takes all that has come. `world_minus_run_ns`: from the run's clock to that of the stamps.
  void take(std::int64_t world_minus_run_ns);

 private:
  dds_entity_t kept(dds_entity_t made);
  bool judge(const geometry_msgs_msg_dds__WrenchStamped_& message);
  bool judge(const omni_msgs_msg_dds__OmniFeedback_& message);
  bool judge(const geometry_msgs_msg_dds__PoseStamped_& message);
  bool judge(const std_msgs_msg_dds__UInt64_& message);
  bool good(MessageVerdict verdict);
  void keep_force(const std::array<double, 3>& f);
  template <class Message>
  bool take_all(dds_entity_t reader);

  const RosOptions& options_;
  RosChannel& channel_;
  dds_return_t error_ = 0;
  dds_entity_t forces_ = 0, places_ = 0, steps_ = 0;  // 0: nobody listens
  std::int64_t world_minus_run_ns_ = 0;
  std::uint64_t step_asked_ = 0;
  RosWrench wrench_;
  RosHandPlace place_;
};

}  // namespace thimble::ros2
