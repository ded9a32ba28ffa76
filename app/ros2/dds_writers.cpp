#include "ros2/dds_writers.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <string>

#include "ros2/dds_endpoints.h"
#include "ros2/dds_messages.h"

namespace thimble::ros2 {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// The Omni's drivers publish their state in millimetres [S bharatm11/Geomagic_Touch_ROS_Drivers
/// omni_state.cpp, units "mm"].
std::array<double, 3> in_mm(const std::array<double, 3>& v) {
  return {1e3 * v[0], 1e3 * v[1], 1e3 * v[2]};
}

}  // namespace

DdsWriters::DdsWriters(dds_entity_t participant, const RosOptions& options, const RosScene& scene)
    : options_(options), scene_(scene), objects_(participant, options, scene) {
  const RosNames& names = ros_names(options.style);
  const auto writer = [&](const dds_topic_descriptor_t& type, const char* name) {
    return kept(make_writer(participant, type, dds_topic_name(options, name)));
  };
  const bool omni = options.style == RosStyle::kOmni;
  joints_ = writer(sensor_msgs_msg_dds__JointState__desc, names.joints);
  pose_ = writer(geometry_msgs_msg_dds__PoseStamped__desc, names.pose);
  twist_ = writer(geometry_msgs_msg_dds__TwistStamped__desc, names.twist);
  wrench_ = writer(geometry_msgs_msg_dds__WrenchStamped__desc, names.wrench);
  buttons_ =
      writer(omni ? omni_msgs_msg_dds__OmniButtonEvent__desc : sensor_msgs_msg_dds__Joy__desc,
             names.buttons);
  if (names.state != nullptr) state_ = writer(omni_msgs_msg_dds__OmniState__desc, names.state);
  tf_ = kept(make_writer(participant, tf2_msgs_msg_dds__TFMessage__desc, "rt/tf"));
  health_ = kept(
      make_writer(participant, diagnostic_msgs_msg_dds__DiagnosticArray__desc, "rt/diagnostics"));
  if (options.stepped && options.moves_time) {
    clock_ = kept(make_writer(participant, rosgraph_msgs_msg_dds__Clock__desc, "rt/clock"));
    stepped_ = kept(make_writer(participant, std_msgs_msg_dds__UInt64__desc,
                                dds_run_topic_name(options, "stepped")));
  }
  kept(objects_.error());
  for (const std::string& name : scene.joints) joint_names_.push_back(dds_text(name));
  if (names.robot != nullptr) describe_robot(participant);
}

dds_entity_t DdsWriters::kept(dds_entity_t made) {
  if (made < 0 && error_ == 0) error_ = made;
  return made;
}

void DdsWriters::describe_robot(dds_entity_t participant) {
  const dds_entity_t description = kept(make_writer(
      participant, std_msgs_msg_dds__String__desc,
      dds_topic_name(options_, ros_names(options_.style).robot), LateReaders::kHearTheLast));
  if (description < 0) return;
  std_msgs_msg_dds__String_ urdf{.data = dds_text(scene_.urdf)};
  kept(dds_write(description, &urdf));
}

std_msgs_msg_dds__Header_ DdsWriters::header(const std::string& frame) const {
  return {stamp_, dds_text(frame)};
}

// A reader that is too slow loses messages. This does not concern the run, so the result of
// dds_write is ignored.
void DdsWriters::publish(const driver::TickRecord& record, const session::ScenePoses& poses,
                         std::int64_t time_ns) {
  stamp_ = stamp_of(time_ns);
  if (clock_ > 0) {
    rosgraph_msgs_msg_dds__Clock_ clock{.clock = stamp_};
    dds_write(clock_, &clock);
  }
  if (!joint_names_.empty()) publish_joints(record);
  publish_tip(record);
  publish_frames(record, poses);
  if (options_.style == RosStyle::kOmni) {
    publish_state(record);
    publish_button_event(record);
  } else {
    publish_buttons(record);
  }
  publish_health(record, time_ns);
}

void DdsWriters::publish_step_end(std::uint64_t ticks) {
  std_msgs_msg_dds__UInt64_ done{.data = ticks};
  dds_write(stepped_, &done);
}

void DdsWriters::publish_joints(const driver::TickRecord& record) {
  std::array<double, 6> angles = joint_angles(options_.style, record.q, record.gimbal);
  sensor_msgs_msg_dds__JointState_ joints{};
  joints.header = header(options_.world_frame);
  joints.name = dds_sequence<dds_sequence_string>(joint_names_, joint_names_.size());
  joints.position = dds_sequence<dds_sequence_double>(angles, joint_names_.size());
  dds_write(joints_, &joints);
}

geometry_msgs_msg_dds__Quaternion_ DdsWriters::rotation_of_tip(
    const driver::TickRecord& record) const {
  const driver::TipQuaternion& q = record.q_WT;
  if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0) return {0, 0, 0, 1};  // unknown
  return dds_quaternion(to_style(options_.style, std::array<double, 4>{q[0], q[1], q[2], q[3]}));
}

void DdsWriters::publish_tip(const driver::TickRecord& record) {
  geometry_msgs_msg_dds__PoseStamped_ pose{};
  pose.header = header(options_.world_frame);
  const std::array<double, 3> p = to_style(options_.style, record.p_WT);
  pose.pose.position = {p[0], p[1], p[2]};
  pose.pose.orientation = rotation_of_tip(record);
  dds_write(pose_, &pose);

  geometry_msgs_msg_dds__TwistStamped_ twist{};
  twist.header = pose.header;
  twist.twist.linear = dds_vector(to_style(options_.style, record.v_WT));
  dds_write(twist_, &twist);

  geometry_msgs_msg_dds__WrenchStamped_ wrench{};
  wrench.header = pose.header;
  wrench.wrench.force = dds_vector(to_style(options_.style, record.f_sent_W));
  dds_write(wrench_, &wrench);
}

void DdsWriters::publish_frames(const driver::TickRecord& record,
                                const session::ScenePoses& poses) {
  const std_msgs_msg_dds__Header_ in_world = header(options_.world_frame);
  auto frames = objects_.frames(poses, in_world);
  geometry_msgs_msg_dds__TransformStamped_ tip{};
  tip.header = in_world;
  tip.child_frame_id = dds_text(options_.tip_frame);
  tip.transform.translation = dds_vector(to_style(options_.style, record.p_WT));
  tip.transform.rotation = rotation_of_tip(record);
  frames.insert(frames.begin(), tip);
  tf2_msgs_msg_dds__TFMessage_ tf{};
  tf.transforms =
      dds_sequence<dds_sequence_geometry_msgs_msg_dds__TransformStamped_>(frames, frames.size());
  dds_write(tf_, &tf);
}

void DdsWriters::publish_buttons(const driver::TickRecord& record) {
  constexpr std::size_t kButtons = 2;  // as on existing styluses
  std::array<std::int32_t, kButtons> buttons{};
  for (std::size_t i = 0; i < kButtons; ++i) buttons[i] = record.buttons >> i & 1;
  std::array<float, 1> axes{record.gripper};
  sensor_msgs_msg_dds__Joy_ joy{};
  joy.header = header(options_.world_frame);
  joy.axes = dds_sequence<dds_sequence_float>(axes, record.has_gripper ? 1 : 0);
  joy.buttons = dds_sequence<dds_sequence_long>(buttons, kButtons);
  dds_write(buttons_, &joy);
}

void DdsWriters::publish_button_event(const driver::TickRecord& record) {
  if (record.buttons == published_buttons_) return;
  published_buttons_ = record.buttons;
  omni_msgs_msg_dds__OmniButtonEvent_ event{.grey_button = record.buttons & 1,
                                            .white_button = record.buttons >> 1 & 1};
  dds_write(buttons_, &event);
}

void DdsWriters::publish_state(const driver::TickRecord& record) {
  omni_msgs_msg_dds__OmniState_ state{};
  state.header = header(options_.world_frame);
  const std::array<double, 3> p = in_mm(to_style(options_.style, record.p_WT));
  state.pose.position = {p[0], p[1], p[2]};
  state.pose.orientation = rotation_of_tip(record);
  state.velocity = dds_vector(in_mm(to_style(options_.style, record.v_WT)));
  dds_write(state_, &state);
}

void DdsWriters::publish_health(const driver::TickRecord& record, std::int64_t time_ns) {
  // Once a second, as is usual in ROS [chosen], and when it changes.
  const ArmHealth health = health_of(record);
  if (health == published_health_ && time_ns - health_time_ns_ < kSecond_ns) return;
  published_health_ = health;
  health_time_ns_ = time_ns;
  const std::string name = "thimble: " + scene_.arm;
  const std::string fault(driver::name(record.fault));
  const std::string heat =
      std::to_string(*std::max_element(record.heat.begin(), record.heat.end()));
  const std::string force =
      std::to_string(Eigen::Map<const Eigen::Vector3d>(record.f_sent_W.data()).norm());
  const std::string link(driver::name(record.link));
  std::array<diagnostic_msgs_msg_dds__KeyValue_, 4> values{};
  static const std::string kNoFrame, kFault = "fault", kHeat = "heat, 1: limit",
                                     kForce = "force, N", kLink = "link";
  values[0] = {dds_text(kFault), dds_text(fault)};
  values[1] = {dds_text(kHeat), dds_text(heat)};
  values[2] = {dds_text(kForce), dds_text(force)};
  values[3] = {dds_text(kLink), dds_text(link)};
  std::array<diagnostic_msgs_msg_dds__DiagnosticStatus_, 1> status{};
  status[0].level = health.level;
  status[0].name = dds_text(name);
  status[0].message = dds_text(health.message);
  status[0].hardware_id = dds_text(scene_.arm);
  status[0].values =
      dds_sequence<dds_sequence_diagnostic_msgs_msg_dds__KeyValue_>(values, values.size());
  diagnostic_msgs_msg_dds__DiagnosticArray_ all{};
  all.header = header(kNoFrame);
  all.status = dds_sequence<dds_sequence_diagnostic_msgs_msg_dds__DiagnosticStatus_>(status, 1);
  dds_write(health_, &all);
}

}  // namespace thimble::ros2
