#pragma once

#include <string>

#include "dds/dds.h"
#include "ros2/ros_peer.h"

namespace thimble::ros2 {

/// What readers receive that connect after a message.
enum class LateReaders { kHearNothing, kHearTheLast };

/// Returns the DDS name of an arm's topic: "rt", the namespaces of run and arm, and the name.
std::string dds_topic_name(const RosOptions& options, const std::string& name);
/// Returns the DDS name of a topic shared by all arms: "rt", the run's namespace and the name.
std::string dds_run_topic_name(const RosOptions& options, const std::string& name);

/// Makes the writer of a topic by its DDS name: reliable, like drivers of ROS 2, and with the hash
/// of its type for readers that check it. Returns an error of DDS below 0.
dds_entity_t make_writer(dds_entity_t participant, const dds_topic_descriptor_t& type,
                         const std::string& topic, LateReaders late = LateReaders::kHearNothing);

/// Makes the reader of a topic that keeps the newest `depth` messages. It accepts reliable and
/// best-effort writers. Returns an error of DDS below 0.
dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                         const std::string& topic, int depth);

/// Makes a reader that loses no message, for reliable writers only. As above.
dds_entity_t make_reliable_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                  const std::string& topic, int depth);

}  // namespace thimble::ros2
