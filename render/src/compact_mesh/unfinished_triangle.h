#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "compact_mesh/packed_surface.h"

namespace thimble::render::unfinished {

// While a surface is built, each packed triangle holds the data that its own are made from, in the
// same 64 bytes. Separate arrays would take 48 bytes per triangle more, and a cache miss each.
//
//     byte 0    12            36       48           60     64
//     | corners | face normal | angles | neighbours | flags |
//
// `x` holds the vertices of the corners, `y` and `z` the normal of the face, `normals` the angles
// at the corners until the packed normals replace them. All functions are Real-time: safe.

/// Returns the numbers of the three vertices.
inline const std::array<std::int32_t, 3>& corners(const PackedTriangle& triangle) noexcept {
  return triangle.x;
}
inline std::array<std::int32_t, 3>& corners(PackedTriangle& triangle) noexcept {
  return triangle.x;
}

inline constexpr std::size_t kFaceNormalAt = offsetof(PackedTriangle, y);
static_assert(offsetof(PackedTriangle, normals) - kFaceNormalAt == 3 * sizeof(double));

/// Returns the unit normal of the face.
inline Eigen::Vector3d face_normal(const PackedTriangle& triangle) noexcept {
  Eigen::Vector3d normal;
  std::memcpy(normal.data(), reinterpret_cast<const std::byte*>(&triangle) + kFaceNormalAt,
              3 * sizeof(double));
  return normal;
}
inline void set_face_normal(PackedTriangle& triangle, const Eigen::Vector3d& normal) noexcept {
  std::memcpy(reinterpret_cast<std::byte*>(&triangle) + kFaceNormalAt, normal.data(),
              3 * sizeof(double));
}

/// Returns the angle at corner `k`, rad. Precondition: the corner has no packed normal yet.
inline float angle(const PackedTriangle& triangle, std::size_t k) noexcept {
  return std::bit_cast<float>(triangle.normals[k]);
}
inline void set_angles(PackedTriangle& triangle, const std::array<float, 3>& angles) noexcept {
  triangle.normals = std::bit_cast<std::array<std::uint32_t, 3>>(angles);
}

}  // namespace thimble::render::unfinished
