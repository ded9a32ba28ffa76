#include "thimble/render/body/dent_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

namespace thimble::render {
namespace {

// Steps this near to the limit count as beyond it (as in SpringMotion).
constexpr double kShareOfLimit = 0.98;
constexpr int kSubstepsMax = 64;

// A vertex has settled where it keeps less than this of the largest dent: nobody sees a ten
// thousandth of it end.
constexpr double kSettled = 1e-4;

// Ticks between two looks at what has settled.
constexpr int kLookEvery = 16;

// A cursor spring so much stiffer than the surface is rigid to 1e-6 of the dent; stiffer ones would
// only cost digits.
constexpr double kRigid = 1e6;

}  // namespace

DentMotion::DentMotion(std::shared_ptr<const VertexLinks> links, const DentSettings& settings)
    : links_(std::move(links)),
      settings_(settings),
      stiffness_{settings.stiffness, settings.neighbour_stiffness},
      damping_{settings.damping, settings.neighbour_damping} {
  places_.resize(at(links_->vertex_count()));
  const std::size_t room = std::min(kNodesMax, places_.size());
  for (auto* each : {&u_, &v_, &b_, &w_, &r_, &p_, &q_}) each->assign(room, Vector::Zero());
  for (auto* each : {&sum_, &diagonal_, &extra_}) each->assign(room, 0);
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
      char text[320];
      std::snprintf(text, sizeof text,
                    "The integrator %s bears steps up to %.3g ms on this dent, and the tick takes "
                    "%.3g ms: soften the springs, add mass or dampers, or use implicit_euler.",
                    std::string(name_of(settings.integrator)).c_str(), limit * 1e3,
                    settings.step * 1e3);
      return driver::Error{text};
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
    w_[i] = slot < 0 ? Vector::Zero() : u_[at(slot)];
    r_[i] = slot < 0 ? Vector::Zero() : v_[at(slot)];
  }
  for (const std::int32_t vertex : vertices_) places_[at(vertex)].slot = -1;
  for (Grip& grip : grips_) grip.slot = -1;
  vertices_.swap(gathered_);
  u_.swap(w_);
  v_.swap(r_);
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
      link_list_.push_back({slot, VertexLinks::weight(valence, links_->valence(other))});
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
  grip.spring = spring;
  grip.spring.stiffness = std::min(spring.stiffness, kRigid * stiffness());
  largest_ = std::max(largest_, spring.target.norm());
}

void DentMotion::step() noexcept {
  for (Grip& grip : grips_) grip.force.setZero();
  if (resting()) return;
  for (int i = 0; i < substeps_; ++i) {
    switch (settings_.integrator) {
      case SpringScheme::kExplicitEuler:
        accelerate();
        drift(h_);
        for (std::size_t n = 0; n < vertices_.size(); ++n) v_[n] += h_ * b_[n];
        reach_out(h_);
        break;
      case SpringScheme::kSymplecticEuler:
        accelerate();
        for (std::size_t n = 0; n < vertices_.size(); ++n) v_[n] += h_ * b_[n];
        reach_out(h_);
        drift(h_);
        break;
      case SpringScheme::kVerlet:
        verlet();
        break;
      case SpringScheme::kTrapezoid:
        implicit(0.5);
        break;
      case SpringScheme::kImplicitEuler:
      case SpringScheme::kExponential:  // build() refuses these two
      case SpringScheme::kModal:
        implicit(1);
        break;
    }
  }
  for (Grip& grip : grips_) {
    grip.force /= substeps_;
    grip.slot = -1;
  }
  if (vertices_.size() > wanted_ && --until_look_ <= 0) prune();
}

DentMotion::Vector DentMotion::row(const Weights& weights, std::size_t i,
                                   const Vector* x) const noexcept {
  Vector sum = Vector::Zero();
  for (std::uint32_t e = link_begin_[i]; e < link_begin_[i + 1]; ++e) {
    sum += link_list_[e].weight * x[at(link_list_[e].slot)];
  }
  return (weights.node + weights.link * sum_[i]) * x[i] - weights.link * sum;
}

DentMotion::Vector DentMotion::spring_force(std::size_t i) const noexcept {
  return -row(stiffness_, i, u_.data()) - row(damping_, i, v_.data());
}

// Tells what a cursor spring does to its vertex while that stands where it is, N.
DentMotion::Vector DentMotion::cursor_force(const Grip& grip, std::size_t i) const noexcept {
  return grip.spring.stiffness * (grip.spring.target - u_[i]) +
         grip.spring.damping * grip.spring.rate;
}

// Finds what springs and dampers do to each vertex, m/s^2, in b_.
void DentMotion::accelerate() noexcept {
  for (std::size_t i = 0; i < vertices_.size(); ++i) b_[i] = spring_force(i) / settings_.mass;
}

void DentMotion::drift(double time) noexcept {
  for (std::size_t i = 0; i < vertices_.size(); ++i) u_[i] += time * v_[i];
}

// Lets the cursor's springs act such that they hold at the end of the drift that is to come.
void DentMotion::reach_out(double drift) noexcept {
  for (Grip& grip : grips_) {
    if (grip.slot < 0) continue;
    Vector& v = v_[at(grip.slot)];
    const Vector before = v;
    const double k = h_ * grip.spring.stiffness;
    const double c = h_ * grip.spring.damping;
    v = (settings_.mass * v + k * (grip.spring.target - u_[at(grip.slot)]) + c * grip.spring.rate) /
        (settings_.mass + drift * k + c);
    grip.force += settings_.mass / h_ * (v - before);
  }
}

// Half a drift, one kick with dampers by the midpoint rule, half a drift (as SpringMotion).
void DentMotion::verlet() noexcept {
  drift(h_ / 2);
  const std::size_t n = vertices_.size();
  for (std::size_t i = 0; i < n; ++i) b_[i] = -row(stiffness_, i, u_.data());
  for (std::size_t i = 0; i < n; ++i) {
    q_[i] = v_[i] + h_ / 2 / settings_.mass * (b_[i] - row(damping_, i, v_.data()));
  }
  for (std::size_t i = 0; i < n; ++i) {
    v_[i] += h_ / settings_.mass * (b_[i] - row(damping_, i, q_.data()));
  }
  reach_out(h_ / 2);
  drift(h_ / 2);
}

// One substep of implicit Euler (share 1) or of the trapezoid rule (share 1/2), w the velocity:
// (M + sC + s^2 K + s (h k + c)) w = M v - s K u + s (k (target - u) + c rate), with s = share h,
// and k and c the cursor's springs and dampers: springs act at the end of the step in both rules.
void DentMotion::implicit(double share) noexcept {
  const double s = share * h_;
  const std::size_t n = vertices_.size();
  const Weights system{settings_.mass + s * damping_.node + s * s * stiffness_.node,
                       s * damping_.link + s * s * stiffness_.link};
  for (std::size_t i = 0; i < n; ++i) {
    b_[i] = settings_.mass * v_[i] - s * row(stiffness_, i, u_.data());
    diagonal_[i] = system.node + system.link * sum_[i];
  }
  for (const Grip& grip : grips_) {
    if (grip.slot < 0) continue;
    const std::size_t i = at(grip.slot);
    b_[i] += s * cursor_force(grip, i);
    extra_[i] = s * (h_ * grip.spring.stiffness + grip.spring.damping);
    diagonal_[i] += extra_[i];
  }
  solve(system);
  for (Grip& grip : grips_) {
    if (grip.slot < 0) continue;
    // What the vertex needed beside its own springs: unlike the stretch of a stiff spring this
    // loses no digits.
    const std::size_t i = at(grip.slot);
    const Vector own = b_[i] - s * cursor_force(grip, i);
    grip.force += (row(system, i, w_.data()) - own) / s;
    extra_[i] = 0;
  }
  for (std::size_t i = 0; i < n; ++i) {
    u_[i] += h_ * w_[i];
    v_[i] = share == 1 ? w_[i] : Vector(2 * w_[i] - v_[i]);
  }
}

// Solves for w by conjugate gradients from v on, and scales it as SpringMotion does.
void DentMotion::solve(const Weights& system) noexcept {
  const std::size_t n = vertices_.size();
  double start = 0;
  double rz = 0;
  for (std::size_t i = 0; i < n; ++i) w_[i] = v_[i];
  for (std::size_t i = 0; i < n; ++i) {
    q_[i] = row(system, i, w_.data()) + extra_[i] * w_[i];
    r_[i] = b_[i] - q_[i];
    p_[i] = r_[i] / diagonal_[i];
    start += b_[i].squaredNorm() / diagonal_[i];
    rz += r_[i].dot(p_[i]);
  }
  const double end = settings_.remainder * settings_.remainder * start;
  double wb = 0;
  double waw = 0;
  for (int round = 0; round < settings_.rounds && rz > end; ++round) {
    double pq = 0;
    for (std::size_t i = 0; i < n; ++i) {
      q_[i] = row(system, i, p_.data()) + extra_[i] * p_[i];
      pq += p_[i].dot(q_[i]);
    }
    if (!(pq > 0)) break;
    const double alpha = rz / pq;
    double rz_next = 0;
    for (std::size_t i = 0; i < n; ++i) {
      w_[i] += alpha * p_[i];
      r_[i] -= alpha * q_[i];
      rz_next += r_[i].squaredNorm() / diagonal_[i];
    }
    const double beta = rz_next / rz;
    for (std::size_t i = 0; i < n; ++i) p_[i] = r_[i] / diagonal_[i] + beta * p_[i];
    rz = rz_next;
  }
  // A w = b - r by the rounds' own sums.
  for (std::size_t i = 0; i < n; ++i) {
    wb += w_[i].dot(b_[i]);
    waw += w_[i].dot(b_[i] - r_[i]);
  }
  const double scale = waw > 0 ? wb / waw : 0;
  for (std::size_t i = 0; i < n; ++i) w_[i] *= scale;
}

double DentMotion::energy() const noexcept {
  double twice = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    twice += settings_.mass * v_[i].squaredNorm() + u_[i].dot(row(stiffness_, i, u_.data()));
  }
  return twice / 2;
}

}  // namespace thimble::render
