#include "ros2/dds_endpoints.h"

#include <memory>

#include "ros2/type_hashes.h"

namespace thimble::ros2 {
namespace {

/// Quality of service of an endpoint.
struct Quality {
  bool reliable = true;
  LateReaders late = LateReaders::kHearNothing;
  int depth = 10;  // number of messages kept
};

using Qos = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)>;

Qos make_qos(const dds_topic_descriptor_t& type, const Quality& quality) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  // The writer never waits: it drops old messages if readers are too slow.
  dds_qset_reliability(
      qos.get(), quality.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos.get(), quality.late == LateReaders::kHearTheLast
                                     ? DDS_DURABILITY_TRANSIENT_LOCAL
                                     : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
  // In the format of rmw_dds_common.
  if (const std::string_view hash = type_hash(type.m_typename); !hash.empty()) {
    const std::string data = "typehash=" + std::string(hash) + ";";
    dds_qset_userdata(qos.get(), data.data(), data.size());
  }
  return qos;
}

dds_entity_t make_any_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                             const std::string& topic, const Quality& quality) {
  const dds_entity_t made = dds_create_topic(participant, &type, topic.c_str(), nullptr, nullptr);
  if (made < 0) return made;
  return dds_create_reader(participant, made, make_qos(type, quality).get(), nullptr);
}

}  // namespace

std::string dds_topic_name(const RosOptions& options, const std::string& name) {
  return "rt" + options.name_space + options.arm_space + "/" + name;
}

std::string dds_run_topic_name(const RosOptions& options, const std::string& name) {
  return "rt" + options.name_space + "/" + name;
}

dds_entity_t make_writer(dds_entity_t participant, const dds_topic_descriptor_t& type,
                         const std::string& topic, LateReaders late) {
  const Qos qos = make_qos(
      type, {.reliable = true, .late = late, .depth = late == LateReaders::kHearTheLast ? 1 : 10});
  const dds_entity_t made = dds_create_topic(participant, &type, topic.c_str(), nullptr, nullptr);
  return made < 0 ? made : dds_create_writer(participant, made, qos.get(), nullptr);
}

dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                         const std::string& topic, int depth) {
  return make_any_reader(participant, type, topic, {.reliable = false, .depth = depth});
}

dds_entity_t make_reliable_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                  const std::string& topic, int depth) {
  return make_any_reader(participant, type, topic, {.depth = depth});
}

}  // namespace thimble::ros2
