#pragma once

#include <memory>
#include <string>

#include "observers/pose_record.h"
#include "ros2/ros_peer.h"
#include "ros2/wrench_law.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"
#include "thimble/session/tick_observer.h"

namespace thimble::ros2 {

/// A session's run as ROS 2 topics. In a tick, the servo thread checks for a new force and hand
/// target, if they are enabled, and stores the poses of moving objects at intervals. The peer's
/// thread does the rest.
class RosRun final : public session::TickObserver {
 public:
  /// Opens the topics of one arm of a session. Each of several arms has topics under its name, and
  /// the first publishes the objects. Precondition: the arm is open and no tick has run. The
  /// session must outlive this. `clock`: the session's clock in a stepped run, otherwise null. The
  /// error message has the remedy. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<RosRun>> open(session::Session& session,
                                                      const RosOptions& options,
                                                      std::size_t arm = 0,
                                                      SteppedClock* clock = nullptr);

  /// Takes one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override;

  /// Returns a report on the topics after a run, one line each: problems of messages by name and
  /// number.
  std::string report() const;
  /// Returns the counters so far. Any thread.
  const RosCounts& counts() const noexcept { return channel_.counts; }
  /// Returns the law of the received forces; null if there is none.
  const WrenchLaw* law() const noexcept { return law_.get(); }

 private:
  explicit RosRun(session::Session& session) : session_(session) {}
  bool watches_ticks() const noexcept;

  session::Session& session_;
  RosChannel channel_;
  RosOptions options_;
  bool ends_tick_ = true;  // the arm is the last that the loop serves in a tick
  std::uint64_t targets_taken_ = 0;
  std::uint64_t targets_refused_ = 0;
  const session::PoseRecord* poses_ = nullptr;  // null: no object moves
  std::unique_ptr<WrenchLaw> law_;
  std::unique_ptr<RosPeer> peer_;  // must end before the channel
};

/// Returns the options for one arm of a session. With several arms, each has its name in the
/// namespace and in the frame of its tip.
RosOptions options_of_arm(const session::Session& session, const RosOptions& options,
                          std::size_t arm);

}  // namespace thimble::ros2
