// A program with another vendor's DDS. It receives topics, requests forces, moves the hand, and
// sends invalid messages.
//   peer DOMAIN SECONDS FORCE      receives all topics, and requests FORCE (N, x) after the first
//   pose peer DOMAIN SECONDS garbage    sends invalid messages: not finite, wrong frame, huge, too
//   many peer DOMAIN SECONDS hand       moves the hand in a circle, and requests no force peer
//   DOMAIN SECONDS omni       uses topics like programs for the Omni's drivers peer DOMAIN STEPS
//   step         advances a run by STEPS steps of 10 ticks peer DOMAIN STEPS step_two     the same
//   for a run with the arms left and right
// Prints the received messages, one line per topic, then the sums of the last second.
#include "peer.h"

#include <array>
#include <cmath>
#include <limits>
#include <thread>

using diagnostic_msgs::msg::dds_::DiagnosticArray_;
using geometry_msgs::msg::dds_::PoseStamped_;
using geometry_msgs::msg::dds_::TwistStamped_;
using geometry_msgs::msg::dds_::WrenchStamped_;
using sensor_msgs::msg::dds_::JointState_;
using sensor_msgs::msg::dds_::Joy_;
using std_msgs::msg::dds_::String_;
using tf2_msgs::msg::dds_::TFMessage_;
using visualization_msgs::msg::dds_::MarkerArray_;

namespace {

/// Counts the messages with a wrong header: the time must be near the wall clock's, the frame
/// known.
long bad = 0;
void check(const std_msgs::msg::dds_::Header_& header) {
  const auto now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch());
  const double age = now.count() - (header.stamp().sec() + 1e-9 * header.stamp().nanosec());
  if (header.frame_id() != "world" || !(std::fabs(age) < 5)) ++bad;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const std::string part = argv[3];
  const bool garbage = part == "garbage", leads = part == "hand";
  const double force = garbage || leads ? 0 : std::atof(argv[3]);
  if (!enter(argv[1])) return 3;
  if (part == "omni") return play_omni(std::atof(argv[2]));
  if (part == "step") return play_steps(std::atol(argv[2]), {""});
  if (part == "step_two") return play_steps(std::atol(argv[2]), {"/left", "/right"});
  Heard<JointState_, sensor_msgs::msg::dds_::JointState_PubSubType> joints("rt/joint_states");
  Heard<PoseStamped_, geometry_msgs::msg::dds_::PoseStamped_PubSubType> pose("rt/pose");
  Heard<TwistStamped_, geometry_msgs::msg::dds_::TwistStamped_PubSubType> twist("rt/twist");
  Heard<WrenchStamped_, geometry_msgs::msg::dds_::WrenchStamped_PubSubType> wrench("rt/wrench");
  Heard<Joy_, sensor_msgs::msg::dds_::Joy_PubSubType> button("rt/button");
  Heard<TFMessage_, tf2_msgs::msg::dds_::TFMessage_PubSubType> tf("rt/tf");
  Heard<DiagnosticArray_, diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType> health(
      "rt/diagnostics");
  Heard<String_, std_msgs::msg::dds_::String_PubSubType> robot("rt/robot_description", true);
  Heard<MarkerArray_, visualization_msgs::msg::dds_::MarkerArray_PubSubType> objects("rt/objects",
                                                                                     true);
  DataWriter* command =
      writer<geometry_msgs::msg::dds_::WrenchStamped_PubSubType>("rt/command/wrench");
  DataWriter* place = writer<geometry_msgs::msg::dds_::PoseStamped_PubSubType>("rt/command/pose");

  WrenchStamped_ ask;
  double f_last = 0, f_max = 0;
  PoseStamped_ there;
  std::array<double, 3> p{}, p_tf{}, led{};
  double off = 0;  // distance of the tip from the hand's target, m
  long sent = 0, triangles = 0;
  std::map<std::string, double> moved;  // distances that frames of objects moved, m
  const auto end = Clock::now() + std::chrono::duration<double>(std::atof(argv[2]));
  for (long round = 0; Clock::now() < end; ++round) {
    joints.each([](JointState_& m) {
      check(m.header());
      if (m.name().size() < 3 || m.name()[0] != "joint1" || m.position().size() != m.name().size())
        ++bad;
      for (double q : m.position()) bad += !(std::fabs(q) < 7);
    });
    pose.each([&p, &ask](PoseStamped_& m) {
      check(m.header());
      ask.header().stamp(m.header().stamp());  // the stamp of the pose that the force answers
      p = {m.pose().position().x(), m.pose().position().y(), m.pose().position().z()};
      const auto& q = m.pose().orientation();
      const double length = q.x() * q.x() + q.y() * q.y() + q.z() * q.z() + q.w() * q.w();
      if (!(std::fabs(length - 1) < 1e-6)) ++bad;
    });
    twist.each([](TwistStamped_& m) {
      check(m.header());
      if (!(std::fabs(m.twist().linear().x()) < 10)) ++bad;
    });
    wrench.each([&](WrenchStamped_& m) {
      check(m.header());
      f_last = m.wrench().force().x();
      f_max = std::max(f_max, std::hypot(f_last, m.wrench().force().y(), m.wrench().force().z()));
    });
    button.each([](Joy_& m) {
      check(m.header());
      if (m.buttons().size() != 2) ++bad;
    });
    tf.each([&p_tf, &moved](TFMessage_& m) {
      if (m.transforms().empty() || m.transforms()[0].child_frame_id() != "tip") {
        ++bad;
        return;
      }
      check(m.transforms()[0].header());
      const auto& t = m.transforms()[0].transform().translation();
      p_tf = {t.x(), t.y(), t.z()};
      for (std::size_t i = 1; i < m.transforms().size(); ++i) {
        const auto& far = m.transforms()[i].transform().translation();
        moved[m.transforms()[i].child_frame_id()] = std::hypot(far.x(), far.y(), far.z());
      }
    });
    objects.each([&triangles](MarkerArray_& m) {
      for (const auto& marker : m.markers()) {
        if (marker.type() != 11 || marker.points().size() % 3 != 0 || marker.scale().x() != 1 ||
            marker.pose().orientation().w() != 1 || marker.color().a() != 1)
          ++bad;
        triangles += static_cast<long>(marker.points().size() / 3);
        std::printf("object %s in %s\n", marker.ns().c_str(), marker.header().frame_id().c_str());
      }
    });
    health.each([](DiagnosticArray_& m) {
      const bool one = m.status().size() == 1;
      if (!one || m.status()[0].name() != "thimble: vintage_phantom" ||
          m.status()[0].level() != 0 || m.status()[0].values().size() != 4 ||
          m.status()[0].values()[0].value() != "none" ||
          m.status()[0].values()[3].key() != "link" ||
          m.status()[0].values()[3].value() != "connected")
        ++bad;
    });
    robot.each([](String_& m) {
      const std::string& urdf = m.data();
      if (urdf.find("<robot name=\"vintage_phantom\">") == std::string::npos ||
          urdf.find("</robot>") == std::string::npos)
        ++bad;
    });
    if (garbage) {
      constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
      ask.header().frame_id(round % 4 == 1 ? "elsewhere" : "world");
      ask.wrench().force().x(round % 4 == 0 ? kNan : round % 4 == 1 ? 1 : 1e300);
      ask.wrench().torque().z(round % 4 == 3 ? 1 : 0);
      for (int i = 0; i < 10; ++i) sent += command->write(&ask) ? 1 : 0;
    } else if (leads && pose.count() > 0) {
      // A circle of 10 mm in 2 s; the simulated hand lags by 50 ms.
      off = std::hypot(p[0] - led[0], p[1] - led[1], p[2] - led[2]);
      const double angle = 3.14159 * 1e-3 * static_cast<double>(round);
      led = {0.01 * std::cos(angle), 0.01 * std::sin(angle), 0.02};
      there.header().frame_id("world");
      there.pose().position().x(led[0]);
      there.pose().position().y(led[1]);
      there.pose().position().z(led[2]);
      sent += place->write(&there) ? 1 : 0;
    } else if (pose.count() > 0 && force != 0) {
      ask.header().frame_id("world");
      ask.wrench().force().x(force);
      sent += command->write(&ask) ? 1 : 0;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  joints.print(), pose.print(), twist.print(), wrench.print(), button.print(), tf.print(),
      robot.print(), health.print(), objects.print();
  for (const auto& [frame, far] : moved) std::printf("frame %s moved %.4f\n", frame.c_str(), far);
  discovery.print();
  std::printf("triangles %ld\nled to %.4f %.4f off %.4f\n", triangles, led[0], led[1], off);
  const double apart = std::hypot(p[0] - p_tf[0], p[1] - p_tf[1], p[2] - p_tf[2]);
  std::printf("sent %ld\nbad %ld\nforce %.3f most %.3f\napart %.4f\nposition %.4f %.4f %.4f\n",
              sent, bad, f_last, f_max, apart, p[0], p[1], p[2]);
}
