#pragma once

#include <string>
#include <vector>

#include "dds/dds.h"
#include "ros2/ros_peer.h"
#include "ros_messages.h"
#include "scene_poses.h"

namespace thimble::ros2 {

/// Publishes the objects of a scene as markers, once and for all later readers, each in a frame
/// that moves with it. Not thread-safe.
class SceneWriter {
 public:
  /// Makes the writer and publishes the objects. The options and the scene must outlive it.
  SceneWriter(dds_entity_t participant, const RosOptions& options, const RosScene& scene);
  /// Returns the first error of DDS; 0: none.
  dds_return_t error() const noexcept { return error_; }

  /// Returns the frames of the moving objects, for /tf; they refer to this object and to `header`.
  std::vector<geometry_msgs_msg_dds__TransformStamped_> frames(
      const session::ScenePoses& poses, const std_msgs_msg_dds__Header_& header) const;

 private:
  void publish_objects(dds_entity_t writer);

  const RosOptions& options_;
  const RosScene& scene_;
  std::vector<std::string> frames_;  // of each object; the world's frame if it does not move
  dds_return_t error_ = 0;
};

}  // namespace thimble::ros2
