// A test by another program: it advances a run by steps, faster than real time, and gets an answer
// after each step.
#include <array>
#include <cmath>
#include <cstdio>
#include <list>
#include <string>
#include <thread>
#include <vector>

#include "peer.h"

using geometry_msgs::msg::dds_::PoseStamped_;
using geometry_msgs::msg::dds_::WrenchStamped_;
using rosgraph_msgs::msg::dds_::Clock_;
using std_msgs::msg::dds_::UInt64_;

namespace {

double seconds(const builtin_interfaces::msg::dds_::Time_& stamp) {
  return stamp.sec() + 1e-9 * stamp.nanosec();
}

/// The topics of one arm, and their last values.
struct Arm {
  explicit Arm(const std::string& space)
      : pose("rt" + space + "/pose"),
        wrench("rt" + space + "/wrench"),
        command(writer<geometry_msgs::msg::dds_::WrenchStamped_PubSubType>("rt" + space +
                                                                           "/command/wrench")) {}

  bool is_heard() const {
    PublicationMatchedStatus matched;
    command->get_publication_matched_status(matched);
    return matched.current_count > 0;
  }
  /// Requests the force of a spring towards the axis, from the last values; false if it was not
  /// delivered.
  bool pull() {
    WrenchStamped_ force;
    force.header().frame_id("world");
    force.wrench().force().x(-50 * p[0]);
    force.wrench().force().y(-50 * p[1]);
    command->write(&force);
    return command->wait_for_acknowledgments({5, 0}) == ReturnCode_t::RETCODE_OK;
  }
  void hear() {
    pose.each([this](PoseStamped_& m) {
      time_pose = seconds(m.header().stamp());
      p = {m.pose().position().x(), m.pose().position().y(), m.pose().position().z()};
    });
    wrench.each([this](WrenchStamped_& m) {
      time_wrench = seconds(m.header().stamp());
      f = m.wrench().force().x();
    });
  }

  Heard<PoseStamped_, geometry_msgs::msg::dds_::PoseStamped_PubSubType> pose;
  Heard<WrenchStamped_, geometry_msgs::msg::dds_::WrenchStamped_PubSubType> wrench;
  DataWriter* command;
  double time_pose = -1, time_wrench = -1, f = 0;  // s, s, N
  std::array<double, 3> p{};                       // m
};

}  // namespace

int play_steps(long steps, const std::vector<std::string>& spaces) {
  constexpr std::uint64_t kTicks = 10;  // per step
  Heard<UInt64_, std_msgs::msg::dds_::UInt64_PubSubType> stepped("rt/stepped");
  Heard<Clock_, rosgraph_msgs::msg::dds_::Clock_PubSubType> clock("rt/clock");
  std::list<Arm> arms;
  for (const std::string& space : spaces) arms.emplace_back(space);
  DataWriter* step = writer<std_msgs::msg::dds_::UInt64_PubSubType>("rt/step");
  const bool pull = arms.size() == 1;  // with several arms, topics take no forces
  // A force without a reader would be lost. Wait until the reader exists, then for ten reports of
  // the run's progress, because the run has to discover this program as well.
  constexpr long kReports = 10;
  const auto late = Clock::now() + std::chrono::seconds(50);
  bool heard = false;
  for (long from = 0; stepped.count() < from + kReports;) {
    if (Clock::now() > late) return 4;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    stepped.each([](UInt64_&) {});
    if (heard) continue;
    heard = !pull || arms.front().is_heard();
    from = stepped.count();
  }
  UInt64_ ask;
  std::uint64_t done = 0;
  long bad = 0, early = 0;
  double time = -1, sum = 0;  // s
  const auto begun = Clock::now();
  for (long i = 0; i < steps; ++i) {
    if (pull) bad += arms.front().pull() ? 0 : 1;
    ask.data(kTicks * static_cast<std::uint64_t>(i + 1));
    const double wanted = 1e-3 * static_cast<double>(ask.data() - 1);
    const auto all_reported = [&] {
      bool complete = done == ask.data() && time >= wanted - 1e-6;
      for (const Arm& arm : arms)
        complete = complete && arm.time_pose == time && arm.time_wrench == time;
      return complete;
    };
    auto again = Clock::now();
    while (!all_reported()) {
      if (Clock::now() > late) return 5;
      if (Clock::now() >= again) {  // a repeated request has no effect
        step->write(&ask);
        again += std::chrono::milliseconds(200);
      }
      stepped.each([&done](UInt64_& m) { done = m.data(); });
      clock.each([&](Clock_& m) {
        if (seconds(m.clock()) < time) ++bad;
        time = seconds(m.clock());
      });
      for (Arm& arm : arms) {
        arm.hear();
        // A stamp from the wall clock would be decades ahead.
        if (arm.time_pose > wanted + 1e-6) ++early;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    for (const Arm& arm : arms) {
      sum += std::fabs(arm.p[0]) + std::fabs(arm.p[1]) + std::fabs(arm.p[2]) + std::fabs(arm.f);
    }
  }
  const std::chrono::duration<double> took = Clock::now() - begun;
  std::printf("stepped %llu\nclock %.3f\nbad %ld\nsum %.17g\n",
              static_cast<unsigned long long>(done), time, bad + early, sum);
  std::fprintf(stderr, "%.0f steps/s, %.1f times the world's time\n",
               static_cast<double>(steps) / took.count(),
               1e-3 * static_cast<double>(done) / took.count());
  return 0;
}
