#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "collision/collide_objects.h"
#include "math/elementary.h"
#include "studies/accuracy/axes/axes.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/scene/scene_file.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;  // s
constexpr double kGravity = 9.81;

/// Bodies that meet without a hand.
class Scene {
 public:
  /// Adds a body of this shape, and returns its number.
  int add(const render::Primitive& shape_W, const render::MotionChoice& motion,
          const render::CollisionChoice& collision = {}) {
    shapes_.push_back(
        std::make_unique<Shape>(Shape{shape_W, scene::SceneShape{.shape_W = shape_W}.mesh_W()}));
    render::CollidingObject& object = objects_.emplace_back();
    object.name = "body";
    object.solid = {&shapes_.back()->mesh_W, &shapes_.back()->shape_W};
    object.motion = motion;
    object.collision = collision;
    object.coupling.step = kTick;
    object.surfaces.push_back(render::build_primitive_touch(shape_W, {}));  // never touched
    return static_cast<int>(objects_.size()) - 1;
  }
  void add_joint(const render::JointChoice& choice, int a) { joints_.push_back({choice, a, -1}); }

  /// Builds the bodies with a step of the solver of `ms`; the reason if this build has none.
  driver::Result<render::CollidingTouches> build(double ms) {
    render::CollisionQuality quality;
    quality.every = static_cast<std::size_t>(std::lround(std::max(ms, 1.0)));
    quality.substeps = static_cast<std::size_t>(std::lround(std::max(1 / ms, 1.0)));
    return render::collide_objects(std::move(objects_), joints_, quality, 1);
  }

 private:
  struct Shape {
    render::Primitive shape_W;
    render::TriangleMesh mesh_W;
  };
  std::vector<std::unique_ptr<Shape>> shapes_;
  std::vector<render::CollidingObject> objects_;
  std::vector<render::ObjectJoint> joints_;
};

/// One experiment: bodies, how long they move, and the error of their places.
struct Experiment {
  const char* name;
  const char* title;
  double time;                  // s
  std::optional<double> order;  // empty where the error does not follow one
  Scene (*make)();
  double (*error)(const render::CollidingTouches& now);  // percent
};

Vector3d place_of(const render::CollidingTouches& now, std::size_t body) {
  const auto p = now.touches[body][0]->pose().p_WB;
  return {p[0], p[1], p[2]};
}

render::MotionChoice rigid(double mass, double gravity = 0) {
  render::MotionChoice motion{.kind = render::MotionKind::kRigid, .mass = mass};
  motion.gravity_W = {0, 0, -gravity};
  return motion;
}

// A ball of 0.1 kg at 0.8 m/s meets one of 0.2 kg with restitution 0.5.
constexpr double kImpactTime = 0.25, kSpeed = 0.8, kGap = 0.061;
Scene make_impact() {
  Scene scene;
  render::MotionChoice fast = rigid(0.1);
  fast.v_W = {kSpeed, 0, 0};
  scene.add(render::Sphere{{0, 0, 0}, 0.02}, fast, {.restitution = 0.5});
  scene.add(render::Sphere{{0.04 + kGap, 0, 0}, 0.02}, rigid(0.2));
  return scene;
}
double impact_error(const render::CollidingTouches& now) {
  // The first ball stops, the second leaves with half of the speed.
  const double way = 0.5 * kSpeed * (kImpactTime - kGap / kSpeed);
  const double off = std::abs(place_of(now, 0).x() - kGap) + std::abs(place_of(now, 1).x() - way);
  return 100 * off / way;
}

// A block at 0.5 m/s slides to rest on a floor with friction 0.3.
constexpr double kSlideTime = 0.3;
Scene make_slide() {
  Scene scene;
  render::MotionChoice motion = rigid(0.1, kGravity);
  motion.v_W = {0.5, 0, 0};
  motion.floor = render::Floor{.n_W = {0, 0, 1}, .height = -0.01, .friction = 0.3};
  render::WedgeBox box;
  box.half_sides = {0.03, 0.02, 0.01};
  scene.add(box, motion);
  return scene;
}
double slide_error(const render::CollidingTouches& now) {
  const double way = 0.5 * 0.5 / (2 * 0.3 * kGravity);
  return 100 * std::abs(place_of(now, 0).x() - way) / way;
}

// A rod swings at a hinge from 1 rad.
constexpr double kSwingTime = 1, kRodHalf = 0.05, kAmplitude = 1;
Scene make_swing() {
  Scene scene;
  render::WedgeBox rod;
  rod.half_sides = {0.005, 0.005, kRodHalf};
  rod.R_WO = Eigen::AngleAxisd(kAmplitude, -Vector3d::UnitY()).toRotationMatrix();
  rod.p_WO = rod.R_WO * Vector3d(0, 0, -kRodHalf);
  const int body = scene.add(rod, rigid(0.1, kGravity));
  render::JointChoice hinge;
  hinge.axis_W = {0, 1, 0};
  scene.add_joint(hinge, body);
  return scene;
}
/// Returns the angle of the swinging rod after kSwingTime, rad: by classic Runge-Kutta with steps
/// of 10 us, whose error is below 1e-12.
double swung_angle() {
  const double per_mass = (0.005 * 0.005 + kRodHalf * kRodHalf) / 3 + kRodHalf * kRodHalf;
  const double rate = kGravity * kRodHalf / per_mass, h = 1e-5;
  double angle = kAmplitude, speed = 0;
  const auto pull = [rate](double at) { return -rate * math::sin_cos(at).sine; };
  const auto steps = static_cast<int>(std::lround(kSwingTime / h));
  for (int i = 0; i < steps; ++i) {
    const double v1 = speed, a1 = pull(angle);
    const double v2 = speed + h / 2 * a1, a2 = pull(angle + h / 2 * v1);
    const double v3 = speed + h / 2 * a2, a3 = pull(angle + h / 2 * v2);
    const double v4 = speed + h * a3, a4 = pull(angle + h * v3);
    angle += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    speed += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return angle;
}
double swing_error(const render::CollidingTouches& now) {
  static const double truth = swung_angle();
  const auto q = now.touches[0][0]->pose().q_WB;
  // The rod has turned from its first place about -y.
  const double turned = -2 * math::atan2(q[2], q[0]);
  const double off = std::remainder(kAmplitude + turned - truth, 2 * std::numbers::pi);
  return 100 * std::abs(off) / kAmplitude;
}

// Ten blocks stand on each other; the error is how far the uppermost sinks, of its side.
constexpr double kStackTime = 1;
constexpr int kBlocks = 10;
Scene make_stack() {
  Scene scene;
  render::MotionChoice motion = rigid(0.02, kGravity);
  motion.floor = render::Floor{.n_W = {0, 0, 1}, .height = 0, .friction = 0.5};
  for (int i = 0; i < kBlocks; ++i) {
    render::WedgeBox box;
    box.half_sides = Vector3d::Constant(0.01);
    box.p_WO = {0, 0, 0.02 * i + 0.01};
    scene.add(box, motion);
  }
  return scene;
}
double stack_error(const render::CollidingTouches& now) {
  return 100 * place_of(now, kBlocks - 1).norm() / 0.02;
}

constexpr Experiment kExperiments[] = {
    {"impact", "two balls meet", kImpactTime, {}, make_impact, impact_error},
    {"slide", "a block slides to rest", kSlideTime, 1, make_slide, slide_error},
    {"swing", "a rod swings at a hinge", kSwingTime, 1, make_swing, swing_error},
    {"stack", "ten blocks stand", kStackTime, {}, make_stack, stack_error},
};

constexpr double kSteps_ms[] = {8, 4, 2, 1, 0.5, 0.25, 0.125};

void run(render::CollidingTouches& bodies, double time) {
  const auto ticks = std::lround(time / kTick);
  for (long i = 0; i < ticks; ++i) bodies.bodies->step(kTick);
}

/// Returns the error after the experiment; NaN if this build has no solver.
double error_of(const Experiment& experiment, double ms) {
  auto bodies = experiment.make().build(ms);
  if (!bodies) return NAN;
  run(*bodies, experiment.time);
  return experiment.error(*bodies);
}

Stroke work_of(const Experiment& experiment, double ms) {
  return [&experiment, ms] { return error_of(experiment, ms); };
}

/// Returns the work without motion: the making of the bodies.
Stroke making_of(const Experiment& experiment, double ms) {
  return [&experiment, ms] {
    const auto bodies = experiment.make().build(ms);
    return bodies ? bodies->bodies->momentum_W().x() : NAN;
  };
}

}  // namespace

AccuracyAxis collisions_axis() {
  AccuracyAxis axis;
  axis.name = "collisions";
  axis.title = "Bodies that meet: step of collisions and joints";
  axis.knob = "time of a step";
  axis.knob_unit = "ms";
  axis.metric = "error of the bodies' places";
  axis.unit = std::string("%");
  axis.truth =
      "Closed forms of the impact, of sliding and of the stack at rest; the swing by Runge-Kutta "
      "with steps of 10 us.";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of force (3.5 %)";
  axis.per = "ms of touch";
  axis.default_words =
      "One step per tick, so that the hand is never a tick late. Larger steps (`every`) are for "
      "scenes of many bodies, smaller ones (`substeps`) for exact ones.";
  axis.left_out =
      "The hand: with larger steps its pushes act in each tick, but their effect on "
      "other bodies waits for the next step.";
  for (const Experiment& experiment : kExperiments) {
    AccuracyLine line{
        .name = experiment.name, .title = experiment.title, .order = experiment.order};
    for (const double ms : kSteps_ms) {
      AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * ms)) + "us",
                          .knob = ms,
                          .error = [&experiment, ms] { return error_of(experiment, ms); },
                          .prepare = [&experiment, ms] { return work_of(experiment, ms); },
                          .baseline = [&experiment, ms] { return making_of(experiment, ms); }};
      point.ticks = experiment.time / kTick;
      point.fits = ms <= 2;
      // One of the lines shows where the default is.
      point.is_default = ms == 1 && experiment.make == make_slide;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::studies
