#include "ros2/message_reader.h"

#include <algorithm>
#include <array>

#include "ros2/dds_endpoints.h"

namespace thimble::ros2 {
namespace {

constexpr int kTaken = 64;  // messages at a time

const char* text_of(const char* text) noexcept {
  return text != nullptr ? text : "";
}

}  // namespace

MessageReader::MessageReader(dds_entity_t participant, const RosOptions& options,
                             RosChannel& channel)
    : options_(options), channel_(channel) {
  const RosNames& names = ros_names(options.style);
  const bool omni = options.style == RosStyle::kOmni;
  // In real time an old force is useless; in a stepped run each message counts.
  const auto reader = [&](const dds_topic_descriptor_t& type, const char* name) {
    const std::string topic = dds_topic_name(options, name);
    return kept(options.stepped ? make_reliable_reader(participant, type, topic, kTaken)
                                : make_reader(participant, type, topic, kTaken));
  };
  if (options.force != RosForce::kNone) {
    forces_ = reader(
        omni ? omni_msgs_msg_dds__OmniFeedback__desc : geometry_msgs_msg_dds__WrenchStamped__desc,
        names.force_in);
  }
  if (options.lead_hand) {
    places_ = reader(geometry_msgs_msg_dds__PoseStamped__desc, names.hand_in);
  }
  if (options.stepped && options.moves_time) {
    steps_ = kept(make_reliable_reader(participant, std_msgs_msg_dds__UInt64__desc,
                                       dds_run_topic_name(options, "step"), kTaken));
  }
}

dds_entity_t MessageReader::kept(dds_entity_t made) {
  if (made < 0 && error_ == 0) error_ = made;
  return made;
}

dds_return_t MessageReader::attach(dds_entity_t waitset) const {
  for (const dds_entity_t reader : {forces_, places_, steps_}) {
    if (reader <= 0) continue;
    dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
    if (const dds_return_t attached = dds_waitset_attach(waitset, reader, 0); attached < 0) {
      return attached;
    }
  }
  return 0;
}

void MessageReader::take(std::int64_t world_minus_run_ns) {
  world_minus_run_ns_ = world_minus_run_ns;
  // Steps are taken first and permitted last, so that messages that arrived before them count.
  if (steps_ > 0) take_all<std_msgs_msg_dds__UInt64_>(steps_);
  if (forces_ > 0) {
    const bool found = options_.style == RosStyle::kOmni
                           ? take_all<omni_msgs_msg_dds__OmniFeedback_>(forces_)
                           : take_all<geometry_msgs_msg_dds__WrenchStamped_>(forces_);
    if (found) {
      ++wrench_.number;
      wrench_.time_ns = channel_.clock->now_ns();
      channel_.wrench.store(wrench_);
    }
  }
  if (places_ > 0 && take_all<geometry_msgs_msg_dds__PoseStamped_>(places_)) {
    ++place_.number;
    channel_.hand.store(place_);
  }
  if (steps_ > 0) channel_.steps->permit(step_asked_);
}

/// Returns whether a valid message has arrived; the newest is kept.
template <class Message>
bool MessageReader::take_all(dds_entity_t reader) {
  std::array<void*, kTaken> samples{};
  std::array<dds_sample_info_t, kTaken> about{};
  const dds_return_t came = dds_take(reader, samples.data(), about.data(), kTaken, kTaken);
  bool found = false;
  for (dds_return_t i = 0; i < came; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!about[k].valid_data || !judge(*static_cast<const Message*>(samples[k]))) continue;
    if (found) channel_.counts.skipped.fetch_add(1);
    found = true;
  }
  if (came > 0) dds_return_loan(reader, samples.data(), came);
  return found;
}

bool MessageReader::good(MessageVerdict verdict) {
  if (verdict == MessageVerdict::kNotFinite) channel_.counts.not_finite.fetch_add(1);
  if (verdict == MessageVerdict::kWrongFrame) channel_.counts.wrong_frame.fetch_add(1);
  return verdict == MessageVerdict::kGood;
}

void MessageReader::keep_force(const std::array<double, 3>& f) {
  channel_.counts.taken.fetch_add(1);
  wrench_.f_W = from_style(options_.style, f);
}

bool MessageReader::judge(const geometry_msgs_msg_dds__WrenchStamped_& message) {
  const auto& f = message.wrench.force;
  const auto& t = message.wrench.torque;
  if (!good(check_message({f.x, f.y, f.z}, {t.x, t.y, t.z}, text_of(message.header.frame_id),
                          options_.world_frame))) {
    return false;
  }
  if (t.x != 0 || t.y != 0 || t.z != 0) channel_.counts.with_torque.fetch_add(1);
  const auto& stamp = message.header.stamp;
  const std::int64_t stamp_ns = 1'000'000'000LL * stamp.sec + stamp.nanosec;
  wrench_.answers_ns = stamp_ns != 0 ? stamp_ns - world_minus_run_ns_ : 0;
  keep_force({f.x, f.y, f.z});
  return true;
}

bool MessageReader::judge(const omni_msgs_msg_dds__OmniFeedback_& message) {
  const auto& f = message.force;
  if (!good(check_message({f.x, f.y, f.z}, {0, 0, 0}, "", options_.world_frame))) return false;
  keep_force({f.x, f.y, f.z});
  return true;
}

bool MessageReader::judge(const geometry_msgs_msg_dds__PoseStamped_& message) {
  const auto& p = message.pose.position;
  if (!good(check_message({p.x, p.y, p.z}, {0, 0, 0}, text_of(message.header.frame_id),
                          options_.world_frame))) {
    return false;
  }
  channel_.counts.hand_targets.fetch_add(1);
  place_.p_W = from_style(options_.style, {p.x, p.y, p.z});
  return true;
}

bool MessageReader::judge(const std_msgs_msg_dds__UInt64_& message) {
  step_asked_ = std::max<std::uint64_t>(step_asked_, message.data);
  return false;  // each message counts; none is skipped
}

}  // namespace thimble::ros2
