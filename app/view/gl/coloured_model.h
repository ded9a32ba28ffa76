#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "view/gl/gl_objects.h"
#include "view/gl/palette.h"

namespace thimble::view {

/// One vertex of a mesh with a colour per vertex.
struct ColouredVertex {
  Eigen::Vector3f p;       ///< m, W.
  Eigen::Vector3f n;       ///< Unit normal, W.
  Eigen::Vector3f colour;  ///< Colour as on the screen.
};

/// Many small things in one mesh, which one call draws.
struct ColouredMesh {
  std::vector<ColouredVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Adds an arrow from one point to another (W, m), in one colour, with a shaft of this radius (m).
/// An arrow without length adds nothing.
void add_arrow(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
               const Colour& colour, ColouredMesh& mesh);

/// Adds a tube of this radius (m) through points (W, m), each with its colour. Precondition: as
/// many colours as points. Points less than a nanometre from the previous one are omitted.
void add_tube(std::span<const Eigen::Vector3d> points, std::span<const Colour> colours,
              double radius, ColouredMesh& mesh);

/// A coloured mesh in OpenGL: position at 0, normal at 1, colour at 2.
class ColouredModel {
 public:
  ColouredModel();
  void set(const ColouredMesh& mesh);
  void draw() const;

 private:
  GlVertexArray array_;
  GlBuffer vertices_, indices_;
  GLsizei indices_count_ = 0;
};

}  // namespace thimble::view
