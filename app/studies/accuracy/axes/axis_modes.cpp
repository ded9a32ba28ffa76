#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "body/spring/oscillator.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/integrators/membrane.h"

namespace thimble::app {
namespace {

constexpr double kFrameTime = 1e-3;  // s
constexpr int kFrames = 60;
constexpr int kWorkFrames = 200;
constexpr int kNodes = 16;

const Membrane& drum() {
  static const Membrane membrane{.n = kNodes, .poke = 0.03};
  return membrane;
}

/// Moves the slowest modes of the membrane exactly and sees its poked node alone. With `rest`, the
/// modes that are left out follow the force at once, as springs without mass would (the static
/// correction of structural dynamics).
class FewModes {
 public:
  FewModes(int count, bool rest) {
    struct Mode {
      double square, shape;
    };
    std::vector<Mode> modes;
    const double cells = kNodes + 1;
    const int column = drum().poked() % kNodes;
    const int row = drum().poked() / kNodes;
    for (int q = 1; q <= kNodes; ++q) {
      for (int p = 1; p <= kNodes; ++p) {
        const double sp = std::sin(std::numbers::pi * p / (2 * cells));
        const double sq = std::sin(std::numbers::pi * q / (2 * cells));
        const double shape = 2 / cells * std::sin(std::numbers::pi * p * (column + 1) / cells) *
                             std::sin(std::numbers::pi * q * (row + 1) / cells);
        modes.push_back({4 * drum().stiffness / drum().mass * (sp * sp + sq * sq), shape});
      }
    }
    std::stable_sort(modes.begin(), modes.end(),
                     [](const Mode& a, const Mode& b) { return a.square < b.square; });
    for (std::size_t i = 0; i < modes.size(); ++i) {
      if (static_cast<int>(i) < count) {
        steps_.push_back(render::OscillatorStep::of(1, modes[i].square,
                                                    drum().damping / drum().mass, kFrameTime));
        shapes_.push_back(modes[i].shape);
      } else if (rest) {
        give_ += modes[i].shape * modes[i].shape / (modes[i].square * drum().mass);
      }
    }
    x_.resize(steps_.size());
    v_.resize(steps_.size());
  }

  /// Moves on by a frame under `force` (N) at the poked node and tells its height, m.
  double step(double force) noexcept {
    double height = give_ * force;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      steps_[i].apply(x_[i], v_[i], shapes_[i] * force / drum().mass);
      height += shapes_[i] * x_[i];
    }
    return height;
  }

 private:
  std::vector<render::OscillatorStep> steps_;
  std::vector<double> shapes_, x_, v_;
  double give_ = 0;  // of all modes left out, m/N
};

// The error of the height under a hand that presses and lets go within 30 ms each, softly enough
// that what is left out can follow; in percent of the largest height. All modes are the truth.
double error_of(int count, bool rest) {
  FewModes few(count, rest);
  FewModes all(kNodes * kNodes, false);
  double error = 0;
  double size = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double s = std::sin(std::numbers::pi * (frame + 1) / kFrames);
    const double force = drum().force * s * s;
    const double truth = all.step(force);
    error = std::max(error, std::abs(few.step(force) - truth));
    size = std::max(size, std::abs(truth));
  }
  return 100 * error / size;
}

AccuracyLine line_of(bool rest) {
  AccuracyLine line{.name = rest ? "with_rest" : "slowest",
                    .title = rest ? "slowest modes, the rest as springs" : "slowest modes alone",
                    .order = {},
                    .points = {}};
  for (const int count : {1, 4, 8, 16, 32, 64, 128, 192, 256}) {
    line.points.push_back({.name = std::to_string(count),
                           .knob = static_cast<double>(count),
                           .error = [=] { return error_of(count, rest); },
                           .prepare = [=]() -> Stroke {
                             const auto few = std::make_shared<FewModes>(count, rest);
                             return [few] {
                               double sum = 0;
                               for (int i = 0; i < kWorkFrames; ++i) {
                                 sum += few->step(2 * i < kWorkFrames ? drum().force : 0);
                               }
                               return sum;
                             };
                           },
                           .ticks = kWorkFrames,
                           .is_default = !rest && count == kNodes * kNodes,
                           .law = {}});
  }
  return line;
}

}  // namespace

AccuracyAxis modes_axis() {
  AccuracyAxis axis;
  axis.name = "modes";
  axis.title = "How many modes of a deformable body are needed: the membrane's touched node";
  axis.knob = "modes moved";
  axis.metric = "largest error of the touched node";
  axis.unit = "% of the largest motion";
  axis.truth = "All 256 modes of the membrane, each exact.";
  axis.threshold = 3.5;
  axis.threshold_words = "half the change of force that is felt (3.5 %)";
  axis.default_words =
      "The product moves all modes of what it moves by modes, for which nobody has to choose; a "
      "body with too many for that is moved by implicit Euler on the patch around the hand.";
  axis.left_out =
      "Finding the modes (once, when the scene is loaded), and looks at nodes that are not "
      "touched, "
      "which cost as much again each.";
  axis.lines = {line_of(false), line_of(true)};
  return axis;
}

}  // namespace thimble::app
