#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "observers/body_trace.h"
#include "observers/dent_trace.h"
#include "recording/replay_animation.h"
#include "report/html/outline_trace.h"
#include "report/html/page_marks.h"
#include "report/html/shape_trace.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::report {

/// Data for the page of a run that a session does not keep: poses of moving objects and events of
/// its arms. If the session keeps only every n-th tick, also the outline of the run. It observes
/// the run's ticks.
class RunPage {
 public:
  /// Observes a session whose arm is open and which has had no tick; it must outlive the run.
  /// Real-time: never from the servo thread.
  explicit RunPage(session::Session& session);

  /// Ends the observation, after the run and before the next one. Real-time: never from the servo
  /// thread.
  void finish();

  /// Returns ticks that represent an arm's run, with every peak, oldest first. After `finish`.
  std::span<const driver::TickRecord> ticks(std::size_t arm) const noexcept;

  /// Writes the page (write_page) of the finished run; `grant` is the priority that the kernel
  /// granted to the servo thread. Call once. Real-time: never from the servo thread.
  driver::Result<void> write(const driver::RealTimeGrant& grant, const std::filesystem::path& file);

 private:
  session::Session& session_;
  std::unique_ptr<session::BodyTrace> bodies_;  // null if nothing moves
  std::unique_ptr<session::DentTrace> dents_;   // null if nothing dents
  std::unique_ptr<ShapeTrace> shapes_;          // null if nothing is permanently deformed
  std::vector<std::unique_ptr<EventKeeper>> events_;
  std::vector<std::unique_ptr<OutlineTrace>> outlines_;  // one per arm; empty if every tick is kept
};

/// Records a replay for animation, and writes its page.
class ReplayPage final : public session::ReplayAnimation {
 public:
  void begin(const scene::Scene& scene,
             std::shared_ptr<const scene::SceneObjects> objects) override;
  void take(const driver::TickRecord& tick) override;
  /// Writes the page (write_page) of finished replays. Real-time: never from the servo thread.
  driver::Result<void> write(std::span<const session::Replay> replays,
                             const std::filesystem::path& file);

 private:
  std::unique_ptr<ShapeTrace> shapes_;  // null if nothing is permanently deformed
};

}  // namespace thimble::report
