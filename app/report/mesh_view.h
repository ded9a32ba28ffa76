#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::report {

/// An orthographic view: axes of the picture in the world. World: x towards the user, y to the
/// user's right, z up.
struct ViewDirection {
  std::string_view name;
  std::string_view u_label, v_label;  ///< World axes along the picture's sides.
  Eigen::Vector3d u_W, v_W, w_W;      ///< Right, up, and towards the eye; unit vectors.
  double v_sign = 1;                  ///< -1 if the world's axis `v_label` points down.
};

/// Returns the views from the front (the user's), from the left, and from above.
const std::array<ViewDirection, 3>& view_directions();

/// One shaded picture of a mesh on white, with the depth of each pixel.
class MeshView {
 public:
  /// Draws the mesh (m) in a square window of side `extent` (m, > 0) about `center_W`. It has
  /// `pixels` pixels a side (> 0), each the mean of 2 x 2 samples.
  /// Real-time: never from the servo thread.
  MeshView(const render::TriangleMesh& mesh_W, const ViewDirection& direction,
           const Eigen::Vector3d& center_W, double extent, int pixels);

  /// Returns the pixels, three bytes (red, green, blue) each, rows from the bottom, columns from
  /// the left.
  const std::vector<std::uint8_t>& rgb() const noexcept { return rgb_; }
  int pixels() const noexcept { return pixels_; }

  /// Returns the position of a point in the picture: right and up, m along the world's axes u and
  /// v.
  Eigen::Vector2d project(const Eigen::Vector3d& p_W) const;

  /// Returns whether the mesh is more than `tolerance` (m) in front of the point and of a pixel
  /// around it: a point on a face seen edge-on is not hidden.
  bool hides(const Eigen::Vector3d& p_W, double tolerance) const;

 private:
  struct Corner;
  void draw(const std::array<Corner, 3>& corner);
  void outline();
  void shrink();

  ViewDirection direction_;
  Eigen::Vector2d origin_;  // lower left corner of the window, m
  double pitch_ = 0;        // distance of samples, m
  int samples_ = 0;         // number per side
  int pixels_ = 0;
  std::vector<float> depth_;  // towards the eye, m; -infinity: background
  std::vector<float> shade_;  // 0 black to 1 white
  std::vector<std::uint8_t> rgb_;
};

/// Returns the bounding box of a mesh's vertices; empty for a mesh without vertices.
Eigen::AlignedBox3d box_of(const render::TriangleMesh& mesh);

}  // namespace thimble::report
