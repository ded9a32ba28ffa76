#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "body/spring/modal_motion.h"
#include "body/spring/spring_motion.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/integrators/membrane.h"

namespace thimble::studies {
namespace {

using render::SpringScheme;
using Motion = render::SpringMotion<1>;
using Modal = render::ModalMotion<1>;

constexpr double kFrameTime = 1e-3;  // s
constexpr int kFrames = 60;
constexpr int kWorkFrames = 10;

// A membrane with the stiffness of that in `thimble study integrators`, but fewer nodes, so that
// the finest steps are affordable.
const Membrane& drum() {
  static const Membrane membrane{.n = 10, .poke = 0.03};
  return membrane;
}

using Field = std::vector<double>;

// Returns the true heights at the end of each frame, computed once.
const std::vector<Field>& truth() {
  static const std::vector<Field> fields = [] {
    std::vector<Field> all;
    for (int i = 1; i <= kFrames; ++i) all.push_back(membrane_truth(drum(), i * kFrameTime));
    return all;
  }();
  return fields;
}

bool poked_in(int frame) {
  return frame * kFrameTime < drum().poke - kFrameTime / 2;
}

Motion motion_of(SpringScheme scheme, int substeps) {
  render::SpringMotionOptions options;
  options.scheme = scheme;
  options.step = kFrameTime;
  options.substeps = substeps;
  options.substeps_max = substeps;
  options.rounds_max = 100;
  options.beyond = render::SpringMotionOptions::Beyond::kAllow;
  return Motion::build(membrane_network(drum()), options).value();
}

double height(const Motion& motion, std::int32_t node) {
  return motion.u()[static_cast<std::size_t>(node)][0];
}

/// Divides each frame into equal steps: an exact method stays exact with any step.
class CutModes {
 public:
  explicit CutModes(int pieces)
      : modes_(Modal::build(membrane_network(drum()), kFrameTime / pieces).value()),
        pieces_(pieces) {}
  void push(std::int32_t node, const Modal::Vector& f) {
    node_ = node;
    force_ = f;
  }
  void step() {
    for (int i = 0; i < pieces_; ++i) {
      if (node_ >= 0) modes_.push(node_, force_);
      modes_.step();
    }
    node_ = -1;
  }
  double height(std::int32_t node) const { return modes_.u(node)[0]; }

 private:
  Modal modes_;
  int pieces_;
  std::int32_t node_ = -1;
  Modal::Vector force_ = Modal::Vector::Zero();
};

double height(const CutModes& motion, std::int32_t node) {
  return motion.height(node);
}

// Returns the largest error over all nodes and frames, relative to the largest height, in percent.
template <class Any>
double error_of(Any motion) {
  double error = 0;
  double size = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (poked_in(frame)) motion.push(drum().poked(), Motion::Vector(drum().force));
    motion.step();
    const Field& heights = truth()[static_cast<std::size_t>(frame)];
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const double off = std::abs(height(motion, static_cast<std::int32_t>(i)) - heights[i]);
      if (!(off < 1e3)) return NAN;
      error = std::max(error, off);
      size = std::max(size, std::abs(heights[i]));
    }
  }
  return error < 10 * size ? 100 * error / size : NAN;
}

// Continues from the state of the last stroke: pushed for half of a stroke, then released.
template <class Any>
Stroke work_of(Any motion) {
  const auto kept = std::make_shared<Any>(std::move(motion));
  return [kept] {
    double sum = 0;
    for (int frame = 0; frame < kWorkFrames; ++frame) {
      if (2 * frame < kWorkFrames) kept->push(drum().poked(), Motion::Vector(drum().force));
      kept->step();
      sum += height(*kept, drum().poked());
    }
    return sum;
  };
}

struct Scheme {
  const char* name;
  const char* title;
  SpringScheme scheme;
  double order;
  int finest;  // substeps
};

constexpr Scheme kSchemes[] = {
    {"symplectic", "symplectic Euler", SpringScheme::kSymplecticEuler, 1, 128},
    {"verlet", "Verlet", SpringScheme::kVerlet, 2, 128},
    {"implicit", "implicit Euler", SpringScheme::kImplicitEuler, 1, 512},
    {"trapezoid", "trapezoid", SpringScheme::kTrapezoid, 2, 128},
    {"explicit", "explicit Euler", SpringScheme::kExplicitEuler, 1, 1024},
};

}  // namespace

AccuracyAxis deformable_axis() {
  AccuracyAxis axis;
  axis.name = "deformable";
  axis.title = "Integrators of a deformable body: a membrane of 10 x 10 nodes, poked for 30 ms";
  axis.knob = "time of a sub-step";
  axis.knob_unit = "us";
  axis.metric = "largest error of all nodes and frames";
  axis.unit = "% of the largest motion";
  axis.truth = "The sum of all sine modes of the membrane, each in closed form.";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of force (3.5 %)";
  axis.default_words =
      "Implicit Euler with one step per tick is stable at any stiffness, mass and "
      "step, and comes to rest. Its error is in the frequency of the oscillation "
      "after a poke, not in the depth of a dent under a steady hand. Of the cheaper "
      "methods, symplectic Euler and Verlet diverge if the body is stiffer. The "
      "trapezoid is stable, cheaper and more accurate, but modes too fast for its "
      "step ring. --quality auto and reference use it with finer steps.";
  axis.left_out =
      "XPBD is not in the product: when it has converged it equals implicit Euler, "
      "and a single iteration of it is both slower and less accurate. For scanned "
      "meshes see `thimble study integrators`.";
  for (const Scheme& scheme : kSchemes) {
    AccuracyLine line{
        .name = scheme.name, .title = scheme.title, .order = scheme.order, .points = {}};
    const int first = scheme.scheme == SpringScheme::kExplicitEuler ? 16 : 1;
    for (int substeps = first; substeps <= scheme.finest; substeps *= 2) {
      const SpringScheme which = scheme.scheme;
      line.points.push_back({.name = std::to_string(substeps),
                             .knob = 1e6 * kFrameTime / substeps,
                             .error = [=] { return error_of(motion_of(which, substeps)); },
                             .prepare = [=] { return work_of(motion_of(which, substeps)); },
                             .ticks = kWorkFrames,
                             .is_default = which == render::kDefaultScheme && substeps == 1,
                             .fits = substeps * 16 > scheme.finest,
                             .law = {}});
    }
    axis.lines.push_back(std::move(line));
  }
  AccuracyLine modal{
      .name = "modal", .title = "modes, exact", .order = {}, .exact = true, .points = {}};
  for (int pieces = 1; pieces <= 16; pieces *= 2) {
    modal.points.push_back({.name = std::to_string(pieces),
                            .knob = 1e6 * kFrameTime / pieces,
                            .error = [=] { return error_of(CutModes(pieces)); },
                            .prepare = [=] { return work_of(CutModes(pieces)); },
                            .ticks = kWorkFrames,
                            .law = {}});
  }
  axis.lines.push_back(std::move(modal));
  return axis;
}

}  // namespace thimble::studies
