#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "body/shape/clay_shape.h"
#include "body/shape/shape_contact.h"
#include "mesh/contact_mesh.h"

namespace thimble::render {

/// The account of a closed mesh's volume, and the rim around a print that takes the displaced
/// material, so that the volume is constant.
///
/// The volume is linear in the place of each vertex. Moving a vertex changes it exactly by the
/// displacement times the gradient, a sixth of the sum of the cross products of its opposite edges.
/// So each move is booked when it is made. While clay flows, the rim takes the print's volume by
/// the present gradients. The rest, of second order in the displacement of a tick, goes to the last
/// rim once all vertices are at their target places.
class VolumeKeeper {
 public:
  /// Takes the mesh in its first shape, and the radius of a print (m). Real-time: never from the
  /// servo thread.
  VolumeKeeper(const ContactMesh& mesh, double radius, std::size_t patch_max);

  // All of the following are Real-time: safe.

  /// Begins a tick in which clay flows: resets the sum of `flowed`.
  void begin() noexcept { given_ = 0; }
  /// Receives that a set has changed by `change` (m).
  void flowed(std::int32_t vertex, const Eigen::Vector3d& change) noexcept {
    given_ += gradient(vertex).dot(change);
  }
  /// Raises the rim, among `patch`, of the print that has just flowed, by at most `most` m.
  void raise(ClayShape& clay, const ShapeContact& contact, std::span<const std::int32_t> corners,
             std::span<const std::int32_t> patch, std::span<const Eigen::Vector3d> first_places,
             double most) noexcept;

  /// Receives that a vertex has moved by `way` (m) to its position in `places`.
  void moved(const ContactMesh& mesh, std::span<const Eigen::Vector3d> places, std::int32_t vertex,
             const Eigen::Vector3d& way) noexcept;
  /// Receives that an edge was split.
  void take(const ContactMesh& mesh, std::span<const Eigen::Vector3d> places,
            const EdgeSplit& split) noexcept;

  /// Gives the remaining volume to the last rim, once all vertices are at their target places.
  /// Returns the vertices that must move for it; none if nothing is left that can be given.
  std::span<const std::int32_t> settle(ClayShape& clay) noexcept;

  /// Returns the difference of the volume from the first one, m^3.
  double change() const noexcept { return change_; }

  static constexpr double kRim = 2;  ///< Outer radius of a rim, in radii of a print.

 private:
  const Eigen::Vector3d& gradient(std::int32_t vertex) const noexcept {
    return gradients_[static_cast<std::size_t>(vertex)];
  }
  void find_gradient(const ContactMesh& mesh, std::span<const Eigen::Vector3d> places,
                     std::int32_t vertex) noexcept;
  double lift(ClayShape& clay, double volume, double most) noexcept;

  double radius_;
  std::vector<Eigen::Vector3d> gradients_;  // m^2
  std::vector<std::int32_t> rim_;
  std::vector<double> shares_;  // of each vertex of the rim, at most 1
  Eigen::Vector3d outward_{0, 0, 0};
  double given_ = 0;    // m^3, by the flow in this tick
  double change_ = 0;   // m^3
  double printed_ = 0;  // m^3, by all prints
  int tries_ = 0;
};

}  // namespace thimble::render
