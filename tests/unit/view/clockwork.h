#pragma once

#include <memory>
#include <string>
#include <vector>

#include "view/touch_source.h"

namespace thimble::view {

/// A source in which only the time advances; the test sets scene, moment and run.
class Clockwork final : public TouchSource {
 public:
  explicit Clockwork(PlayHead head, session::SharedReader* reader = nullptr)
      : head_(head), reader_(reader) {}
  bool step(double dt) override {
    head_.step(dt);
    return false;
  }
  session::SharedReader* reader() override { return reader_; }
  const DrawnScene& scene() const override { return scene_; }
  const DrawnMoment& moment() const override { return *moment_; }
  bool has_scene() const override { return true; }
  bool has_moment() const override { return true; }
  const Plots& plots() const override { return plots_; }
  const std::string& notice() const override { return notice_; }
  std::string name() const override { return "clockwork"; }
  PlayHead& head() override { return head_; }
  double time_of_step(int steps) const override { return head_.time() + 0.001 * steps; }
  std::string kept() const override { return ""; }
  const std::vector<std::string>& about() const override { return about_; }

  /// Return the displayed data, for changes.
  DrawnScene& shown_scene() { return scene_; }
  DrawnMoment& shown_moment() { return *moment_; }

 private:
  PlayHead head_;
  session::SharedReader* reader_;
  DrawnScene scene_;
  std::unique_ptr<DrawnMoment> moment_ = std::make_unique<DrawnMoment>();
  Plots plots_;
  std::string notice_;
  std::vector<std::string> about_;
};

}  // namespace thimble::view
