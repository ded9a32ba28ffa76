#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "body/motion/rigid_body.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/free_spin.h"

namespace thimble::studies {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kTime = 1;  // s
constexpr int kWorkRuns = 10;

const FreeSpin& spin() {
  static const FreeSpin one;
  return one;
}

enum class Method { kEuler, kMidpoint, kRungeKutta };

/// Spins by Euler's equations and the quaternion's derivative, with textbook integrators.
class Textbook {
 public:
  Textbook(Method method, double step) : method_(method), h_(step), w_(spin().omega) {}
  void step() noexcept {
    const State k1 = rate(q_, w_);
    if (method_ == Method::kEuler) {
      go(k1, h_);
      return;
    }
    const State k2 = rate(ahead(q_, k1.q, h_ / 2), w_ + h_ / 2 * k1.w);
    if (method_ == Method::kMidpoint) {
      go(k2, h_);
      return;
    }
    const State k3 = rate(ahead(q_, k2.q, h_ / 2), w_ + h_ / 2 * k2.w);
    const State k4 = rate(ahead(q_, k3.q, h_), w_ + h_ * k3.w);
    go({(k1.q + 2 * k2.q + 2 * k3.q + k4.q) / 6, (k1.w + 2 * k2.w + 2 * k3.w + k4.w) / 6}, h_);
  }
  Vector3d rate_in_body() const noexcept { return w_; }

 private:
  struct State {
    Eigen::Vector4d q;
    Vector3d w;
  };
  static Quaterniond ahead(const Quaterniond& q, const Eigen::Vector4d& rate,
                           double time) noexcept {
    return Quaterniond(Eigen::Vector4d(q.coeffs() + time * rate)).normalized();
  }
  static State rate(const Quaterniond& q, const Vector3d& w) noexcept {
    const Vector3d& I = spin().inertia;
    const Quaterniond turn = q * Quaterniond(0, w.x(), w.y(), w.z());
    return {0.5 * turn.coeffs(), Vector3d(-w.cross(Vector3d(I.cwiseProduct(w))).cwiseQuotient(I))};
  }
  void go(const State& rate, double time) noexcept {
    q_ = ahead(q_, rate.q, time);
    w_ += time * rate.w;
  }

  Method method_;
  double h_;
  Quaterniond q_ = Quaterniond::Identity();
  Vector3d w_;
};

/// Spins by the product's rigid body.
class Product {
 public:
  explicit Product(double step) : body_(build()), h_(step) {}
  void step() noexcept { body_.step(h_); }
  Vector3d rate_in_body() const noexcept { return body_.q_WB().conjugate() * body_.omega_W(); }

 private:
  static render::RigidBody build() {
    render::RigidBodySettings settings;
    settings.mass.mass = 0.1;
    settings.mass.inertia = spin().inertia;
    render::RigidBody body = render::RigidBody::build(settings).value();  // valid settings
    body.set_momentum({0, 0, 0}, spin().inertia.cwiseProduct(spin().omega));
    return body;
  }
  render::RigidBody body_;
  double h_;
};

// Returns the largest error of the angular velocity within kTime, in percent of it.
template <class Any>
double error_of(Any motion, double step) {
  const auto steps = static_cast<int>(std::lround(kTime / step));
  // Compares 50 times, at times that are multiples of every step.
  const int stride = std::max(steps / 50, 1);
  double error = 0;
  for (int i = 1; i <= steps; ++i) {
    motion.step();
    if (i % stride != 0) continue;
    const double off = (motion.rate_in_body() - true_rate(spin(), i * step)).norm();
    if (!(off < 1e3)) return NAN;
    error = std::max(error, off);
  }
  return 100 * error / spin().omega.norm();
}

// Repeats the same second several times: later, explicit Euler would overflow.
template <class Any>
Stroke work_of(const Any& rest, double step) {
  return [rest, steps = static_cast<int>(std::lround(kTime / step))] {
    double sum = 0;
    for (int i = 0; i < kWorkRuns; ++i) {
      Any motion = rest;
      for (int k = 0; k < steps; ++k) motion.step();
      sum += motion.rate_in_body().x();
    }
    return sum;
  };
}

struct Line {
  Method method;
  const char* name;
  const char* title;
  double order;
};

constexpr double kSteps_ms[] = {20, 10, 5, 2, 1, 0.5, 0.25};

}  // namespace

AccuracyAxis rigid_body_axis() {
  AccuracyAxis axis;
  axis.name = "rigid_body";
  axis.title = "Integrators of a rigid body that tumbles freely about its intermediate axis";
  axis.knob = "time of a step";
  axis.knob_unit = "ms";
  axis.metric = "largest error of the turning rate in 1 s";
  axis.unit = std::string("%");
  axis.truth = "Jacobi elliptic functions, the closed form of the free spin.";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of force (3.5 %)";
  axis.per = "ms of touch";
  axis.default_words =
      "It conserves the angular momentum to rounding at any step, which no textbook "
      "method does. It takes one step per tick, so that the hand is never a tick "
      "late.";
  axis.left_out = "Contacts of the body with its floor, which are tested only by their energy.";
  const Line lines[] = {{Method::kEuler, "euler", "explicit Euler", 1},
                        {Method::kMidpoint, "midpoint", "midpoint", 2},
                        {Method::kRungeKutta, "rk4", "RK4", 4}};
  for (const Line& one : lines) {
    AccuracyLine line{.name = one.name, .title = one.title, .order = one.order};
    for (const double ms : kSteps_ms) {
      const Method method = one.method;
      AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * ms)) + "us",
                          .knob = ms,
                          .error = [=] { return error_of(Textbook(method, ms / 1e3), ms / 1e3); },
                          .prepare = [=] { return work_of(Textbook(method, ms / 1e3), ms / 1e3); }};
      point.ticks = kWorkRuns * 1e3 * kTime;
      point.fits = one.order > 3 ? ms <= 5 && ms >= 0.5 : ms <= 2;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  AccuracyLine product{.name = "split", .title = "split turns, order 4 (product)", .order = 4};
  for (const double ms : kSteps_ms) {
    AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * ms)) + "us",
                        .knob = ms,
                        .error = [=] { return error_of(Product(ms / 1e3), ms / 1e3); },
                        .prepare = [=] { return work_of(Product(ms / 1e3), ms / 1e3); }};
    point.ticks = kWorkRuns * 1e3 * kTime;
    point.is_default = ms == 1;
    point.fits = ms <= 10 && ms >= 1;
    product.points.push_back(std::move(point));
  }
  axis.lines.push_back(std::move(product));
  return axis;
}

}  // namespace thimble::studies
