#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::bench {

/// Another library asked the same questions. Set-up may throw away what it does not need;
/// questions return NaN where the library finds nothing.
class Peer {
 public:
  virtual ~Peer() = default;

  /// Names the library and what of it is asked.
  virtual std::string name() const = 0;

  /// Finds how far along the segment (0 to 1) the mesh is first hit.
  virtual double first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) = 0;

  /// Finds the distance (m) to the nearest point of the mesh, if within `radius` (m).
  virtual double closest(const Eigen::Vector3d& p, double radius) = 0;

  /// Follows the tip from one tick to the next and gives its depth (m); NaN if contact is lost.
  virtual double follow(const Eigen::Vector3d& p) = 0;

  /// Returns which of the questions the library answers.
  virtual bool has_first_hit() const { return false; }
  virtual bool has_closest() const { return false; }
  virtual bool has_follow() const { return false; }
};

// Null where the library was not there at configure time.

/// Embree's rtcIntersect1, rtcPointQuery, and a god-object over the first.
std::unique_ptr<Peer> make_embree(const render::TriangleMesh& mesh);
/// CGAL's AABB tree.
std::unique_ptr<Peer> make_cgal(const render::TriangleMesh& mesh);
/// FCL's distance to a point-like ball.
std::unique_ptr<Peer> make_fcl(const render::TriangleMesh& mesh);

}  // namespace thimble::bench
