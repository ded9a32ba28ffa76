#pragma once

#include <string>

#include "dds/dds.h"
#include "ros2/ros_peer.h"

namespace thimble::ros2 {

/// What becomes of readers that come after a message.
enum class LateReaders { kHearNothing, kHearTheLast };

/// Returns the name of an arm's topic in DDS: "rt", the namespaces of run and arm, and the name.
std::string dds_topic_name(const RosOptions& options, const std::string& name);
/// Returns the name of a topic in DDS that is of all arms: "rt", the run's namespace and the name.
std::string dds_run_topic_name(const RosOptions& options, const std::string& name);

/// Makes the writer of a topic by its name in DDS: reliable, as drivers of ROS 2 do it, and with
/// the hash of its type for those that compare it. Returns an error of DDS below 0.
dds_entity_t make_writer(dds_entity_t participant, const dds_topic_descriptor_t& type,
                         const std::string& topic, LateReaders late = LateReaders::kHearNothing);

/// Makes the reader of a topic that keeps the newest `depth` messages. It takes what writers of
/// both kinds send, reliable and best effort. Returns an error of DDS below 0.
dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                         const std::string& topic, int depth);

/// Makes a reader that loses nothing, of reliable writers only. As above.
dds_entity_t make_reliable_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                  const std::string& topic, int depth);

}  // namespace thimble::ros2
