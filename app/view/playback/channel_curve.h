#pragma once

#include "view/playback/plots.h"

namespace thimble::view {

/// One channel of the ticks of a run as a curve. Real-time: never from the servo thread.
class ChannelCurve final : public Curve {
 public:
  using Curve::extent;

  /// Keeps `plots`, which must outlive this. `offset`: by how much the times of `plots` are later
  /// than the drawn axis, s.
  ChannelCurve(const Plots& plots, Channel channel, double offset = 0)
      : plots_(plots), channel_(channel), offset_(offset) {}

  std::size_t size() const override { return plots_.size(); }
  double time(std::size_t i) const override { return plots_.time(i) - offset_; }
  float value(std::size_t i) const override { return plots_.value(channel_, i); }
  Extent extent(std::size_t from, std::size_t to) const override {
    return plots_.extent(channel_, from, to);
  }

 private:
  const Plots& plots_;
  Channel channel_;
  double offset_;
};

}  // namespace thimble::view
