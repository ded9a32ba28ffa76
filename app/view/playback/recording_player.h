#pragma once

#include <memory>
#include <string>
#include <vector>

#include "view/playback/recording_view.h"
#include "view/touch_source.h"

namespace thimble::view {

/// Plays a recording into a window. Real-time: never from the servo thread.
class RecordingPlayer final : public TouchSource {
 public:
  /// Keeps `recording`, which must outlive this. `name` is used for the names of its pictures.
  RecordingPlayer(const RecordingView& recording, std::string name);

  bool step(double dt) override;
  session::SharedReader* reader() override { return nullptr; }
  const DrawnScene& scene() const override { return recording_.scene(); }
  const DrawnMoment& moment() const override { return *moment_; }
  bool has_scene() const override { return true; }
  bool has_moment() const override { return true; }
  const Plots& plots() const override { return recording_.plots(); }
  const std::string& notice() const override { return notice_; }
  std::string name() const override { return name_; }
  PlayHead& head() override { return head_; }
  double time_of_step(int steps) const override {
    return recording_.time_of_step(head_.time(), steps);
  }
  std::string kept() const override { return ""; }
  const std::vector<std::string>& about() const override { return recording_.about(); }

 private:
  const RecordingView& recording_;
  std::string name_;
  std::string notice_;  // empty: the time line shows the state
  PlayHead head_ = PlayHead::of_recording();
  std::unique_ptr<DrawnMoment> moment_ = std::make_unique<DrawnMoment>();
  bool first_ = true;
};

}  // namespace thimble::view
