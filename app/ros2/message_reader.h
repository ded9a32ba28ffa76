#pragma once

#include <cstdint>
#include <string>

#include "dds/dds.h"
#include "ros2/message_check.h"
#include "ros2/ros_peer.h"
#include "ros_messages.h"

namespace thimble::ros2 {

/// Takes the messages for a run, checks them, and passes on the newest valid one of each kind. In a
/// stepped run, a message counts in a step if its writer knows that it arrived before the step was
/// requested. Not thread-safe.
class MessageReader {
 public:
  /// Makes a reader for each requested topic. The options and the channel must outlive it; the
  /// participant owns and destroys the readers.
  MessageReader(dds_entity_t participant, const RosOptions& options, RosChannel& channel);
  /// Returns the first error of DDS; 0: none.
  dds_return_t error() const noexcept { return error_; }
  /// Attaches the readers to a waitset, which wakes when a message arrives. Returns an error of
  /// DDS, or 0.
  dds_return_t attach(dds_entity_t waitset) const;

  /// Takes all messages that have arrived. `world_minus_run_ns`: difference between the stamps'
  /// clock and the run's.
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
  dds_entity_t forces_ = 0, places_ = 0, steps_ = 0;  // 0: no such reader
  std::int64_t world_minus_run_ns_ = 0;
  std::uint64_t step_asked_ = 0;
  RosWrench wrench_;
  RosHandTarget place_;
};

}  // namespace thimble::ros2
