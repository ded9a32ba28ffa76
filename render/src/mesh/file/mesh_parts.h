#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "mesh/file/single_precision.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Joins the parts of a file to one mesh, each at the place of its nodes or instances.
class MeshParts {
 public:
  /// Adds a part at a place in the file's frame. A part that the place mirrors is turned, so that
  /// its outer side stays outside. `single`: its coordinates are in single precision. The error is
  /// a sentence: a coordinate that is NaN or beyond 1e15, or too many triangles. Precondition:
  /// triangles name existing vertices. `attributes`, if not null, are those of the part. Real-time:
  /// never from the servo thread.
  driver::Result<void> add(const TriangleMesh& part, const Eigen::Affine3d& place, bool single,
                           const MeshAttributes* attributes = nullptr);

  /// Returns the mesh and adds the number of moved parts to `notes`. The error is a sentence: no
  /// triangle, or coarse coordinates. Real-time: never from the servo thread.
  driver::Result<TriangleMesh> take(std::vector<std::string>& notes);
  /// Returns the attributes of all parts. Real-time: never from the servo thread.
  MeshAttributes take_attributes();

 private:
  TriangleMesh mesh_;
  MeshAttributes attributes_;
  SinglePrecision precision_;
  std::size_t parts_ = 0;
  std::size_t moved_ = 0;
};

}  // namespace thimble::render
