#include "observers/dent_trace.h"

#include <algorithm>

namespace thimble::session {

DentTrace::DentTrace(const DrawnDent& drawn)
    : drawn_(drawn),
      drawings_(drawn.drawings),
      frames_(kFramesMax),
      points_(kPointsMax),
      vertices_(kPointsMax),
      normals_(kPointsMax),
      triangles_(kTrianglesMax),
      sources_(kTrianglesMax) {}

bool DentTrace::has_room(const render::BodyPatch& patch) const noexcept {
  return frame_count_ < kFramesMax && point_count_ + patch.point_count <= kPointsMax &&
         triangle_count_ + patch.triangle_count <= kTrianglesMax;
}

void DentTrace::take(const driver::TickRecord& tick) noexcept {
  if (drawn_.drawings == drawings_) return;
  drawings_ = drawn_.drawings;
  const render::BodyPatch& patch = drawn_.patch;
  const bool was_dented = frame_count_ > 0 && frames_[frame_count_ - 1].triangles > 0;
  if (patch.triangle_count == 0 && !was_dented) return;
  // The end of a dent is always stored.
  if (patch.triangle_count > 0 && until_next_ > 0) {
    --until_next_;
    return;
  }
  until_next_ = every_ - 1;
  if (!has_room(patch)) halve();
  if (!has_room(patch)) return;
  Frame& frame = frames_[frame_count_++];
  frame = {.time_ns = tick.time_ns,
           .object = patch.object,
           .point = static_cast<std::uint32_t>(point_count_),
           .triangle = static_cast<std::uint32_t>(triangle_count_),
           .points = patch.triangle_count > 0 ? patch.point_count : std::uint16_t{0},
           .triangles = patch.triangle_count};
  for (std::size_t i = 0; i < frame.points; ++i) {
    const auto& p = patch.points[i].p;
    points_[point_count_] = {static_cast<float>(p[0]), static_cast<float>(p[1]),
                             static_cast<float>(p[2])};
    vertices_[point_count_] = patch.points[i].vertex;
    for (std::size_t k = 0; k < 3; ++k) {
      const float n = std::clamp(patch.points[i].n[k], -1.0F, 1.0F);
      normals_[point_count_][k] = static_cast<std::int16_t>(32767 * n);
    }
    ++point_count_;
  }
  for (std::size_t i = 0; i < frame.triangles; ++i, ++triangle_count_) {
    triangles_[triangle_count_] = patch.triangles[i];
    sources_[triangle_count_] = static_cast<std::uint32_t>(patch.source[i]);
  }
}

void DentTrace::halve() noexcept {
  std::size_t stays = 0, point = 0, triangle = 0;
  bool goes = false;
  for (std::size_t i = 0; i < frame_count_; ++i) {
    Frame frame = frames_[i];
    // Keeps the ends of dents; otherwise a dent would remain visible after its end.
    if (frame.triangles > 0) {
      goes = !goes;
      if (!goes) continue;
    }
    std::copy_n(points_.begin() + frame.point, frame.points,
                points_.begin() + static_cast<std::ptrdiff_t>(point));
    std::copy_n(vertices_.begin() + frame.point, frame.points,
                vertices_.begin() + static_cast<std::ptrdiff_t>(point));
    std::copy_n(normals_.begin() + frame.point, frame.points,
                normals_.begin() + static_cast<std::ptrdiff_t>(point));
    std::copy_n(triangles_.begin() + frame.triangle, frame.triangles,
                triangles_.begin() + static_cast<std::ptrdiff_t>(triangle));
    std::copy_n(sources_.begin() + frame.triangle, frame.triangles,
                sources_.begin() + static_cast<std::ptrdiff_t>(triangle));
    frame.point = static_cast<std::uint32_t>(point);
    frame.triangle = static_cast<std::uint32_t>(triangle);
    point += frame.points;
    triangle += frame.triangles;
    frames_[stays++] = frame;
  }
  frame_count_ = stays;
  point_count_ = point;
  triangle_count_ = triangle;
  every_ *= 2;
}

}  // namespace thimble::session
