#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "observers/body_trace.h"
#include "observers/dent_trace.h"
#include "recording/replay_film.h"
#include "report/html/outline_trace.h"
#include "report/html/page_marks.h"
#include "report/html/shape_trace.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::report {

/// What the page of a run needs beyond what a session keeps: where its objects have moved, and what
/// happened to its arms, and the outline of a run of which the session keeps every n-th tick only.
/// It observes the run's ticks.
class RunPage {
 public:
  /// Looks at a session whose arm is open and whose first tick has not come; it must outlive the
  /// run. Real-time: never from the servo thread.
  explicit RunPage(session::Session& session);

  /// Ends the observation, after the run and before what follows. Real-time: never from the servo
  /// thread.
  void finish();

  /// Returns the ticks that stand for an arm's run, with every peak, oldest first. After `finish`.
  std::span<const driver::TickRecord> ticks(std::size_t arm) const noexcept;

  /// Writes the page (write_page) of the run that is over; `grant` is what the kernel granted the
  /// servo's thread. Once. Real-time: never from the servo thread.
  driver::Result<void> write(const driver::RealTimeGrant& grant, const std::filesystem::path& file);

 private:
  session::Session& session_;
  std::unique_ptr<session::BodyTrace> bodies_;  // null if nothing moves
  std::unique_ptr<session::DentTrace> dents_;   // null if nothing dents
  std::unique_ptr<ShapeTrace> shapes_;          // null if nothing is shaped for good
  std::vector<std::unique_ptr<EventKeeper>> events_;
  std::vector<std::unique_ptr<OutlineTrace>> outlines_;  // of each arm; empty if each tick is kept
};

/// The film of a replay, and the page of it.
class ReplayPage final : public session::ReplayFilm {
 public:
  void begin(const scene::Scene& scene,
             std::shared_ptr<const scene::SceneObjects> objects) override;
  void take(const driver::TickRecord& tick) override;
  /// Writes the page (write_page) of replays that are over. Real-time: never from the servo thread.
  driver::Result<void> write(std::span<const session::Replay> replays,
                             const std::filesystem::path& file);

 private:
  std::unique_ptr<ShapeTrace> shapes_;  // null if nothing is shaped for good
};

}  // namespace thimble::report
