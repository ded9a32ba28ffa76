// Dents compared with closed forms: their depth, oscillation and decay, from fast to slow and up to
// 20 kHz.
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "body/dent/bendable_polygon.h"
#include "mesh/surface_weights.h"
#include "support/meshes/shapes.h"
#include "support/physics.h"

namespace thimble::render {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using support::expect_physics;

const char* const kDent = "dent";

// A plate of 50 mm whose vertices can all move, and the places where it is pressed.
class Plate {
 public:
  Plate()
      : mesh_(std::make_shared<const ContactMesh>(
            ContactMesh::build(support::plate(0.05, 0.01, 8)).value())) {
    double nearest = HUGE_VAL;
    for (std::int32_t t = 0; t < mesh_->triangle_count(); ++t) {
      const Vector3d middle =
          (mesh_->position(t, 0) + mesh_->position(t, 1) + mesh_->position(t, 2)) / 3;
      const double far = std::hypot(middle.x() - 0.0013, middle.y() - 0.002);
      if (mesh_->cell(t).face.n.z() < 0.9 || far > nearest) continue;
      nearest = far;
      triangle_ = t;
    }
    n_ = mesh_->cell(triangle_).face.n;
  }

  BendablePolygon build(DentSettings settings) const {
    settings.whole = true;
    return BendablePolygon::build(mesh_, settings).value();
  }
  void press(BendablePolygon& dent, double depth) const {
    const Vector3d weights(0.4, 0.35, 0.25);
    dent.touch(triangle_, weights, point_at(*mesh_, triangle_, weights) - depth * n_);
  }
  // Stiffness between all vertices (N/m): springs to the base points and along the edges.
  MatrixXd stiffness(const DentSettings& settings) const {
    std::map<std::pair<int, int>, bool> edges;
    std::vector<int> valence(static_cast<std::size_t>(mesh_->vertex_count()));
    for (std::int32_t t = 0; t < mesh_->triangle_count(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = mesh_->corners(t)[k], b = mesh_->corners(t)[(k + 1) % 3];
        edges[{std::min(a, b), std::max(a, b)}] = true;
      }
    }
    for (const auto& [edge, there] : edges) {
      ++valence[static_cast<std::size_t>(edge.first)];
      ++valence[static_cast<std::size_t>(edge.second)];
    }
    const int n = mesh_->vertex_count();
    MatrixXd K = settings.stiffness * MatrixXd::Identity(n, n);
    for (const auto& [edge, there] : edges) {
      const auto [a, b] = edge;
      // The same strength around a vertex at every valence: relative to a valence of 6.
      const double k =
          settings.neighbour_stiffness * 12 /
          (valence[static_cast<std::size_t>(a)] + valence[static_cast<std::size_t>(b)]);
      K(a, a) += k;
      K(b, b) += k;
      K(a, b) -= k;
      K(b, a) -= k;
    }
    return K;
  }
  VectorXd displacements(const BendablePolygon& dent) const {
    VectorXd u(mesh_->vertex_count());
    for (int i = 0; i < u.size(); ++i) u(i) = dent.motion().u(i).dot(n_);
    return u;
  }
  VectorXd velocities(const BendablePolygon& dent) const {
    VectorXd v(mesh_->vertex_count());
    for (int i = 0; i < v.size(); ++i) v(i) = dent.motion().v(i).dot(n_);
    return v;
  }
  double corner(const BendablePolygon& dent) const {
    return -dent.motion().u(mesh_->corners(triangle_)[0]).dot(n_);
  }

 private:
  std::shared_ptr<const ContactMesh> mesh_;
  std::int32_t triangle_ = -1;
  Vector3d n_{0, 0, 1};
};

// Springs of a dent whose fastest internal motion has the given w h at this rate.
DentSettings settings_of(double omega_h, double rate, SpringScheme scheme) {
  DentSettings settings;
  settings.stiffness = 20;
  settings.neighbour_stiffness = 8;
  settings.damping = 0;
  settings.step = 1 / rate;
  settings.integrator = scheme;
  settings.rounds = 100;
  const double omega = omega_h * rate;
  settings.mass = (settings.stiffness + 6 * settings.neighbour_stiffness) / (omega * omega);
  return settings;
}

// Releases a dent, which oscillates freely. Returns its maximum error over a part of a period, as a
// fraction of the dent, compared with the modes of its springs, each in closed form.
double release_error(const Plate& plate, const DentSettings& settings, double omega_h,
                     double periods, bool damped_by_step) {
  BendablePolygon dent = plate.build(settings);
  // Pressed at the speed of a hand, so that there is motion to release.
  for (int i = 0; i < 200; ++i) plate.press(dent, 0.002);
  const VectorXd u = plate.displacements(dent), v = plate.velocities(dent);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(plate.stiffness(settings) / settings.mass);
  const MatrixXd& shapes = modes.eigenvectors();
  const VectorXd a = shapes.transpose() * u, c = shapes.transpose() * v;
  const int ticks = std::max(3, static_cast<int>(periods * 2 * std::numbers::pi / omega_h));
  const int every = std::max(1, ticks / 50);
  double worst = 0;
  for (int i = 1; i <= ticks; ++i) {
    dent.rest();
    if (i % every != 0) continue;
    VectorXd truth(a.size());
    for (int k = 0; k < a.size(); ++k) {
      const double omega = std::sqrt(modes.eigenvalues()(k)), h = settings.step, t = i * h;
      if (damped_by_step) {
        // Closed form of implicit Euler: each step is a rotation by atan(w h) and a factor of 1 /
        // sqrt(1 + w^2 h^2).
        const double turn = i * std::atan(omega * h);
        const double fade = std::pow(1 + omega * omega * h * h, -0.5 * i);
        truth(k) = fade * (a(k) * std::cos(turn) + c(k) / omega * std::sin(turn));
      } else {
        truth(k) = a(k) * std::cos(omega * t) + c(k) / omega * std::sin(omega * t);
      }
    }
    worst = std::max(worst, (shapes * truth - plate.displacements(dent)).cwiseAbs().maxCoeff());
  }
  return worst / u.cwiseAbs().maxCoeff();
}

TEST(PhysicsOfDents, ReleasedDentsSwingAsTheirModesDo) {
  const Plate plate;
  for (const double rate : {1e3, 2e4}) {
    for (const double omega_h : {0.1, 0.03, 0.01, 0.003, 0.001}) {
      const double error = release_error(
          plate, settings_of(omega_h, rate, SpringScheme::kTrapezoid), omega_h, 1, false);
      char words[120];
      std::snprintf(words, sizeof words,
                    "largest error over a period after letting go, trapezoid, w h = %g at %g kHz",
                    omega_h, rate / 1e3);
      expect_physics(
          {kDent, words, "sum of modes a cos(w t) + c / w sin(w t)", "of the dent", 0, 0.005, 1},
          error);
    }
  }
}

TEST(PhysicsOfDents, ImplicitEulerDampsByItsClosedForm) {
  const Plate plate;
  for (const double rate : {1e3, 2e4}) {
    for (const double omega_h : {0.3, 0.1, 0.01, 0.001}) {
      const double error = release_error(
          plate, settings_of(omega_h, rate, SpringScheme::kImplicitEuler), omega_h, 1, true);
      char words[120];
      std::snprintf(
          words, sizeof words,
          "largest error over a period after letting go, implicit Euler, w h = %g at %g kHz",
          omega_h, rate / 1e3);
      expect_physics(
          {kDent, words, "modes that turn by atan(w h) and fade by 1 / sqrt(1 + w^2 h^2)",
           "of the dent", 0, 0.005, 1},
          error);
    }
  }
}

// At rest the same springs have the same dent, regardless of the vertices' mass.
TEST(PhysicsOfDents, StaticDepthDoesNotDependOnTheMass) {
  const Plate plate;
  DentSettings fast;
  fast.stiffness = 5;
  fast.neighbour_stiffness = 2;
  fast.damping = 0.5;
  fast.mass = 1e-5;
  for (const SpringScheme scheme : {SpringScheme::kImplicitEuler, SpringScheme::kTrapezoid}) {
    fast.integrator = scheme;
    BendablePolygon settled = plate.build(fast);
    for (int i = 0; i < 5000; ++i) plate.press(settled, 0.002);
    const double truth = plate.corner(settled);
    for (const double mass : {0.05, 0.2}) {
      DentSettings slow = fast;
      slow.mass = mass;
      BendablePolygon dent = plate.build(slow);
      for (int i = 0; i < 12000; ++i) plate.press(dent, 0.002);
      char words[120];
      std::snprintf(words, sizeof words, "depth of a corner after 12 s, vertices of %g g, %s",
                    mass * 1e3, std::string(name_of(scheme)).c_str());
      expect_physics({kDent, words, "that of vertices of 0.01 g", "m", truth, 0.002},
                     plate.corner(dent));
    }
  }
}

// A heavily damped dent decays at its slowest rate: with springs only to the base points there are
// no modes.
TEST(PhysicsOfDents, OverdampedDentCreepsBackAtItsRate) {
  const Plate plate;
  for (const double rate : {1e3, 2e4}) {
    DentSettings settings;
    settings.stiffness = 20;
    settings.neighbour_stiffness = 0;
    settings.damping = 2;
    settings.mass = 1e-4;
    settings.step = 1 / rate;
    settings.integrator = SpringScheme::kTrapezoid;
    BendablePolygon dent = plate.build(settings);
    for (int i = 0; i < rate; ++i) plate.press(dent, 0.002);
    for (int i = 0; i < 0.01 * rate; ++i) dent.rest();
    const double before = plate.corner(dent);
    for (int i = 0; i < 0.1 * rate; ++i) dent.rest();
    const double discriminant = std::sqrt(4.0 - 4 * 20 * 1e-4);
    const double slow = (2 - discriminant) / (2 * 1e-4);
    char words[100];
    std::snprintf(words, sizeof words, "what is left of a damped dent after 0.1 s, %g kHz",
                  rate / 1e3);
    expect_physics(
        {kDent, words, "exp(-t (b - sqrt(b^2 - 4 k m)) / (2 m))", "1", std::exp(-0.1 * slow), 0.01},
        plate.corner(dent) / before);
  }
}

}  // namespace
}  // namespace thimble::render
