#include "body/dent/dent_motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace thimble::render {
namespace {

// Steps this near to the limit count as beyond it (as in SpringMotion).
constexpr double kShareOfLimit = 0.98;
constexpr int kSubstepsMax = 64;

// A vertex has settled where it keeps less than this of the largest dent: nobody sees a thousandth
// of it end.
constexpr double kSettled = 1e-3;

// Rounds end where what is left moves no vertex by more than this share of the largest dent.
constexpr double kStill = 1e-5;

// Ticks between two looks at what has settled.
constexpr int kLookEvery = 16;

// A cursor spring so much stiffer than the surface is rigid to 1e-6 of the dent; stiffer ones would
// only cost digits.
constexpr double kRigid = 1e6;

// Nothing swings faster, m/s: strokes are up to 2 m/s [STABILITY 7]. What the cursor throws farther
// in one tick, as by a lost contact that is found elsewhere, takes energy out here, never in.
constexpr double kSpeedMax = 10;

}  // namespace

DentMotion::DentMotion(std::shared_ptr<const VertexLinks> links, const DentSettings& settings)
    : links_(std::move(links)),
      settings_(settings),
      stiffness_{settings.stiffness, settings.neighbour_stiffness},
      damping_{settings.damping, settings.neighbour_damping} {
  places_.resize(at(links_->vertex_count()));
  const std::size_t room = std::min(kNodesMax, places_.size());
  for (auto* each : {&u_, &v_, &b_, &w_, &q_}) each->assign(room, Lane::Zero());
  for (auto* each : {&wf_, &rf_, &pf_, &qf_}) each->assign(room, Lanef::Zero());
  for (auto* each : {&sum_, &extra_}) each->assign(room, 0);
  for (auto* each : {&inverse_, &extraf_}) each->assign(room, 0);
  vertices_.reserve(room);
  gathered_.reserve(room);
  link_begin_.assign(room + 1, 0);
  link_list_.reserve(kLinksMax);
}

NetworkBounds DentMotion::bounds() const noexcept {
  // Gershgorin: the springs of a row, once on the diagonal and once beside it.
  const double edges = 2 * links_->sum_max();
  NetworkBounds bounds;
  bounds.omega_gershgorin = std::sqrt((stiffness_.node + edges * stiffness_.link) / settings_.mass);
  bounds.omega_max = bounds.omega_gershgorin;
  bounds.damping_rate_max = (damping_.node + edges * damping_.link) / settings_.mass;
  bounds.damping_rate_min = damping_.node / settings_.mass;
  bounds.relaxation_min = damping_.node / stiffness_.node;
  if (stiffness_.link > 0) {
    bounds.relaxation_min = std::min(bounds.relaxation_min, damping_.link / stiffness_.link);
  }
  return bounds;
}

driver::Result<DentMotion> DentMotion::build(std::shared_ptr<const VertexLinks> links,
                                             const DentSettings& settings) {
  if (auto good = settings.check(); !good) return good.error();
  if (settings.whole && at(links->vertex_count()) > kNodesMax) {
    return driver::Error{
        "A dent moves up to " + std::to_string(kNodesMax) + " vertices at once, and the mesh has " +
        std::to_string(links->vertex_count()) + ": take \"region: near\" with a number of rings."};
  }
  DentMotion motion(std::move(links), settings);
  const double limit = kShareOfLimit * largest_step(settings.integrator, motion.bounds());
  const double needed = std::ceil(settings.step / limit);
  motion.substeps_ = settings.substeps;
  if (!(needed <= motion.substeps_)) {
    if (!(needed <= kSubstepsMax)) {
      return driver::Error{fmt::format(
          "The integrator {} bears steps up to {:.3g} ms on this dent, and the tick takes {:.3g} "
          "ms: soften the springs, add mass or dampers, or use implicit_euler.",
          name_of(settings.integrator), limit * 1e3, settings.step * 1e3)};
    }
    motion.substeps_ = static_cast<int>(needed);
  }
  motion.h_ = settings.step / motion.substeps_;
  return motion;
}

bool DentMotion::swings(std::size_t slot) const noexcept {
  const double k = stiffness();
  return settings_.mass * v_[slot].squaredNorm() + k * u_[slot].squaredNorm() >
         kSettled * kSettled * k * largest_ * largest_;
}

bool DentMotion::add(std::int32_t vertex) noexcept {
  Place& place = places_[at(vertex)];
  if (place.round == round_) return true;
  const std::size_t links = links_gathered_ + at(links_->valence(vertex));
  if (gathered_.size() == gathered_.capacity() || links > kLinksMax) return false;
  place.round = round_;
  links_gathered_ = links;
  gathered_.push_back(vertex);
  return true;
}

void DentMotion::add_swinging() noexcept {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    if (swings(i) && !add(vertices_[i])) ++cut_;
  }
  take_over();
  until_look_ = kLookEvery;
}

void DentMotion::gather(std::span<const std::int32_t> first) noexcept {
  if (resting()) largest_ = 0;
  if (settings_.whole && vertices_.size() == places_.size()) {
    wanted_ = vertices_.size();
    return;
  }
  ++round_;
  gathered_.clear();
  links_gathered_ = 0;
  if (settings_.whole) {
    for (std::int32_t v = 0; v < links_->vertex_count(); ++v) add(v);
  } else {
    for (const std::int32_t v : first) add(v);
    std::size_t begin = 0;
    for (int ring = 0; ring < settings_.rings; ++ring) {
      const std::size_t end = gathered_.size();
      for (; begin < end; ++begin) {
        for (const std::int32_t other : links_->of(gathered_[begin])) add(other);
      }
    }
  }
  wanted_ = gathered_.size();
  add_swinging();
}

void DentMotion::release() noexcept {
  wanted_ = 0;
}

// Puts what has settled on its base points.
void DentMotion::prune() noexcept {
  if (settings_.whole) {
    // Waves run through the whole body: it rests as a whole.
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (swings(i)) {
        until_look_ = kLookEvery;
        return;
      }
    }
  }
  ++round_;
  gathered_.clear();
  links_gathered_ = 0;
  for (std::size_t i = 0; i < wanted_; ++i) add(vertices_[i]);
  add_swinging();
}

// Goes over from `vertices_` to `gathered_`.
void DentMotion::take_over() noexcept {
  for (std::size_t i = 0; i < gathered_.size(); ++i) {
    const std::int32_t slot = places_[at(gathered_[i])].slot;
    w_[i] = slot < 0 ? Lane(0, 0, 0, 0) : u_[at(slot)];
    q_[i] = slot < 0 ? Lane(0, 0, 0, 0) : v_[at(slot)];
  }
  for (const std::int32_t vertex : vertices_) places_[at(vertex)].slot = -1;
  for (Grip& grip : grips_) grip.slot = -1;
  vertices_.swap(gathered_);
  u_.swap(w_);
  v_.swap(q_);
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    places_[at(vertices_[i])].slot = static_cast<std::int32_t>(i);
  }
  link_up();
}

void DentMotion::link_up() noexcept {
  link_list_.clear();
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const std::int32_t vertex = vertices_[i];
    const auto others = links_->of(vertex);
    const auto valence = static_cast<std::int32_t>(others.size());
    for (const std::int32_t other : others) {
      const std::int32_t slot = places_[at(other)].slot;
      if (slot < 0) continue;
      link_list_.push_back(
          {slot, static_cast<float>(VertexLinks::weight(valence, links_->valence(other)))});
    }
    link_begin_[i + 1] = static_cast<std::uint32_t>(link_list_.size());
    sum_[i] = links_->sum(vertex);
    extra_[i] = 0;
  }
}

void DentMotion::pull(std::size_t k, std::int32_t vertex, const CursorSpring& spring) noexcept {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  Grip& grip = grips_[k];
  // Written so that NaN means no spring.
  const bool right = spring.stiffness >= 0 && spring.damping >= 0 && spring.damping < kInfinite &&
                     spring.target.squaredNorm() < kInfinite &&
                     spring.rate.squaredNorm() < kInfinite;
  grip.slot = right ? places_[at(vertex)].slot : -1;
  if (grip.slot < 0) return;
  grip.stiffness = std::min(spring.stiffness, kRigid * stiffness());
  grip.damping = spring.damping;
  grip.target.head<3>() = spring.target;
  grip.rate.head<3>() = spring.rate;
  largest_ = std::max(largest_, spring.target.norm());
}

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

// Five calls per vertex and tick: a call would cost a quarter of it.
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

// Tells what a cursor spring does to its vertex while that stands where it is, N.
DentMotion::Lane DentMotion::cursor_force(const Grip& grip, std::size_t i) const noexcept {
  return grip.stiffness * (grip.target - u_[i]) + grip.damping * grip.rate;
}

// Finds what springs and dampers do to each vertex, m/s^2, in b_.
void DentMotion::accelerate() noexcept {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    b_[i] = -1 / settings_.mass * (row(stiffness_, i, u_) + row(damping_, i, v_));
  }
}

void DentMotion::drift(double time) noexcept {
  for (std::size_t i = 0; i < vertices_.size(); ++i) u_[i] += time * v_[i];
}

// Lets the cursor's springs act at the end of the step, by an impulse J that moves a vertex by
// h J / m: J = h (k (target - u) + c (rate - v)) there. However stiff, it neither overshoots nor
// rings.
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
    // What the vertex needed beside its own springs: unlike the stretch of a stiff spring this
    // loses no digits.
    const std::size_t i = at(grip.slot);
    const Lane own = b_[i] - per_unit * s * cursor_force(grip, i);
    grip.force += unit / s * (row(system, i, w_) - own).head<3>();
  }
  for (std::size_t i = 0; i < n; ++i) {
    u_[i] += h_ * w_[i];
    if (share == 1) {
      v_[i] = w_[i];
    } else {
      // Beyond the middle of the step by the trapezoid rule; a vertex that the cursor holds does
      // not swing on.
      const double held = extra_[i] / (system.node + system.link * sum_[i] + extra_[i]);
      v_[i] = w_[i] + (1 - held) * (w_[i] - v_[i]);
    }
  }
  for (const Grip& grip : grips_) {
    if (grip.slot >= 0) extra_[at(grip.slot)] = 0;
  }
}

// Solves for w by conjugate gradients from v on, and scales it as SpringMotion does.
void DentMotion::solve(const Weights& system) noexcept {
  const std::size_t n = vertices_.size();
  float start = 0;
  float rz = 0;
  for (std::size_t i = 0; i < n; ++i) wf_[i] = v_[i].cast<float>();
  for (std::size_t i = 0; i < n; ++i) {
    extraf_[i] = static_cast<float>(extra_[i]);
    inverse_[i] = static_cast<float>(1 / (system.node + system.link * sum_[i] + extra_[i]));
    const Lanef b = b_[i].cast<float>();
    rf_[i] = b - row(system, i, wf_) - extraf_[i] * wf_[i];
    pf_[i] = inverse_[i] * rf_[i];
    start += inverse_[i] * b.squaredNorm();
    rz += rf_[i].dot(pf_[i]);
  }
  const double still = kStill * largest_ / h_;
  const auto end = static_cast<float>(
      std::max(settings_.remainder * settings_.remainder * double{start}, still * still));
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
  for (std::size_t i = 0; i < n; ++i) w_[i] = wf_[i].cast<double>();
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
