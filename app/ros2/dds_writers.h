#pragma once

#include <cstdint>
#include <vector>

#include "dds/dds.h"
#include "ros2/arm_health.h"
#include "ros2/ros_peer.h"
#include "ros2/scene_writer.h"
#include "ros_messages.h"

namespace thimble::ros2 {

/// The writers of a run's topics. Not thread-safe.
class DdsWriters {
 public:
  /// Makes a writer for each topic. The participant owns the writers and destroys them. The options
  /// and the scene must outlive this.
  DdsWriters(dds_entity_t participant, const RosOptions& options, const RosScene& scene);
  /// Returns the first error of DDS; 0: none.
  dds_return_t error() const noexcept { return error_; }

  /// Publishes one tick with its time, ns: since 1970, or that of a stepped run.
  void publish(const driver::TickRecord& record, const session::ScenePoses& poses,
               std::int64_t time_ns);
  /// Reports the end of a step; `ticks` is the total number of ticks.
  void publish_step_end(std::uint64_t ticks);

 private:
  static constexpr std::int64_t kLongAgo_ns = 1'000'000'000'000;

  dds_entity_t kept(dds_entity_t made);
  void describe_robot(dds_entity_t participant);
  void publish_joints(const driver::TickRecord& record);
  void publish_tip(const driver::TickRecord& record);
  void publish_frames(const driver::TickRecord& record, const session::ScenePoses& poses);
  void publish_buttons(const driver::TickRecord& record);
  void publish_button_event(const driver::TickRecord& record);
  void publish_state(const driver::TickRecord& record);
  void publish_health(const driver::TickRecord& record, std::int64_t time_ns);
  geometry_msgs_msg_dds__Quaternion_ rotation_of_tip(const driver::TickRecord& record) const;
  std_msgs_msg_dds__Header_ header(const std::string& frame) const;

  const RosOptions& options_;
  const RosScene& scene_;
  dds_return_t error_ = 0;
  builtin_interfaces_msg_dds__Time_ stamp_{};
  dds_entity_t joints_, pose_, twist_, wrench_, buttons_, tf_, health_;
  dds_entity_t state_ = 0, clock_ = 0, stepped_ = 0;  // 0: no such topic
  SceneWriter objects_;
  ArmHealth published_health_;  // last published health of the arm, and its time, ns
  std::int64_t health_time_ns_ = -kLongAgo_ns;
  std::uint16_t published_buttons_ = 0;
  std::vector<char*> joint_names_;
};

}  // namespace thimble::ros2
