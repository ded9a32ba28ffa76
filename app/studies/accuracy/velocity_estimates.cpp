#include "studies/accuracy/velocity_estimates.h"

#include <algorithm>
#include <cmath>

#include "velocity_estimator.h"

namespace thimble::studies {
namespace {

constexpr int kMax = 64;

class ProductEstimate final : public VelocityEstimate {
 public:
  ProductEstimate(double corner, double period) : estimator_(corner), period_(period) {}
  double update(double x) noexcept override { return estimator_.update({x, 0, 0}, period_).x(); }

 private:
  driver::VelocityEstimator estimator_;
  double period_;
};

/// Keeps the last positions in a ring buffer.
class Past {
 public:
  void take(double x) noexcept {
    last_ = (last_ + 1) % (kMax + 1);
    places_[static_cast<std::size_t>(last_)] = x;
    if (size_ < kMax + 1) ++size_;
  }
  int ticks() const noexcept { return size_ - 1; }
  double ago(int ticks) const noexcept {
    return places_[static_cast<std::size_t>((last_ + kMax + 1 - ticks) % (kMax + 1))];
  }

 private:
  std::array<double, kMax + 1> places_{};
  int last_ = 0;
  int size_ = 0;
};

class WindowEstimate final : public VelocityEstimate {
 public:
  WindowEstimate(int ticks, double period) : ticks_(std::clamp(ticks, 1, kMax)), period_(period) {}
  double update(double x) noexcept override {
    past_.take(x);
    const int n = std::min(ticks_, past_.ticks());
    return n > 0 ? (x - past_.ago(n)) / (n * period_) : 0;
  }

 private:
  Past past_;
  int ticks_;
  double period_;
};

class AdaptiveEstimate final : public VelocityEstimate {
 public:
  AdaptiveEstimate(int max, double step, double period)
      : max_(std::clamp(max, 1, kMax)), within_(step / 2 * (1 + 1e-9)), period_(period) {}
  double update(double x) noexcept override {
    past_.take(x);
    const int longest = std::min(max_, past_.ticks());
    double slope = 0;
    for (int n = 1; n <= longest; ++n) {
      const double tried = (x - past_.ago(n)) / n;  // m per tick
      for (int i = 1; i < n; ++i) {
        // NaN ends the window.
        if (!(std::abs(x - tried * i - past_.ago(i)) <= 2 * within_)) return slope / period_;
      }
      slope = tried;
    }
    return slope / period_;
  }

 private:
  Past past_;
  int max_;
  double within_;
  double period_;
};

class LevantEstimate final : public VelocityEstimate {
 public:
  LevantEstimate(double max, double period) : max_(max), period_(period) {}
  double update(double x) noexcept override {
    if (!begun_) place_ = x;
    begun_ = true;
    const double off = place_ - x;
    const double sign = off > 0 ? 1 : off < 0 ? -1 : 0;
    const double speed = speed_ - 1.5 * std::sqrt(max_ * std::abs(off)) * sign;
    speed_ -= 1.1 * max_ * sign * period_;
    place_ += period_ * speed;
    return speed_;
  }

 private:
  double max_, period_;
  double place_ = 0, speed_ = 0;
  bool begun_ = false;
};

}  // namespace

std::unique_ptr<VelocityEstimate> product_estimate(double corner, double period) {
  return std::make_unique<ProductEstimate>(corner, period);
}
std::unique_ptr<VelocityEstimate> window_estimate(int ticks, double period) {
  return std::make_unique<WindowEstimate>(ticks, period);
}
std::unique_ptr<VelocityEstimate> adaptive_estimate(int max, double step, double period) {
  return std::make_unique<AdaptiveEstimate>(max, step, period);
}
std::unique_ptr<VelocityEstimate> levant_estimate(double max, double period) {
  return std::make_unique<LevantEstimate>(max, period);
}

}  // namespace thimble::studies
