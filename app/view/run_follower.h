#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "share/run_attachment.h"
#include "view/live_scene.h"
#include "view/overlays/tip_trail.h"
#include "view/playback/moment_ring.h"
#include "view/touch_source.h"

namespace thimble::view {

/// Keeps the newest moment of the runs that are followed, one after the other, and the moments of
/// the last minute. Real-time: never from the servo thread.
class RunFollower final : public TouchSource {
 public:
  /// Keeps `runs`, which must outlive this.
  explicit RunFollower(session::RunAttachment& runs) : runs_(runs) {}

  bool step(double dt) override;
  session::SharedReader* reader() override { return runs_.reader(); }
  const DrawnScene& scene() const override { return live_->scene(); }
  const DrawnMoment& moment() const override { return head_.live() ? *newest_ : *then_; }
  bool has_scene() const override { return live_ != nullptr; }
  bool has_moment() const override { return has_moment_; }
  const Plots& plots() const override { return plots_; }
  const std::string& notice() const override { return notice_; }
  std::string name() const override { return runs_.reader() == nullptr ? "" : runs_.name(); }
  PlayHead& head() override { return head_; }
  double time_of_step(int steps) const override {
    return ring_.empty() ? 0 : ring_.time_of_step(head_.time(), steps);
  }
  std::string kept() const override;
  const std::vector<std::string>& about() const override { return about_; }

 private:
  session::RunAttachment& runs_;
  std::unique_ptr<LiveScene> live_;
  std::unique_ptr<DrawnMoment> newest_ = std::make_unique<DrawnMoment>();
  // the kept moment that is shown
  std::unique_ptr<DrawnMoment> then_ = std::make_unique<DrawnMoment>();
  bool has_moment_ = false;
  MomentRing ring_;
  PlayHead head_ = PlayHead::of_run();
  Plots plots_;
  TipTrail trail_;
  std::uint64_t serial_ = 0;
  std::vector<driver::TickRecord> ticks_;
  std::string notice_;
  std::vector<std::string> about_;  // empty: no description
};

}  // namespace thimble::view
