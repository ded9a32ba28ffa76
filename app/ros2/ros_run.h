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

/// A session's run as ROS 2 topics. In its tick the servo's thread looks for a force and for a
/// place of the hand, where they are asked for, and keeps the poses of what moves now and then; all
/// else is on the peer's thread.
class RosRun final : public session::TickObserver {
 public:
  /// Puts the topics of one arm of a session onto the wire; of several arms each is a run of its
  /// own, under its name, and the first tells of the objects. Precondition: the arm is open and no
  /// tick has run. The session must outlive the run. `clock`: the session's own, of a run that is
  /// stepped; else null. The error says what to do. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<RosRun>> open(session::Session& session,
                                                      const RosOptions& options,
                                                      std::size_t arm = 0,
                                                      SteppedClock* clock = nullptr);

  /// Takes one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override;

  /// Returns what there is to say of the topics after a run: a line each, what was wrong with
  /// messages by name and number.
  std::string report() const;
  /// Returns what came and went so far. Any thread.
  const RosCounts& counts() const noexcept { return channel_.counts; }
  /// Returns the law of the forces that come; null if none is listened for.
  const WrenchLaw* law() const noexcept { return law_.get(); }

 private:
  explicit RosRun(session::Session& session) : session_(session) {}
  bool watches_ticks() const noexcept;

  session::Session& session_;
  RosChannel channel_;
  RosOptions options_;
  bool ends_tick_ = true;  // the arm is the last that the loop serves in a tick
  std::uint64_t places_taken_ = 0;
  std::uint64_t places_refused_ = 0;
  const session::PoseRecord* poses_ = nullptr;  // null: nothing moves
  std::unique_ptr<WrenchLaw> law_;
  std::unique_ptr<RosPeer> peer_;  // ends before the channel does
};

/// Returns the options for one arm of a session: of several each has its name in the namespace and
/// in the frame of its tip.
RosOptions options_of_arm(const session::Session& session, const RosOptions& options,
                          std::size_t arm);

}  // namespace thimble::ros2
