#include "view/compare/signal_curve.h"

#include <utility>

namespace thimble::view {

SignalCurve::SignalCurve(std::shared_ptr<const std::vector<double>> time, std::vector<float> values)
    : time_(std::move(time)), values_(std::move(values)), blocks_(values_.size() / kBlock + 1) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    blocks_[i / kBlock].add({values_[i], values_[i]});
  }
}

Extent SignalCurve::extent(std::size_t from, std::size_t to) const {
  Extent extent;
  for (std::size_t i = from; i < to;) {
    if (i % kBlock == 0 && i + kBlock <= to) {
      extent.add(blocks_[i / kBlock]);
      i += kBlock;
    } else {
      extent.add({values_[i], values_[i]});
      ++i;
    }
  }
  return extent;
}

}  // namespace thimble::view
