// The bytes of every message on the wire, compared with bytes written by hand from the rules of
// plain CDR (OMG DDSI-RTPS 2.5, 10.5; XTypes 1.3, 7.4.1): little endian, each number at a multiple
// of its size counted after the header of 4 bytes, texts with their length and a terminating zero.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dds/dds.h"
#include "dds/ddsi/ddsi_serdata.h"
#include "ros2/dds_messages.h"
#include "ros_messages.h"

namespace thimble::ros2 {
namespace {

// Numbers in wire format.
const std::string k0 = "0000000000000000", k1 = "000000000000f03f", k2 = "0000000000000040",
                  k3 = "0000000000000840", kHalf = "000000000000e03f";
const std::string kZero = "00000000", kOne = "01000000", kTwo = "02000000", kThree = "03000000";
// A header of 1 s, 2 ns, frame "w": 14 bytes.
const std::string kHeader = kOne + kTwo + kTwo + "7700";
const std::string kEmpty = kOne + "00";  // an empty text: 5 bytes

/// A writer and a reader of one topic in one process; nothing leaves this machine.
class Wire {
 public:
  Wire() {
    domain_ =
        dds_create_domain(kDomain,
                          "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"lo\" "
                          "multicast=\"true\"/></Interfaces></General></Domain></CycloneDDS>");
    participant_ = dds_create_participant(kDomain, nullptr, nullptr);
  }
  ~Wire() {
    if (domain_ > 0) dds_delete(domain_);
  }
  bool up() const { return participant_ > 0; }

  /// Returns the bytes of a message as its readers get them, in hexadecimal digits.
  std::string bytes_of(const dds_topic_descriptor_t& type, const void* message) {
    const std::string name = "rt/t" + std::to_string(++topics_);
    const dds_entity_t topic =
        dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    const dds_entity_t reader = dds_create_reader(participant_, topic, qos, nullptr);
    const dds_entity_t writer = dds_create_writer(participant_, topic, qos, nullptr);
    dds_delete_qos(qos);
    if (dds_write(writer, message) < 0) return "not written";
    std::array<ddsi_serdata*, 1> taken{};
    std::array<dds_sample_info_t, 1> about{};
    if (dds_takecdr(reader, taken.data(), 1, about.data(), DDS_ANY_STATE) != 1) return "not read";
    std::vector<unsigned char> bytes(ddsi_serdata_size(taken[0]));
    ddsi_serdata_to_ser(taken[0], 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(taken[0]);
    std::string text;
    for (const unsigned char byte : bytes) {
      constexpr const char* kDigits = "0123456789abcdef";
      text += kDigits[byte >> 4U];
      text += kDigits[byte & 15U];
    }
    return text;
  }

 private:
  static constexpr std::uint32_t kDomain = 77;
  dds_entity_t domain_ = 0, participant_ = 0;
  int topics_ = 0;
};

class Cdr : public testing::Test {
 protected:
  void SetUp() override {
    if (!wire_.up()) GTEST_SKIP() << "the interface lo is down; as root: ip link set lo up";
  }
  /// Compares the bytes after the header. Its last byte is the number of padding bytes at the end.
  void expect_bytes(const dds_topic_descriptor_t& type, const void* message,
                    const std::string& expected) {
    const std::string bytes = wire_.bytes_of(type, message);
    ASSERT_GE(bytes.size(), 8U) << bytes;
    EXPECT_EQ(bytes.substr(0, 6), "000100") << "plain CDR, little endian";
    const std::size_t filled = (expected.size() + 7) / 8 * 8;
    EXPECT_EQ(bytes.substr(8), expected + std::string(filled - expected.size(), '0'))
        << type.m_typename;
  }

  std::string w_ = "w", empty_, ab_ = "ab", abc_ = "abc";
  std_msgs_msg_dds__Header_ header_{{1, 2}, w_.data()};
  Wire wire_;
};

TEST_F(Cdr, EncodesTextsAndCounts) {
  const std_msgs_msg_dds__String_ text{.data = abc_.data()};
  expect_bytes(std_msgs_msg_dds__String__desc, &text,
               "04000000"
               "61626300");
  const std_msgs_msg_dds__UInt64_ count{.data = 0x0102030405060708};
  expect_bytes(std_msgs_msg_dds__UInt64__desc, &count, "0807060504030201");
  const rosgraph_msgs_msg_dds__Clock_ clock{.clock = {1, 2}};
  expect_bytes(rosgraph_msgs_msg_dds__Clock__desc, &clock, kOne + kTwo);
}

TEST_F(Cdr, EncodesPosesTwistsAndWrenches) {
  const geometry_msgs_msg_dds__PoseStamped_ pose{.header = header_,
                                                 .pose = {{1, 2, 3}, {0, 0, 0, 1}}};
  expect_bytes(geometry_msgs_msg_dds__PoseStamped__desc, &pose,
               kHeader + "0000" + k1 + k2 + k3 + k0 + k0 + k0 + k1);
  const geometry_msgs_msg_dds__TwistStamped_ twist{.header = header_,
                                                   .twist = {{1, 2, 3}, {0.5, 0, 1}}};
  const std::string six = kHeader + "0000" + k1 + k2 + k3 + kHalf + k0 + k1;
  expect_bytes(geometry_msgs_msg_dds__TwistStamped__desc, &twist, six);
  const geometry_msgs_msg_dds__WrenchStamped_ wrench{.header = header_,
                                                     .wrench = {{1, 2, 3}, {0.5, 0, 1}}};
  expect_bytes(geometry_msgs_msg_dds__WrenchStamped__desc, &wrench, six);
}

TEST_F(Cdr, EncodesFrames) {
  std::array<geometry_msgs_msg_dds__TransformStamped_, 1> one{
      {{header_, ab_.data(), {{1, 2, 3}, {0, 0, 0, 1}}}}};
  tf2_msgs_msg_dds__TFMessage_ tf{};
  tf.transforms = dds_sequence<dds_sequence_geometry_msgs_msg_dds__TransformStamped_>(one, 1);
  // Count at 0, header from 4 to 18, length of the name at 20, name to 27, numbers from 32.
  expect_bytes(tf2_msgs_msg_dds__TFMessage__desc, &tf,
               kOne + kHeader + "0000" + kThree + "616200" + "0000000000" + k1 + k2 + k3 + k0 + k0 +
                   k0 + k1);
}

TEST_F(Cdr, EncodesJointsAndButtons) {
  std::array<char*, 2> names{w_.data(), ab_.data()};
  std::array<double, 2> angles{1, 2};
  sensor_msgs_msg_dds__JointState_ joints{};
  joints.header = header_;
  joints.name = dds_sequence<dds_sequence_string>(names, 2);
  joints.position = dds_sequence<dds_sequence_double>(angles, 2);
  // Names from 16: count, "w" to 26, "ab" from 28 to 35; count of angles at 36, angles from 40.
  expect_bytes(sensor_msgs_msg_dds__JointState__desc, &joints,
               kHeader + "0000" + kTwo + kTwo + "7700" + "0000" + kThree + "616200" + "00" + kTwo +
                   k1 + k2 + kZero + kZero);
  std::array<float, 1> axes{1};
  std::array<std::int32_t, 2> buttons{0, 1};
  sensor_msgs_msg_dds__Joy_ joy{};
  joy.header = header_;
  joy.axes = dds_sequence<dds_sequence_float>(axes, 1);
  joy.buttons = dds_sequence<dds_sequence_long>(buttons, 2);
  expect_bytes(sensor_msgs_msg_dds__Joy__desc, &joy,
               kHeader + "0000" + kOne + "0000803f" + kTwo + kZero + kOne);
}

TEST_F(Cdr, EncodesDiagnostics) {
  std::array<diagnostic_msgs_msg_dds__KeyValue_, 1> values{{{w_.data(), ab_.data()}}};
  std::array<diagnostic_msgs_msg_dds__DiagnosticStatus_, 1> status{};
  status[0].level = 2;
  status[0].name = status[0].hardware_id = w_.data();
  status[0].message = ab_.data();
  status[0].values = dds_sequence<dds_sequence_diagnostic_msgs_msg_dds__KeyValue_>(values, 1);
  diagnostic_msgs_msg_dds__DiagnosticArray_ health{};
  health.header = header_;
  health.status = dds_sequence<dds_sequence_diagnostic_msgs_msg_dds__DiagnosticStatus_>(status, 1);
  // Count at 16; level at 20; name at 24 to 30; message at 32 to 39; hardware at 40 to 46; count
  // of values at 48; key at 52 to 58; value at 60.
  expect_bytes(diagnostic_msgs_msg_dds__DiagnosticArray__desc, &health,
               kHeader + "0000" + kOne + "02000000" + kTwo + "7700" + "0000" + kThree + "616200" +
                   "00" + kTwo + "7700" + "0000" + kOne + kTwo + "7700" + "0000" + kThree +
                   "616200");
}

TEST_F(Cdr, EncodesMarkers) {
  std::array<geometry_msgs_msg_dds__Point_, 1> points{{{1, 2, 3}}};
  std::array<visualization_msgs_msg_dds__Marker_, 1> markers{};
  visualization_msgs_msg_dds__Marker_& marker = markers[0];
  marker.header = header_;
  marker.ns = ab_.data();
  marker.id = 1;
  marker.type = 2;
  marker.action = 3;
  marker.pose = {{1, 2, 3}, {0, 0, 0, 1}};
  marker.scale = {1, 1, 1};
  marker.color = {1, 0, 0, 1};
  marker.lifetime = {1, 2};
  marker.frame_locked = true;
  marker.points = dds_sequence<dds_sequence_geometry_msgs_msg_dds__Point_>(points, 1);
  marker.texture.header.frame_id = empty_.data();
  for (char** text : {&marker.texture_resource, &marker.texture.format, &marker.text,
                      &marker.mesh_resource, &marker.mesh_file.filename}) {
    *text = empty_.data();
  }
  visualization_msgs_msg_dds__MarkerArray_ all{};
  all.markers = dds_sequence<dds_sequence_visualization_msgs_msg_dds__Marker_>(markers, 1);
  const std::string four = "0000803f";             // 1 as a float
  std::string expected = kOne + kHeader + "0000";  // to 20
  expected += kThree + "616200" + "00";            // ns, to 28
  expected += kOne + kTwo + kThree;                // id, type, action, to 40
  expected += k1 + k2 + k3 + k0 + k0 + k0 + k1;    // pose, to 96
  expected += k1 + k1 + k1;                        // scale, to 120
  expected += four + kZero + kZero + four;         // colour, to 136
  expected += kOne + kTwo;                         // lifetime, to 144
  expected +=
      "01"
      "000000";                                       // locked, to 148
  expected += kOne + k1 + k2 + k3;                    // count, points from 152 to 176
  expected += kZero;                                  // colours, to 180
  expected += kEmpty + "000000";                      // texture_resource, to 188
  expected += kZero + kZero + kEmpty + "000000";      // texture's header, to 204
  expected += kEmpty + "000000" + kZero;              // its format and data, to 216
  expected += kZero;                                  // uv_coordinates, to 220
  expected += kEmpty + "000000" + kEmpty + "000000";  // text, mesh_resource, to 236
  expected += kEmpty + "000000" + kZero;              // mesh_file, to 248
  expected += "00";                                   // mesh_use_embedded_materials
  expect_bytes(visualization_msgs_msg_dds__MarkerArray__desc, &all, expected);
}

TEST_F(Cdr, EncodesOmniMessages) {
  const omni_msgs_msg_dds__OmniButtonEvent_ event{.grey_button = 1, .white_button = 2};
  expect_bytes(omni_msgs_msg_dds__OmniButtonEvent__desc, &event, kOne + kTwo);
  const omni_msgs_msg_dds__OmniFeedback_ feedback{.force = {1, 2, 3}, .position = {0.5, 0, 1}};
  expect_bytes(omni_msgs_msg_dds__OmniFeedback__desc, &feedback, k1 + k2 + k3 + kHalf + k0 + k1);
  omni_msgs_msg_dds__OmniState_ state{};
  state.header = header_;
  state.locked = false;
  state.close_gripper = true;
  state.pose = {{1, 2, 3}, {0, 0, 0, 1}};
  state.velocity = {3, 2, 1};
  expect_bytes(omni_msgs_msg_dds__OmniState__desc, &state,
               kHeader + "0001" + k1 + k2 + k3 + k0 + k0 + k0 + k1 + k0 + k0 + k0 + k3 + k2 + k1);
}

}  // namespace
}  // namespace thimble::ros2
