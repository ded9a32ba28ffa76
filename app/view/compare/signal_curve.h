#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "view/compare/signal_file.h"
#include "view/playback/curve.h"

namespace thimble::view {

/// One of the user's own signals as a curve. Extents of blocks are computed once, so that millions
/// of values are drawn fast. Real-time: never from the servo thread.
class SignalCurve final : public Curve {
 public:
  using Curve::extent;

  /// Takes the values of a signal, one for each time, s. Precondition: at least one.
  SignalCurve(std::shared_ptr<const std::vector<double>> time, std::vector<float> values);

  std::size_t size() const override { return values_.size(); }
  double time(std::size_t i) const override { return (*time_)[i]; }
  float value(std::size_t i) const override { return values_[i]; }
  Extent extent(std::size_t from, std::size_t to) const override;

 private:
  static constexpr std::size_t kBlock = 64;

  std::shared_ptr<const std::vector<double>> time_;
  std::vector<float> values_;
  std::vector<Extent> blocks_;
};

}  // namespace thimble::view
