#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::bench {

/// Another library that answers the same queries. The set-up may discard data that it does not
/// need; queries return NaN if the library finds nothing.
class Peer {
 public:
  virtual ~Peer() = default;

  /// Returns the name of the library and of the function measured.
  virtual std::string name() const = 0;

  /// Returns the position along the segment (0 to 1) where the mesh is first hit.
  virtual double first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) = 0;

  /// Returns the distance (m) to the closest point of the mesh, if within `radius` (m).
  virtual double closest(const Eigen::Vector3d& p, double radius) = 0;

  /// Follows the tip from one tick to the next and returns its depth (m); NaN if contact is lost.
  virtual double follow(const Eigen::Vector3d& p) = 0;

  /// Return which of the queries the library supports.
  virtual bool has_first_hit() const { return false; }
  virtual bool has_closest() const { return false; }
  virtual bool has_follow() const { return false; }
};

// Null if the library was not found at configure time.

/// Embree's rtcIntersect1, rtcPointQuery, and a god-object over the first.
std::unique_ptr<Peer> make_embree(const render::TriangleMesh& mesh);
/// CGAL's AABB tree.
std::unique_ptr<Peer> make_cgal(const render::TriangleMesh& mesh);
/// FCL's distance to a point-like ball.
std::unique_ptr<Peer> make_fcl(const render::TriangleMesh& mesh);

}  // namespace thimble::bench
