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

/// Monitors a real arm outside of the servo loop. It prints when and why the force is off, and
/// finds a disconnected arm again by its name, whatever the fault was. It enables forces only when
/// the user presses Enter and the tip is at the start pose. After a disconnection or a restart of
/// its board, the counters of an arm start at zero. So it must be in its home pose
/// (Device::home_needed). Real-time: never from the servo thread.
class ReplugWatch {
 public:
  /// Functions to access the arm again; replaced in tests.
  struct Access {
    /// Returns the same arm if it is connected again.
    std::function<std::optional<driver::FoundArm>(const driver::FoundArm& lost)> find;
    /// Opens the link to the arm.
    std::function<driver::Result<std::unique_ptr<driver::ArmLink>>(const driver::FoundArm& arm)>
        open;
  };

  /// Monitors `arm`, which `device` drives and whose ticks are in `snapshot`.
  ReplugWatch(driver::Device& device, const driver::Snapshot<driver::TickRecord>& snapshot,
              const StartPose& place, const driver::FoundArm& arm, Access access,
              Terminal terminal);

  /// Checks once; call it a few times a second.
  void step();

 private:
  void follow_link(const driver::TickRecord& record);
  std::string plug_in() const;
  void search();
  void enable_forces(const driver::TickRecord& record);

  driver::Device& device_;
  const driver::Snapshot<driver::TickRecord>& snapshot_;
  StartPose place_;
  driver::FoundArm arm_;
  Access access_;
  Terminal terminal_;
  bool fault_reported_ = false;  // True if the user was informed that the force is off.
  bool disconnected_ = false;    // True if the arm was disconnected and has not reported again.
  bool reconnected_ = false;     // True if the arm was reconnected since the fault.
  bool home_requested_ = false;  // True if the user was informed that the home pose is required.
  int pause_ = 0;                // Steps until the next search.
};

/// Returns the watch of an arm of a session, which must outlive it. Precondition: an arm of the run
/// is real, and all are open.
ReplugWatch replug_watch_of(Session& session, std::size_t arm = 0,
                            Terminal terminal = user_terminal());

/// Watches of all arms of a run with a real arm. Enter applies to every arm whose force is off.
/// Real-time: never from the servo thread.
class THIMBLE_EXPORT ReplugWatches {
 public:
  /// Monitors the arms of a session, which must outlive it. Precondition: as for replug_watch_of.
  explicit ReplugWatches(Session& session, Terminal terminal = user_terminal());

  /// Checks once; call it a few times a second.
  void step();

 private:
  Terminal terminal_;
  std::vector<std::unique_ptr<EnterKey>> keys_;  // Keys that each watch has not yet handled.
  std::vector<ReplugWatch> watches_;
};

}  // namespace thimble::session
