#include "replug_watch.h"

#include <string>
#include <utility>

#include "log/logger.h"
#include "setup.h"
#include "thimble/scene/real_arm.h"
#include "thimble/session/session.h"

namespace thimble::session {
namespace {

using driver::LinkState;

constexpr int kStepsBetweenSearches = 5;  // half a second; chosen

/// Returns the start pose of an arm. A simulated arm needs no home pose: its counters never
/// restart, and the user cannot move it there.
StartPose place_of(const Setup& setup, std::size_t arm) {
  if (setup.real_arm(arm)) return setup.start_pose(arm);
  return {setup.arm_file(arm).workspace, std::nullopt};
}

}  // namespace

ReplugWatch::ReplugWatch(driver::Device& device,
                         const driver::Snapshot<driver::TickRecord>& snapshot,
                         const StartPose& place, const driver::FoundArm& arm, Access access,
                         Terminal terminal)
    : device_(device),
      snapshot_(snapshot),
      place_(place),
      arm_(arm),
      access_(std::move(access)),
      terminal_(std::move(terminal)) {}

void ReplugWatch::step() {
  driver::TickRecord record;
  if (!snapshot_.load(record)) return;
  if (record.fault == driver::Fault::kNone) {
    fault_reported_ = disconnected_ = reconnected_ = home_requested_ = false;
    terminal_.key();  // Discards an earlier Enter, which must not count for a later fault.
    return;
  }
  if (!fault_reported_) {
    fault_reported_ = true;
    terminal_.print_line("\nForce is off (" + std::string(name(record.fault)) + "). " +
                         std::string(describe(record.fault)));
    const bool home_requested_next = record.home_needed && place_.has_home();
    if (record.link != LinkState::kLost && !home_requested_next) {
      terminal_.print_line("Press Enter to enable forces again.");
    }
    if (record.fault == driver::Fault::kTransportLost)
      disconnected_ = true;  // the message of the fault says so already
    terminal_.key();
  }
  follow_link(record);
  if (terminal_.key() == EnterKey::kPressed) enable_forces(record);
}

void ReplugWatch::follow_link(const driver::TickRecord& record) {
  if (record.link == LinkState::kLost) {
    if (!disconnected_) {
      terminal_.print_line(
          (reconnected_ ? "The arm was disconnected again. " : "The arm was disconnected. ") +
          plug_in());
    }
    disconnected_ = true;
    search();
    return;
  }
  if (record.link != LinkState::kConnected) return;
  if (disconnected_) {
    disconnected_ = false;
    reconnected_ = home_requested_ = true;
    terminal_.print_line(
        place_.has_home()
            ? "The arm is connected again. Its counters started at zero in the pose in "
              "which it was plugged in, which must have been its home pose. Move it to "
              "its home pose and press Enter to enable forces."
            : "The arm is connected again and has found its zero. Hold its grip in the "
              "workspace and press Enter to enable forces.");
    terminal_.key();
  } else if (record.home_needed && !home_requested_ && place_.has_home()) {
    home_requested_ = true;
    terminal_.print_line(
        "The arm was silent or its position jumped. Its board may have restarted, so its counters "
        "may be wrong. Move it to its home pose and press Enter to enable forces.");
    terminal_.key();
  }
}

std::string ReplugWatch::plug_in() const {
  return place_.has_home() ? "Plug it in, in its home pose." : "Plug it in.";
}

void ReplugWatch::search() {
  if (pause_-- > 0) return;
  pause_ = kStepsBetweenSearches;
  const auto found = access_.find(arm_);
  if (!found) return;
  // Closed first, because a vendor's library can open its arm only once.
  device_.close_lost_link();
  auto link = access_.open(*found);
  if (!link) return;  // it may still be starting up; the next search tries again
  if (const auto taken = device_.offer(std::move(link).value()); !taken) {
    terminal_.print_line(taken.error().message);
    return;
  }
  arm_ = *found;
  scene::logger().info("{} is connected again: its new link is passed to the loop.", arm_.name());
}

void ReplugWatch::enable_forces(const driver::TickRecord& record) {
  if (record.link == LinkState::kLost)
    return terminal_.print_line("The arm is disconnected. " + plug_in());
  if (record.link == LinkState::kSilent) {
    return terminal_.print_line(
        "The arm is silent, so it gets no force. Check its power; if it stays silent, unplug it. " +
        plug_in());
  }
  const Eigen::Map<const Eigen::Vector3d> p_WT(record.p_WT.data());
  const std::string problem = place_.problem(p_WT, record.home_needed);
  if (problem.empty()) {
    device_.ask_to_activate(record.home_needed ? driver::HomeCheck::kPassed
                                               : driver::HomeCheck::kNone);
  } else {
    terminal_.print_line(problem + " Then press Enter.");
  }
}

ReplugWatch replug_watch_of(Session& session, std::size_t arm, Terminal terminal) {
  const Setup& setup = session.setup();
  const auto find = [](const driver::FoundArm& lost) -> std::optional<driver::FoundArm> {
    const auto plugged_in = scene::find_arms();
    return plugged_in ? scene::find_again(*plugged_in, lost) : std::nullopt;
  };
  const auto open = [&setup, arm](const driver::FoundArm& found) {
    return scene::open_link(found, setup.arm_file(arm), setup.firmware(), setup.clock());
  };
  return {
      setup.device(arm),
      session.newest(arm),
      place_of(setup, arm),
      setup.real_arm(arm).value_or(driver::FoundArm{}),  // a simulated arm is never disconnected
      {find, open},
      terminal_of(setup, arm, std::move(terminal))};
}

ReplugWatches::ReplugWatches(Session& session, Terminal terminal) : terminal_(std::move(terminal)) {
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    keys_.push_back(std::make_unique<EnterKey>(EnterKey::kNothing));
    Terminal own = terminal_;
    own.key = [key = keys_.back().get()] { return std::exchange(*key, EnterKey::kNothing); };
    watches_.push_back(replug_watch_of(session, arm, std::move(own)));
  }
}

void ReplugWatches::step() {
  const EnterKey key = terminal_.key();
  for (const auto& own : keys_) *own = key;
  for (ReplugWatch& watch : watches_) watch.step();
}

}  // namespace thimble::session
