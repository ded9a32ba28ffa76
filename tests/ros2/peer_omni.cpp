// A program that was written for the drivers of the Omni: their topics, axes and messages.
#include <array>
#include <cmath>
#include <thread>

#include "peer.h"

using geometry_msgs::msg::dds_::PoseStamped_;
using omni_msgs::msg::dds_::OmniButtonEvent_;
using omni_msgs::msg::dds_::OmniFeedback_;
using omni_msgs::msg::dds_::OmniState_;
using sensor_msgs::msg::dds_::JointState_;

int play_omni(double seconds) {
  namespace omni = omni_msgs::msg::dds_;
  Heard<PoseStamped_, geometry_msgs::msg::dds_::PoseStamped_PubSubType> pose("rt/phantom/pose");
  Heard<JointState_, sensor_msgs::msg::dds_::JointState_PubSubType> joints(
      "rt/phantom/joint_states");
  Heard<OmniState_, omni::OmniState_PubSubType> state("rt/phantom/state");
  Heard<OmniButtonEvent_, omni::OmniButtonEvent_PubSubType> button("rt/phantom/button");
  DataWriter* feedback = writer<omni::OmniFeedback_PubSubType>("rt/phantom/force_feedback");
  std::array<double, 3> p{}, p_state{};
  long bad = 0;
  OmniFeedback_ ask;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end) {
    pose.each([&p](PoseStamped_& m) {
      p = {m.pose().position().x(), m.pose().position().y(), m.pose().position().z()};
    });
    joints.each([&bad](JointState_& m) {
      if (m.name().size() < 3 || m.name()[0] != "waist" || m.name()[2] != "elbow") ++bad;
    });
    state.each([&](OmniState_& m) {
      p_state = {m.pose().position().x(), m.pose().position().y(), m.pose().position().z()};
      if (m.locked() || m.close_gripper()) ++bad;
    });
    button.each([](OmniButtonEvent_&) {});
    ask.force().y(0.6);  // away from the user
    if (pose.count() > 0) feedback->write(&ask);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  pose.print(), joints.print(), state.print(), button.print();
  // The state is in millimetres.
  const double apart =
      std::hypot(p[0] - 1e-3 * p_state[0], p[1] - 1e-3 * p_state[1], p[2] - 1e-3 * p_state[2]);
  std::printf("bad %ld\nposition %.4f %.4f %.4f\napart %.4f\n", bad, p[0], p[1], p[2], apart);
  return 0;
}
