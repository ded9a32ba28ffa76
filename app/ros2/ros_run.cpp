#include "ros2/ros_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "ros2/ros_module.h"
#include "ros2/ros_scene.h"
#include "run_records.h"
#include "setup.h"
#include "text/counted.h"
#include "thimble/driver/device.h"
#include "thimble/scene/scene_file.h"

namespace thimble::ros2 {
RosOptions options_of_arm(const session::Session& session, const RosOptions& options,
                          std::size_t arm) {
  RosOptions own = options;
  if (session.arms() == 1) return own;
  const std::string word = frame_name_of(session.arm_name(arm));
  own.arm_space = "/" + word;
  own.tip_frame = word + "_" + own.tip_frame;
  return own;
}

driver::Result<std::unique_ptr<RosRun>> RosRun::open(session::Session& session,
                                                     const RosOptions& options, std::size_t arm,
                                                     SteppedClock* clock) {
  std::unique_ptr<RosRun> run(new RosRun(session));
  const driver::Device& device = session.device(arm);
  run->options_ = options_of_arm(session, options, arm);
  run->channel_.clock = &session.setup().clock();
  run->channel_.tick = &session.newest(arm);
  run->channel_.arm = arm;
  if (clock != nullptr) {
    run->channel_.steps = &clock->steps();
    if (arm == 0) clock->steps().expect(session.arms());
  }
  run->options_.stepped = clock != nullptr;
  run->options_.moves_time = arm == 0;
  run->ends_tick_ = arm + 1 == session.arms();
  if (arm == 0) run->poses_ = session.records().poses.get();
  if (options.force != RosForce::kNone) {
    run->law_ = std::make_unique<WrenchLaw>(run->channel_, session.own_law(), options,
                                            device.gate().limits());
  }
  // The peer first: if the module is missing, the session remains unchanged.
  auto peer = open_ros_peer(run->options_, ros_scene(session, run->options_, arm), run->channel_);
  if (!peer) return peer.error();
  run->peer_ = std::move(peer).value();
  if (run->law_) {
    if (auto set = session.set_servo_law(driver::ForceLaw(*run->law_)); !set) return set.error();
  }
  if (!run->watches_ticks()) return run;
  if (auto added = session.add_observer(*run, arm); !added) return added.error();
  return run;
}

bool RosRun::watches_ticks() const noexcept {
  return poses_ != nullptr || options_.lead_hand || options_.stepped;
}

void RosRun::take(const driver::TickRecord& record) noexcept {
  // Enough for display: 60 times a second at 1 kHz.
  constexpr std::uint64_t kTicksPerPose = 16;
  if (poses_ != nullptr && (options_.stepped || record.tick % kTicksPerPose == 0)) {
    channel_.poses.store(poses_->now());
  }
  if (options_.lead_hand) {
    RosHandTarget place;
    constexpr int kAttempts = 4;  // an interrupted writer must not delay a tick
    if (channel_.hand.load(place, kAttempts) && place.number != targets_taken_) {
      targets_taken_ = place.number;
      if (!session_.lead_hand({place.p_W[0], place.p_W[1], place.p_W[2]})) ++targets_refused_;
    }
  }
  if (options_.stepped && ends_tick_) channel_.steps->done(record.tick + 1);
}

std::string RosRun::report() const {
  const RosCounts& counts = channel_.counts;
  std::string s =
      fmt::format("ROS 2     {} published", scene::counted(counts.published.load(), "tick"));
  if (law_)
    s += fmt::format("; {} received, {} limited", scene::counted(counts.taken.load(), "force"),
                     law_->cut());
  if (options_.lead_hand)
    s += fmt::format("; {} received", scene::counted(counts.hand_targets.load(), "hand target"));
  s += ".\n";
  const auto add_line = [&s](std::uint64_t number, const char* noun, const char* what) {
    if (number > 0) s += fmt::format("ROS 2     {} {}\n", scene::counted(number, noun), what);
  };
  add_line(counts.skipped.load(), "message", "skipped, because newer ones had arrived.");
  add_line(counts.not_finite.load(), "message", "refused, because a number was not finite.");
  add_line(counts.wrong_frame.load(), "message",
           "refused, because their frame was not the world frame.");
  add_line(targets_refused_, "hand target", "refused, because the arm could not reach them.");
  add_line(counts.with_torque.load(), "force",
           "had a torque, which was ignored: the arm has no motor for it.");
  if (!law_) return s;
  add_line(law_->stalls(), "time",
           "a force was not renewed in time; it was zero until the next one.");
  if (const session::Histogram& ages = law_->ages(); ages.count() > 0) {
    s += fmt::format(
        "ROS 2     delay from a position to its force: {:.2f} ms (median), {:.2f} ms (99 %)\n",
        1e-6 * ages.percentile(0.5), 1e-6 * ages.percentile(0.99));
  }
  return s;
}

}  // namespace thimble::ros2
