#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// A step of single precision that is reported, as a share of the diagonal of the mesh's box:
/// normals of triangles a hundredth as long are wrong by 0.006 degrees.
inline constexpr double kStepReported = 1e-6;

/// The step above which a mesh is refused: such normals are wrong by 6 degrees.
inline constexpr double kStepMax = 1e-3;

/// Resolution of single precision at the coordinates of a mesh that went through it. Real-time:
/// never from the servo thread.
class SinglePrecision {
 public:
  /// Adds a position as in the file, before the file's nodes move it; `scale` is their enlargement.
  void add(const Eigen::Vector3d& p, double scale = 1) {
    const double farthest = p.cwiseAbs().maxCoeff();
    if (farthest * scale > farthest_ * scale_) {
      farthest_ = farthest;
      scale_ = scale;
    }
  }

  /// Adds a sentence to `notes` if the step at the farthest position is above `kStepReported`; the
  /// error is that sentence if it is above `kStepMax`. Both give the remedy. `mesh` is the whole
  /// mesh, placed by its nodes.
  driver::Result<void> judge(const TriangleMesh& mesh, std::vector<std::string>& notes) const;

 private:
  double farthest_ = 0;
  double scale_ = 1;
};

}  // namespace thimble::render
