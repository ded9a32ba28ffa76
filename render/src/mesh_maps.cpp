#include "mesh_maps.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <vector>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

template <int kSize>
AffineValue<kSize> nothing() {
  AffineValue<kSize> value;
  value.slope.setZero();
  value.offset.setConstant(std::numeric_limits<double>::quiet_NaN());
  return value;
}

// Returns the function with given values at the corners of a triangle; NaN if it has no area.
template <int kSize>
AffineValue<kSize> affine(const std::array<Vector3d, 3>& corners,
                          const std::array<Eigen::Matrix<double, kSize, 1>, 3>& values) {
  const Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vector3d n = ab.cross(ac);
  // The dual basis of the two sides in the plane of the triangle.
  const Vector3d to_b = ac.cross(n) / n.squaredNorm(), to_c = n.cross(ab) / n.squaredNorm();
  AffineValue<kSize> value;
  value.slope =
      (values[1] - values[0]) * to_b.transpose() + (values[2] - values[0]) * to_c.transpose();
  value.offset = values[0] - value.slope * corners[0];
  return value;
}

template <int kSize, class Values>
std::vector<AffineValue<kSize>> functions(std::span<const Vector3d> source_W,
                                          std::span<const std::array<std::int32_t, 3>> triangles,
                                          const Values& values,
                                          std::span<const std::int32_t> origins) {
  std::vector<AffineValue<kSize>> done;
  if (values.empty()) return done;
  done.reserve(origins.size());
  for (const std::int32_t origin : origins) {
    if (origin < 0) {
      done.push_back(nothing<kSize>());
      continue;
    }
    const auto t = static_cast<std::size_t>(origin);
    std::array<Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = source_W[static_cast<std::size_t>(triangles[t][k])];
    }
    done.push_back(affine<kSize>(corners, values[t]));
  }
  return done;
}

}  // namespace

SurfaceMaps surface_maps_of(std::span<const Vector3d> source_W,
                            std::span<const std::array<std::int32_t, 3>> triangles,
                            const MeshAttributes& attributes,
                            std::span<const std::int32_t> origins) {
  SurfaceMaps maps;
  maps.uv = functions<2>(source_W, triangles, attributes.uv, origins);
  maps.colours = functions<3>(source_W, triangles, attributes.colours, origins);
  maps.middles.reserve(origins.size());
  for (const std::int32_t origin : origins) {
    Vector3d middle = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    if (origin >= 0) {
      const auto& [a, b, c] = triangles[static_cast<std::size_t>(origin)];
      middle = (source_W[static_cast<std::size_t>(a)] + source_W[static_cast<std::size_t>(b)] +
                source_W[static_cast<std::size_t>(c)]) /
               3;
    }
    maps.middles.push_back(middle);
  }
  return maps;
}

}  // namespace thimble::render
