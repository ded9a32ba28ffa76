#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "body/dent/dent_motion.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/cost/cost_subjects.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using render::DentMotion;
using render::SpringScheme;

constexpr std::int32_t kVertex = 5;
constexpr double kSpring = 50;     // N/m
constexpr double kDented = 0.002;  // m
constexpr double kWorkTicks = 200;

/// A vertex of a soft ring on its spring, without springs to others, displaced by 2 mm and
/// released.
class LetGo {
 public:
  LetGo(double omega_h, double rate, SpringScheme scheme) : motion_(build(omega_h, rate, scheme)) {
    // A very stiff cursor moves the vertex there and holds it.
    for (int i = 0; i < 400; ++i) hold();
    start_ = motion_.u(kVertex).x();
    speed_ = motion_.v(kVertex).x();
    motion_.release();
  }

  double start() const noexcept { return start_; }  ///< Returns the position at release, m.
  double speed() const noexcept { return speed_; }  ///< Returns the speed at release, m/s.
  /// Advances by a tick and returns the position of the vertex, m.
  double step() noexcept {
    motion_.step();
    return motion_.u(kVertex).x();
  }
  /// Moves the vertex to the release position.
  void hold() noexcept {
    const std::int32_t vertex = kVertex;
    motion_.gather({&vertex, 1});
    motion_.pull(
        0, kVertex,
        {.stiffness = HUGE_VAL, .damping = 0, .target = {kDented, 0, 0}, .rate = {0, 0, 0}});
    motion_.step();
  }

 private:
  static DentMotion build(double omega_h, double rate, SpringScheme scheme) {
    // Cannot fail: a ring is closed, and the settings are valid.
    const auto mesh = render::ContactMesh::build(kCostRing.mesh(8, 4)).value();
    render::DentSettings settings;
    settings.stiffness = kSpring;
    settings.damping = 0;
    settings.neighbour_stiffness = 0;
    settings.rings = 0;
    settings.integrator = scheme;
    settings.step = 1 / rate;
    settings.mass = kSpring / (omega_h * omega_h * rate * rate);
    return DentMotion::build(std::make_shared<const render::VertexLinks>(mesh), settings).value();
  }

  DentMotion motion_;
  double start_ = 0, speed_ = 0;
};

// Returns the largest error over half a period, relative to the dent, in percent.
double error_of(double omega_h, double rate, SpringScheme scheme) {
  LetGo vertex(omega_h, rate, scheme);
  double error = 0;
  const int ticks = static_cast<int>(std::lround(std::numbers::pi / omega_h));
  for (int i = 1; i <= ticks; ++i) {
    const double phase = omega_h * i;
    const double truth =
        vertex.start() * std::cos(phase) + vertex.speed() / (omega_h * rate) * std::sin(phase);
    error = std::max(error, std::abs(vertex.step() - truth));
  }
  return 100 * error /
         std::max(std::abs(vertex.start()), std::abs(vertex.speed() / (omega_h * rate)));
}

}  // namespace

AccuracyAxis dent_speed_axis() {
  AccuracyAxis axis;
  axis.name = "dent_speed";
  axis.title = "Dents of high frequency: a vertex on its spring, released";
  axis.knob = "w h, phase per tick";
  axis.knob_unit = "rad";
  axis.metric = "largest error over half a period";
  axis.unit = "% of the dent";
  axis.truth = "The closed form of a mass on a spring.";
  axis.threshold = 7;
  axis.threshold_words = "the noticeable change of force (7 %)";
  axis.default_words =
      "The scene determines the frequency of a dent. Implicit Euler is the default, "
      "because it comes to rest without dampers.";
  axis.left_out = "Springs between vertices: their iterations stop at 1 % of a tick's change.";
  axis.given = true;
  struct Line {
    const char* name;
    const char* title;
    SpringScheme scheme;
    double rate, order;
  };
  for (const Line& kind :
       {Line{"implicit", "implicit Euler, 1 kHz", SpringScheme::kImplicitEuler, 1e3, 1},
        Line{"implicit_20k", "implicit Euler, 20 kHz", SpringScheme::kImplicitEuler, 2e4, 1},
        Line{"trapezoid", "trapezoid, 1 kHz", SpringScheme::kTrapezoid, 1e3, 2},
        Line{"trapezoid_20k", "trapezoid, 20 kHz", SpringScheme::kTrapezoid, 2e4, 2}}) {
    AccuracyLine line{.name = kind.name, .title = kind.title, .order = kind.order, .points = {}};
    for (const double omega_h : {0.3, 0.1, 0.03, 0.01, 0.003, 0.001}) {
      line.points.push_back({.name = std::to_string(omega_h),
                             .knob = omega_h,
                             .error = [=] { return error_of(omega_h, kind.rate, kind.scheme); },
                             .prepare = [=]() -> Stroke {
                               const auto vertex =
                                   std::make_shared<LetGo>(omega_h, kind.rate, kind.scheme);
                               return [vertex] {
                                 double sum = 0;
                                 vertex->hold();
                                 for (int i = 0; i < kWorkTicks; ++i) sum += vertex->step();
                                 return sum;
                               };
                             },
                             .ticks = kWorkTicks,
                             .fits = omega_h <= 0.1 && omega_h >= 0.0029,
                             .law = {}});
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::studies
