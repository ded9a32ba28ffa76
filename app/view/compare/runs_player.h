#pragma once

#include <memory>
#include <string>
#include <vector>

#include "view/compare/recorded_runs.h"
#include "view/touch_source.h"

namespace thimble::view {

/// Plays several recordings and own signals on one time line into a window. Real-time: never from
/// the servo thread.
class RunsPlayer final : public TouchSource {
 public:
  /// Keeps `runs`, which must outlive this. `name` is used for the names of its pictures.
  RunsPlayer(RecordedRuns& runs, std::string name);

  /// Advances the head. Returns true at first, and when another scene is drawn.
  bool step(double dt) override;
  session::SharedReader* reader() override { return nullptr; }
  const DrawnScene& scene() const override { return runs_.scene(); }
  const DrawnMoment& moment() const override { return *moment_; }
  bool has_scene() const override { return true; }
  bool has_moment() const override { return true; }
  const Plots& plots() const override { return runs_.run(runs_.comparison().drawn).plots(); }
  const std::string& notice() const override { return notice_; }
  std::string name() const override { return name_; }
  PlayHead& head() override { return head_; }
  double time_of_step(int steps) const override { return runs_.time_of_step(head_.time(), steps); }
  std::string kept() const override { return ""; }
  const std::vector<std::string>& about() const override { return runs_.about(); }
  Comparison* comparison() override { return &runs_.comparison(); }

 private:
  RecordedRuns& runs_;
  std::string name_;
  std::string notice_;  // empty: the time line shows the state
  PlayHead head_ = PlayHead::of_recording();
  std::unique_ptr<DrawnMoment> moment_ = std::make_unique<DrawnMoment>();
  bool first_ = true;
};

}  // namespace thimble::view
