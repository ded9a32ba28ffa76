#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "body/shape/shape_contact.h"
#include "mesh/contact_mesh.h"
#include "thimble/render/body/shape_choice.h"

namespace thimble::render {

/// Moves the base points of a mesh like clay: each has a set (permanent displacement), which flows
/// where the surface's spring presses with more than the yield force.
///
/// The touched place is a spring and a slider in series [PHYSICS 4, plastic truth]. It gives way
/// until the spring holds the yield force, so pressed to x_max it keeps x_max - F_y / k, on any
/// mesh. The base points around it follow by a smooth print (1 - (r / radius)^2)^2, along the first
/// normal of the touched triangle. It never releases energy, because it moves only against the
/// pressing force.
class ClayShape {
 public:
  /// Takes the surface's stiffness (N/m, > 0), the number of vertices, and the maximum to which
  /// that may grow. Real-time: never from the servo thread.
  ClayShape(const ClayChoice& choice, double stiffness, std::size_t vertices,
            std::size_t vertices_max);

  // All of the following are Real-time: safe.

  /// Makes the sets of `patch` (the vertices around the contact) flow for `step` s; `first_places`
  /// are those of all vertices. Returns the distance by which the touched place moves inwards, m: 0
  /// if it holds. Calls `changed(vertex, change)` with the change of each set, m.
  template <class Changed>
  double press(const ShapeContact& contact, std::span<const std::int32_t> corners,
               std::span<const std::int32_t> patch, std::span<const Eigen::Vector3d> first_places,
               double step, Changed changed) noexcept;

  /// Returns whether a spring pressed in by `depth` (m) makes the clay flow.
  bool flows(double depth) const noexcept { return depth > choice_.yield_force / stiffness_; }
  /// Returns whether it is near flowing: from half of that depth on.
  bool near_flowing(double depth) const noexcept { return flows(2 * depth); }

  /// Receives the actual displacement of the touched place (m), with the spring pressed in by
  /// `depth` (m) before: the slider has turned this work into heat.
  void moved(double way, double depth) noexcept;

  /// Returns the set of a vertex, m from its first place.
  const Eigen::Vector3d& set(std::int32_t vertex) const noexcept {
    return sets_[static_cast<std::size_t>(vertex)];
  }
  /// Corrects a set that is not possible because other triangles were in the way.
  void correct(std::int32_t vertex, const Eigen::Vector3d& set) noexcept {
    sets_[static_cast<std::size_t>(vertex)] = set;
  }
  /// Adds `change` (m) to a set, within the movement limit; returns the amount added.
  Eigen::Vector3d add(std::int32_t vertex, const Eigen::Vector3d& change) noexcept;
  /// Receives that an edge was split: the new vertex, the last of all, has the mean of its ends'
  /// sets.
  void take(const EdgeSplit& split) noexcept {
    sets_.push_back((set(split.ends[0]) + set(split.ends[1])) / 2);
  }
  double radius() const noexcept { return choice_.radius; }  ///< Radius of a print, m.
  /// Returns the total energy turned into heat, J; never falls.
  double dissipated() const noexcept { return dissipated_; }

 private:
  double print(double distance_squared) const noexcept;

  ClayChoice choice_;
  double stiffness_;
  std::vector<Eigen::Vector3d> sets_;
  double dissipated_ = 0;
};

template <class Changed>
double ClayShape::press(const ShapeContact& contact, std::span<const std::int32_t> corners,
                        std::span<const std::int32_t> patch,
                        std::span<const Eigen::Vector3d> first_places, double step,
                        Changed changed) noexcept {
  const double beyond = contact.depth - choice_.yield_force / stiffness_;
  // Written so that NaN moves nothing.
  if (!(beyond > 0) || !(step > 0) || !std::isfinite(contact.depth)) return 0;
  const double flow = std::min(beyond, choice_.flow_rate * step);
  // The corners of the touched triangle move even if the print is smaller than the triangle.
  const auto share_of = [&](std::int32_t vertex) {
    const auto v = static_cast<std::size_t>(vertex);
    double share = print((first_places[v] - contact.p_first).squaredNorm());
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] == vertex) {
        share = std::max(share, contact.weights[static_cast<Eigen::Index>(k)]);
      }
    }
    return share;
  };
  double at_place = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    at_place += contact.weights[static_cast<Eigen::Index>(k)] * share_of(corners[k]);
  }
  // Inwards along the first normal, so that walls of a pit neither fold nor crumple. The
  // displacement is larger by the obliqueness, up to walls of 70 degrees. The place's share is at
  // least a third: the squares of three weights whose sum is 1.
  constexpr double kAslant = 0.34;
  const double aslant = std::max(contact.first_inward.dot(contact.inward), kAslant);
  const Eigen::Vector3d way = flow / (at_place * aslant) * contact.first_inward;
  if (!way.allFinite()) return 0;
  for (const std::int32_t vertex : patch) changed(vertex, add(vertex, share_of(vertex) * way));
  return flow;
}

}  // namespace thimble::render
