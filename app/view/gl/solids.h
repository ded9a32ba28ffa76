#pragma once

#include <Eigen/Core>
#include <vector>

#include "view/gl/palette.h"
#include "view/gl/surface_model.h"

namespace thimble::view {

/// Shape of a solid.
enum class SolidKind { kBall, kRod, kCone };

/// One of the simple solids that show arm, tip and force.
struct Solid {
  SolidKind kind = SolidKind::kBall;
  Eigen::Matrix4f model = Eigen::Matrix4f::Identity();  ///< Transform from the unit solid to W, m.
  Eigen::Matrix3f normal_matrix = Eigen::Matrix3f::Identity();
  Colour colour{};
  bool shines_through = false;  ///< Also drawn, faintly, where it is hidden.
  bool casts_shadow = true;
};

/// Make solids: sizes in m, points in W. A rod or cone without length is invisible.
Solid ball(const Eigen::Vector3d& centre, double radius, const Colour& colour);
Solid rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
          const Colour& colour);
Solid cone(const Eigen::Vector3d& base, const Eigen::Vector3d& tip, double radius,
           const Colour& colour);

/// The unit solids in OpenGL.
class SolidModels {
 public:
  SolidModels();
  const SurfaceModel& model(SolidKind kind) const {
    return models_[static_cast<std::size_t>(kind)];
  }

 private:
  std::vector<SurfaceModel> models_;
};

}  // namespace thimble::view
