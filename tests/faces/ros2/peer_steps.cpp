// A test of another program: it moves a run on by steps, faster than the world's time, and has an
// answer after each.
#include <array>
#include <cmath>
#include <cstdio>
#include <thread>

#include "peer.h"

using geometry_msgs::msg::dds_::PoseStamped_;
using geometry_msgs::msg::dds_::WrenchStamped_;
using rosgraph_msgs::msg::dds_::Clock_;
using std_msgs::msg::dds_::UInt64_;

int play_steps(long steps) {
  constexpr std::uint64_t kTicks = 10;  // per step
  Heard<UInt64_, std_msgs::msg::dds_::UInt64_PubSubType> stepped("rt/stepped");
  Heard<Clock_, rosgraph_msgs::msg::dds_::Clock_PubSubType> clock("rt/clock");
  Heard<PoseStamped_, geometry_msgs::msg::dds_::PoseStamped_PubSubType> pose("rt/pose");
  Heard<WrenchStamped_, geometry_msgs::msg::dds_::WrenchStamped_PubSubType> wrench("rt/wrench");
  DataWriter* step = writer<std_msgs::msg::dds_::UInt64_PubSubType>("rt/step");
  DataWriter* command =
      writer<geometry_msgs::msg::dds_::WrenchStamped_PubSubType>("rt/command/wrench");
  // A force that nobody hears yet would be missed: wait until who takes it is there, and then for
  // ten times that the run tells where it stands, for it has to find us as well.
  constexpr long kTold = 10;
  const auto late = Clock::now() + std::chrono::seconds(50);
  PublicationMatchedStatus matched;
  matched.current_count = 0;
  for (long from = 0; stepped.count() < from + kTold;) {
    if (Clock::now() > late) return 4;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    stepped.each([](UInt64_&) {});
    if (matched.current_count == 0) {
      command->get_publication_matched_status(matched);
      from = stepped.count();
    }
  }
  UInt64_ ask;
  WrenchStamped_ force;
  force.header().frame_id("world");
  std::uint64_t done = 0;
  long bad = 0;
  double time = -1, time_pose = -1, time_wrench = -1, f = 0, sum = 0;  // s; N
  std::array<double, 3> p{};
  const auto seconds = [](const auto& stamp) { return stamp.sec() + 1e-9 * stamp.nanosec(); };
  const auto begun = Clock::now();
  for (long i = 0; i < steps; ++i) {
    // A spring towards the axis, from what was told of the step before.
    force.wrench().force().x(-50 * p[0]);
    force.wrench().force().y(-50 * p[1]);
    command->write(&force);
    if (command->wait_for_acknowledgments({5, 0}) != ReturnCode_t::RETCODE_OK) ++bad;
    ask.data(kTicks * static_cast<std::uint64_t>(i + 1));
    const double wanted = 1e-3 * static_cast<double>(ask.data() - 1);
    auto again = Clock::now();
    while (done != ask.data() || time < wanted - 1e-6 || time_pose != time || time_wrench != time) {
      if (Clock::now() > late) return 5;
      if (Clock::now() >= again) {  // no harm in asking again
        step->write(&ask);
        again += std::chrono::milliseconds(200);
      }
      stepped.each([&done](UInt64_& m) { done = m.data(); });
      clock.each([&](Clock_& m) {
        if (seconds(m.clock()) < time) ++bad;
        time = seconds(m.clock());
      });
      pose.each([&](PoseStamped_& m) {
        time_pose = seconds(m.header().stamp());
        p = {m.pose().position().x(), m.pose().position().y(), m.pose().position().z()};
      });
      wrench.each([&](WrenchStamped_& m) {
        time_wrench = seconds(m.header().stamp());
        f = m.wrench().force().x();
      });
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    sum += std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]) + std::fabs(f);
  }
  const std::chrono::duration<double> took = Clock::now() - begun;
  std::printf("stepped %llu\nclock %.3f\nbad %ld\nsum %.17g\n",
              static_cast<unsigned long long>(done), time, bad, sum);
  std::fprintf(stderr, "%.0f steps/s, %.1f times the world's time\n",
               static_cast<double>(steps) / took.count(),
               1e-3 * static_cast<double>(done) / took.count());
  return 0;
}
