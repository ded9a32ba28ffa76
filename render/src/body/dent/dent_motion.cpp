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

// A vertex has settled when less than this share of the largest dent is left: the end of a
// thousandth of it is not visible.
constexpr double kSettled = 1e-3;

// Ticks between two checks for settled vertices.
constexpr int kLookEvery = 16;

// A cursor spring this much stiffer than the surface is rigid to 1e-6 of the dent; stiffer ones
// would only cost digits.
constexpr double kRigid = 1e6;

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
  // Gershgorin: the springs of a row, once on the diagonal and once off it.
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
    return driver::Error{"A dent can move at most " + std::to_string(kNodesMax) +
                         " vertices at once; the mesh has " +
                         std::to_string(links->vertex_count()) +
                         ". Use \"region: near\" with a number of rings."};
  }
  DentMotion motion(std::move(links), settings);
  const double limit = kShareOfLimit * largest_step(settings.integrator, motion.bounds());
  const double needed = std::ceil(settings.step / limit);
  motion.substeps_ = settings.substeps;
  if (!(needed <= motion.substeps_)) {
    if (!(needed <= kSubstepsMax)) {
      return driver::Error{
          fmt::format("Integrator {} is stable for steps up to {:.3g} ms on this dent, but the "
                      "tick takes {:.3g} "
                      "ms. Lower the stiffness, add mass or damping, or use implicit_euler.",
                      name_of(settings.integrator), limit * 1e3, settings.step * 1e3)};
    }
    motion.substeps_ = static_cast<int>(needed);
  }
  motion.h_ = settings.step / motion.substeps_;
  return motion;
}

bool DentMotion::unsettled(std::size_t slot) const noexcept {
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

void DentMotion::add_unsettled() noexcept {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    if (unsettled(i) && !add(vertices_[i])) ++cut_;
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
  add_unsettled();
}

void DentMotion::release() noexcept {
  wanted_ = 0;
}

// Puts settled vertices on their base points.
void DentMotion::prune() noexcept {
  if (settings_.whole) {
    // Waves travel through the whole body, so it rests as a whole.
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (unsettled(i)) {
        until_look_ = kLookEvery;
        return;
      }
    }
  }
  ++round_;
  gathered_.clear();
  links_gathered_ = 0;
  for (std::size_t i = 0; i < wanted_; ++i) add(vertices_[i]);
  add_unsettled();
}

// Replaces `vertices_` by `gathered_`.
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

}  // namespace thimble::render
