#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "body/shape/shape_contact.h"
#include "thimble/render/body/shape_choice.h"

namespace thimble::render {

/// Moves the base points of a mesh as clay does: each keeps a set, which flows where the surface's
/// spring presses with more than the yield force.
///
/// The touched place is a spring in a row with a slider [STABILITY 4, plastic truth]: it gives way
/// until the spring holds the yield force, so pressed to x_max it keeps x_max - F_y / k, whatever
/// the mesh; the base points around go with it by a smooth print (1 - (r / radius)^2)^2, along the
/// first normal of the touched triangle. Never gives energy: it moves against the force that
/// presses it only.
class ClayShape {
 public:
  /// Takes the surface's stiffness (N/m, > 0) and the number of vertices.
  /// Real-time: never from the servo thread.
  ClayShape(const ClayChoice& choice, double stiffness, std::size_t vertices);

  // All of the following are Real-time: safe.

  /// Lets the sets of `patch` (the vertices around the contact) flow for `step` s; `first_places`
  /// are those of all vertices. Gives the way that the touched place shall go inwards, m: 0 if it
  /// holds.
  double press(const ShapeContact& contact, std::span<const std::int32_t> corners,
               std::span<const std::int32_t> patch, std::span<const Eigen::Vector3d> first_places,
               double step) noexcept;

  /// Takes in how far the touched place really went (m), with the spring pressed in by `depth` (m)
  /// before: what the slider held against turned into heat.
  void moved(double way, double depth) noexcept;

  /// Gives the set of a vertex, m from its first place.
  const Eigen::Vector3d& set(std::int32_t vertex) const noexcept {
    return sets_[static_cast<std::size_t>(vertex)];
  }
  /// Corrects a set that cannot be: where other triangles were in the way.
  void correct(std::int32_t vertex, const Eigen::Vector3d& set) noexcept {
    sets_[static_cast<std::size_t>(vertex)] = set;
  }
  double radius() const noexcept { return choice_.radius; }  ///< Of a print, m.
  /// Sums up what was turned into heat, J; never falls.
  double dissipated() const noexcept { return dissipated_; }

 private:
  double print(double distance_squared) const noexcept;

  ClayChoice choice_;
  double stiffness_;
  std::vector<Eigen::Vector3d> sets_;
  double dissipated_ = 0;
};

}  // namespace thimble::render
