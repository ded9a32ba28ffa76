#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "body/spring/oscillator.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/integrators/membrane.h"

namespace thimble::studies {
namespace {

constexpr double kFrameTime = 1e-3;  // s
constexpr int kFrames = 60;
constexpr int kWorkFrames = 200;
constexpr int kNodes = 16;

const Membrane& drum() {
  static const Membrane membrane{.n = kNodes, .poke = 0.03};
  return membrane;
}

/// Moves the slowest modes of the membrane exactly, with only its pushed node as output. With
/// `rest`, the omitted modes follow the force statically, like massless springs (the static
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
        compliance_ += modes[i].shape * modes[i].shape / (modes[i].square * drum().mass);
      }
    }
    x_.resize(steps_.size());
    v_.resize(steps_.size());
  }

  /// Advances by a frame under `force` (N) at the pushed node and returns its height, m.
  double step(double force) noexcept {
    double height = compliance_ * force;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      steps_[i].apply(x_[i], v_[i], shapes_[i] * force / drum().mass);
      height += shapes_[i] * x_[i];
    }
    return height;
  }

 private:
  std::vector<render::OscillatorStep> steps_;
  std::vector<double> shapes_, x_, v_;
  double compliance_ = 0;  // compliance of all omitted modes, m/N
};

// Returns the hand's force in a frame, N. It rises and falls within 30 ms each, smoothly enough for
// the static correction.
double hand_force(int frame) {
  const double s = std::sin(std::numbers::pi * (frame + 1) / kFrames);
  return drum().force * s * s;
}

// Returns the height of the touched node after each frame, m. It uses the dense stiffness matrix,
// assembled spring by spring, its eigenvectors, and the motion of each by its complex root in long
// double. Shares no code with the tested methods.
std::vector<double> dense_heights() {
  constexpr int n = kNodes * kNodes;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  for (int row = 0; row < kNodes; ++row) {
    for (int column = 0; column < kNodes; ++column) {
      const int node = row * kNodes + column;
      K(node, node) = 4 * drum().stiffness;  // four neighbours; for outer nodes the frame
      if (column > 0) K(node, node - 1) = K(node - 1, node) = -drum().stiffness;
      if (row > 0) K(node, node - kNodes) = K(node - kNodes, node) = -drum().stiffness;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K);
  using Complex = std::complex<long double>;
  const long double mass = drum().mass;
  const long double fade = drum().damping / (2 * mass);
  std::vector<long double> heights(kFrames, 0);
  for (int i = 0; i < n; ++i) {
    const long double stiffness = solver.eigenvalues()[i];
    const long double shape = solver.eigenvectors()(drum().poked(), i);
    // x = rest + Re(c e^(r t)) with r = -fade + j w; each frame multiplies c by e^(r h).
    const Complex root(-fade, std::sqrt(stiffness / mass - fade * fade));
    const Complex turn = std::exp(root * static_cast<long double>(kFrameTime));
    long double x = 0, v = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
      const long double rest = shape * hand_force(frame) / stiffness;
      const Complex c(x - rest, -(v + fade * (x - rest)) / root.imag());
      const Complex moved = c * turn;
      x = rest + moved.real();
      v = (root * moved).real();
      heights[static_cast<std::size_t>(frame)] += shape * x;
    }
  }
  return {heights.begin(), heights.end()};
}

// Returns the largest error of the height, in percent of the largest height.
double error_of(int count, bool rest) {
  static const std::vector<double> truth = dense_heights();
  FewModes few(count, rest);
  double error = 0;
  double size = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double height = truth[static_cast<std::size_t>(frame)];
    error = std::max(error, std::abs(few.step(hand_force(frame)) - height));
    size = std::max(size, std::abs(height));
  }
  return 100 * error / size;
}

AccuracyLine line_of(bool rest) {
  AccuracyLine line{.name = rest ? "with_rest" : "slowest",
                    .title = rest ? "slowest modes, the rest as springs" : "slowest modes only",
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
  axis.title = "Number of modes of a deformable body: error at the touched node of a membrane";
  axis.knob = "number of modes";
  axis.metric = "largest error of the touched node";
  axis.unit = "% of the largest motion";
  axis.truth =
      "All 256 modes, from the eigenvalues of the dense stiffness matrix, each "
      "computed from its complex root in long double.";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of force (3.5 %)";
  axis.default_words =
      "The product always uses all modes of a body, so there is no choice to make. A "
      "body with too many modes is integrated by implicit Euler on the patch around "
      "the hand.";
  axis.left_out =
      "The computation of the modes (once, when the scene is loaded). Positions of "
      "other nodes, each of which costs as much as the touched one.";
  axis.lines = {line_of(false), line_of(true)};
  return axis;
}

}  // namespace thimble::studies
