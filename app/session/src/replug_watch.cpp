#include "replug_watch.h"

#include <string>
#include <utility>

#include "log/logger.h"
#include "setup.h"
#include "thimble/scene/real_arm.h"
#include "thimble/session/session.h"

namespace thimble::session {
namespace {

constexpr int kStepsBetweenSearches = 5;  // half a second; chosen
// A wire that gives nothing for so many steps is taken for pulled again. [chosen: 1 s, ten times
// the longest start of a board's reports]
constexpr int kSilentSteps = 10;

}  // namespace

ReplugWatch::ReplugWatch(driver::Device& device,
                         const driver::Snapshot<driver::TickRecord>& snapshot,
                         const StartPose& place, const driver::FoundArm& arm, Ways ways,
                         Terminal terminal)
    : device_(device),
      snapshot_(snapshot),
      place_(place),
      arm_(arm),
      ways_(std::move(ways)),
      terminal_(std::move(terminal)) {}

void ReplugWatch::step() {
  driver::TickRecord record;
  if (!snapshot_.load(record)) return;
  if (record.fault == driver::Fault::kNone) {
    told_ = offered_ = restarted_ = false;
    present_ = true;
    terminal_.key();  // an Enter of before must not count for a fault to come
    return;
  }
  if (!told_) {
    told_ = true;
    silent_ = 0;
    present_ = record.fault != driver::Fault::kTransportLost;
    terminal_.tell("\nForce is off (" + std::string(name(record.fault)) + "). " +
                   std::string(describe(record.fault)));
    if (present_) terminal_.tell("Press Enter to let forces through again.");
    terminal_.key();
  }
  if (record.fault == driver::Fault::kTransportLost) look_after_pull(record);
  if (present_ && terminal_.key() == EnterKey::kPressed) let_through(record);
}

void ReplugWatch::look_after_pull(const driver::TickRecord& record) {
  silent_ = record.fresh ? 0 : silent_ + 1;
  if (offered_ && !present_ && record.fresh) {
    present_ = true;
    restarted_ = true;
    terminal_.tell(place_.has_home()
                       ? "The arm is back. Its counters began anew at zero where it stood when it "
                         "was plugged in, which must have been its home pose. Put it into its home "
                         "pose and press Enter to let forces through."
                       : "The arm is back, homed anew. Hold its grip in the workspace and press "
                         "Enter to let forces through.");
    terminal_.key();
  } else if ((offered_ || present_) && silent_ > kSilentSteps) {
    if (present_) terminal_.tell("The arm is gone again. Plug it in, in its home pose.");
    present_ = offered_ = false;
  } else if (!present_ && !offered_) {
    search();
  }
}

void ReplugWatch::search() {
  if (pause_-- > 0) return;
  pause_ = kStepsBetweenSearches;
  const auto found = ways_.find(arm_);
  if (!found) return;
  auto link = ways_.open(*found);
  if (!link) return;  // it may still be starting up; the next search tries again
  if (const auto taken = device_.offer(std::move(link).value()); !taken) {
    terminal_.tell(taken.error().message);
    return;
  }
  arm_ = *found;
  scene::logger().info("{} is back on the bus: a new link to it is offered to the loop.",
                       arm_.name());
  offered_ = true;
  silent_ = 0;
}

void ReplugWatch::let_through(const driver::TickRecord& record) {
  const Eigen::Map<const Eigen::Vector3d> p_WT(record.p_WT.data());
  const std::string trouble = place_.trouble(p_WT, restarted_);
  if (trouble.empty()) {
    device_.ask_to_activate();
  } else {
    terminal_.tell(trouble + " Then press Enter.");
  }
}

ReplugWatch replug_watch_of(Session& session, std::size_t arm, Terminal terminal) {
  const Setup& setup = session.setup();
  const auto find = [](const driver::FoundArm& lost) -> std::optional<driver::FoundArm> {
    const auto plugged_in = driver::find_arms();
    return plugged_in ? scene::find_again(*plugged_in, lost) : std::nullopt;
  };
  const auto open = [&setup, arm](const driver::FoundArm& found) {
    return scene::open_link(found, setup.arm_file(arm), setup.firmware(), setup.clock());
  };
  return {setup.device(arm),
          session.newest(arm),
          setup.start_pose(arm),
          setup.real_arm(arm).value_or(driver::FoundArm{}),  // one that is simulated is not pulled
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
