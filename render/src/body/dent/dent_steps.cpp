// Motion of the vertices of DentMotion in one tick: its integration schemes and their solver.
#include <algorithm>
#include <cmath>

#include "body/dent/dent_motion.h"

namespace thimble::render {
namespace {

// Rounds also end when the residual moves no vertex by more than this share of the largest dent in
// a step: 2e-6 of it in a second at 20 kHz. This ends the rounds of a dent at rest, whose residual
// is only rounding.
constexpr double kStill = 1e-10;

// Maximum speed of a vertex, m/s: strokes are up to 2 m/s [PHYSICS 7]. If the cursor moves it
// farther in one tick, as when a lost contact is found elsewhere, this dissipates energy and never
// adds any.
constexpr double kSpeedMax = 10;

}  // namespace

void DentMotion::step() noexcept {
  for (Grip& grip : grips_) grip.force.setZero();
  if (resting()) return;
  for (int i = 0; i < substeps_; ++i) {
    switch (settings_.integrator) {
      case SpringScheme::kSymplecticEuler:
        accelerate();
        for (std::size_t n = 0; n < vertices_.size(); ++n) v_[n] += h_ * b_[n];
        drift(h_);
        reach_out();
        break;
      case SpringScheme::kVerlet:
        verlet();
        break;
      case SpringScheme::kTrapezoid:
        implicit(0.5);
        break;
      case SpringScheme::kImplicitEuler:
      case SpringScheme::kExplicitEuler:  // build() refuses these three
      case SpringScheme::kExponential:
      case SpringScheme::kModal:
        implicit(1);
        break;
    }
  }
  for (Grip& grip : grips_) {
    grip.force /= substeps_;
    grip.slot = -1;
  }
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const double speed = v_[i].squaredNorm();
    if (speed > kSpeedMax * kSpeedMax) v_[i] *= kSpeedMax / std::sqrt(speed);
  }
  if (vertices_.size() > wanted_ && --until_look_ <= 0) prune();
}

// Called five times per vertex and tick: a function call would cost a quarter of the time.
template <class Value>
[[gnu::always_inline]] inline Value DentMotion::row(const Weights& weights, std::size_t i,
                                                    const std::vector<Value>& x) const noexcept {
  using Number = typename Value::Scalar;
  Value sum = Value::Zero();
  for (std::uint32_t e = link_begin_[i]; e < link_begin_[i + 1]; ++e) {
    sum += Number{link_list_[e].weight} * x[at(link_list_[e].slot)];
  }
  return static_cast<Number>(weights.node + weights.link * sum_[i]) * x[i] -
         static_cast<Number>(weights.link) * sum;
}

// Returns the force of a cursor spring on its vertex at the vertex's present position, N.
DentMotion::Lane DentMotion::cursor_force(const Grip& grip, std::size_t i) const noexcept {
  return grip.stiffness * (grip.target - u_[i]) + grip.damping * grip.rate;
}

// Computes the acceleration of each vertex by springs and dampers, m/s^2, in b_.
void DentMotion::accelerate() noexcept {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    b_[i] = -1 / settings_.mass * (row(stiffness_, i, u_) + row(damping_, i, v_));
  }
}

void DentMotion::drift(double time) noexcept {
  for (std::size_t i = 0; i < vertices_.size(); ++i) u_[i] += time * v_[i];
}

// Applies the cursor's springs at the end of the step, by an impulse J that moves a vertex by h J /
// m: J = h (k (target - u) + c (rate - v)) there. At any stiffness it neither overshoots nor rings.
void DentMotion::reach_out() noexcept {
  for (Grip& grip : grips_) {
    if (grip.slot < 0) continue;
    const std::size_t i = at(grip.slot);
    const double weight = settings_.mass + h_ * (h_ * grip.stiffness + grip.damping);
    const Lane kick = h_ / weight * (cursor_force(grip, i) - grip.damping * v_[i]);
    v_[i] += kick;
    u_[i] += h_ * kick;
    grip.force += settings_.mass / h_ * kick.head<3>();
  }
}

// Half a drift, one kick with dampers by the midpoint rule, half a drift (as SpringMotion).
void DentMotion::verlet() noexcept {
  drift(h_ / 2);
  const std::size_t n = vertices_.size();
  for (std::size_t i = 0; i < n; ++i) b_[i] = -row(stiffness_, i, u_);
  for (std::size_t i = 0; i < n; ++i) {
    q_[i] = v_[i] + h_ / 2 / settings_.mass * (b_[i] - row(damping_, i, v_));
  }
  for (std::size_t i = 0; i < n; ++i) v_[i] += h_ / settings_.mass * (b_[i] - row(damping_, i, q_));
  drift(h_ / 2);
  reach_out();
}

// One substep of implicit Euler (share 1) or of the trapezoid rule (share 1/2), w the velocity:
// (M + sC + s^2 K + s (h k + c)) w = M v - s K u + s (k (target - u) + c rate), with s = share h,
// and k and c the cursor's springs and dampers: springs act at the end of the step in both rules.
void DentMotion::implicit(double share) noexcept {
  const double s = share * h_;
  const std::size_t n = vertices_.size();
  // In units of a vertex's own weight, so that no stiffness leaves the range of single precision.
  Weights system{settings_.mass + s * damping_.node + s * s * stiffness_.node,
                 s * damping_.link + s * s * stiffness_.link};
  const double unit = system.node + 6 * system.link;
  system = {system.node / unit, system.link / unit};
  const double per_unit = 1 / unit;
  for (std::size_t i = 0; i < n; ++i) {
    b_[i] = per_unit * (settings_.mass * v_[i] - s * row(stiffness_, i, u_));
  }
  for (const Grip& grip : grips_) {
    if (grip.slot < 0) continue;
    const std::size_t i = at(grip.slot);
    b_[i] += per_unit * s * cursor_force(grip, i);
    extra_[i] = per_unit * s * (h_ * grip.stiffness + grip.damping);
  }
  solve(system);
  for (Grip& grip : grips_) {
    if (grip.slot < 0) continue;
    // The force that the vertex needed in addition to its own springs: unlike the stretch of a
    // stiff spring, this loses no digits.
    const std::size_t i = at(grip.slot);
    const Lane own = b_[i] - per_unit * s * cursor_force(grip, i);
    grip.force += unit / s * (row(system, i, w_) - own).head<3>();
  }
  for (std::size_t i = 0; i < n; ++i) {
    u_[i] += h_ * w_[i];
    if (share == 1) {
      v_[i] = w_[i];
    } else {
      // Extrapolated beyond the middle of the step by the trapezoid rule; a vertex held by the
      // cursor does not continue to oscillate.
      const double held = extra_[i] / (system.node + system.link * sum_[i] + extra_[i]);
      v_[i] = w_[i] + (1 - held) * (w_[i] - v_[i]);
    }
  }
  for (const Grip& grip : grips_) {
    if (grip.slot >= 0) extra_[at(grip.slot)] = 0;
  }
}

// Solves for w by conjugate gradients from v on, and scales it as in SpringMotion. The rounds
// compute the change of velocity, and end when the residual is a share of the change due to springs
// and dampers. Relative to the momentum itself, a slow dent, whose springs change little of it in a
// step, would get no force. At steps far beyond a spring's period the springs require more than the
// momentum, and the residual is a share of that. The trapezoid rule damps nothing there, so errors
// of a larger scale would grow.
void DentMotion::solve(const Weights& system) noexcept {
  const std::size_t n = vertices_.size();
  float rz = 0;
  float momentum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    extraf_[i] = static_cast<float>(extra_[i]);
    inverse_[i] = static_cast<float>(1 / (system.node + system.link * sum_[i] + extra_[i]));
    // In double precision: the momentum is a thousand times the change by a slow dent's springs.
    rf_[i] = (b_[i] - row(system, i, v_) - extra_[i] * v_[i]).cast<float>();
    wf_[i].setZero();
    pf_[i] = inverse_[i] * rf_[i];
    rz += rf_[i].dot(pf_[i]);
    momentum += inverse_[i] * b_[i].cast<float>().squaredNorm();
  }
  const double still = kStill * largest_ / h_;
  const auto end = static_cast<float>(std::max(
      settings_.remainder * settings_.remainder * double{std::min(rz, momentum)}, still * still));
  for (int round = 0; round < settings_.rounds && rz > end; ++round) {
    float pq = 0;
    for (std::size_t i = 0; i < n; ++i) {
      qf_[i] = row(system, i, pf_) + extraf_[i] * pf_[i];
      pq += pf_[i].dot(qf_[i]);
    }
    if (!(pq > 0)) break;
    const float alpha = rz / pq;
    float rz_next = 0;
    for (std::size_t i = 0; i < n; ++i) {
      wf_[i] += alpha * pf_[i];
      rf_[i] -= alpha * qf_[i];
      rz_next += inverse_[i] * rf_[i].squaredNorm();
    }
    const float beta = rz_next / rz;
    for (std::size_t i = 0; i < n; ++i) pf_[i] = inverse_[i] * rf_[i] + beta * pf_[i];
    rz = rz_next;
  }
  double wb = 0;
  double waw = 0;
  for (std::size_t i = 0; i < n; ++i) w_[i] = v_[i] + wf_[i].cast<double>();
  for (std::size_t i = 0; i < n; ++i) {
    wb += w_[i].dot(b_[i]);
    waw += w_[i].dot(row(system, i, w_) + extra_[i] * w_[i]);
  }
  const double scale = waw > 0 ? wb / waw : 0;
  for (std::size_t i = 0; i < n; ++i) w_[i] *= scale;
}

double DentMotion::energy() const noexcept {
  double twice = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    twice += settings_.mass * v_[i].squaredNorm() + u_[i].dot(row(stiffness_, i, u_));
  }
  return twice / 2;
}

}  // namespace thimble::render
