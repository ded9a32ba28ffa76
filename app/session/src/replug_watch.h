#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "start_pose.h"
#include "thimble/driver/device.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/snapshot.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

class Session;

/// A watch over a real arm beside the servo: prints when its force is off and why, finds it again
/// by its name after it was pulled, whatever the fault was, and lets forces through again only when
/// the user presses Enter and the tip is where it must be. The counters of an arm that was pulled,
/// or whose board restarted, begin at zero: it must be in its home pose then (Device::home_needed).
/// Real-time: never from the servo thread.
class ReplugWatch {
 public:
  /// How the watch comes to the arm again; tests write their own.
  struct Ways {
    /// Returns the same arm if it is plugged in again.
    std::function<std::optional<driver::FoundArm>(const driver::FoundArm& lost)> find;
    /// Opens the link to it.
    std::function<driver::Result<std::unique_ptr<driver::ArmLink>>(const driver::FoundArm& arm)>
        open;
  };

  /// Watches `arm`, which `device` drives and whose ticks `snapshot` shows.
  ReplugWatch(driver::Device& device, const driver::Snapshot<driver::TickRecord>& snapshot,
              const StartPose& place, const driver::FoundArm& arm, Ways ways, Terminal terminal);

  /// Looks once; call it a few times a second.
  void step();

 private:
  void follow_link(const driver::TickRecord& record);
  std::string plug_in() const;
  void search();
  void let_through(const driver::TickRecord& record);

  driver::Device& device_;
  const driver::Snapshot<driver::TickRecord>& snapshot_;
  StartPose place_;
  driver::FoundArm arm_;
  Ways ways_;
  Terminal terminal_;
  bool fault_reported_ = false;  // the user knows that the force is off
  bool gone_ = false;            // the arm was pulled and has not reported again
  bool returned_ = false;        // it came back since the fault
  bool home_asked_ = false;      // the user knows that the home pose is needed
  int pause_ = 0;                // steps until the next search
};

/// Returns the watch over an arm of a session, which must outlive it. Precondition: an arm of the
/// run is real, and all are open.
ReplugWatch replug_watch_of(Session& session, std::size_t arm = 0,
                            Terminal terminal = user_terminal());

/// The watches over all arms of a run with a real one: who presses Enter presses it for each arm
/// whose force is off. Real-time: never from the servo thread.
class THIMBLE_EXPORT ReplugWatches {
 public:
  /// Watches the arms of a session, which must outlive it. Precondition: as replug_watch_of.
  explicit ReplugWatches(Session& session, Terminal terminal = user_terminal());

  /// Looks once; call it a few times a second.
  void step();

 private:
  Terminal terminal_;
  std::vector<std::unique_ptr<EnterKey>> keys_;  // what each watch has yet to see
  std::vector<ReplugWatch> watches_;
};

}  // namespace thimble::session
