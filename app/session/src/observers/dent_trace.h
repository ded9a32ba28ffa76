#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "drawn_dent.h"
#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Drawn dents of a run (session::DentRecord), as many as memory allows. All memory is allocated
/// and touched by the constructor.
class THIMBLE_EXPORT DentTrace final : public session::TickObserver {
 public:
  /// Largest numbers of frames, points and triangles: 2.1 MB. [chosen]
  static constexpr std::size_t kFramesMax = 8192;
  static constexpr std::size_t kPointsMax = 40'000;     ///< As above.
  static constexpr std::size_t kTrianglesMax = 60'000;  ///< As above.

  /// One dent: a range of the points and of the triangles. Without triangles nothing is dented from
  /// then on.
  struct Frame {
    std::int64_t time_ns = 0;     ///< Time on the loop's clock, ns.
    std::int16_t object = -1;     ///< Object of the scene.
    std::uint32_t point = 0;      ///< Index of the first point.
    std::uint32_t triangle = 0;   ///< Index of the first triangle.
    std::uint16_t points = 0;     ///< Number of points.
    std::uint16_t triangles = 0;  ///< Number of triangles.
  };

  /// Stores the dents in `drawn`, which an earlier observer updates in each tick and which must
  /// outlive it. Real-time: never from the servo thread.
  explicit DentTrace(const DrawnDent& drawn);

  /// Stores a newly drawn dent. When memory is full, every other frame is dropped, and later frames
  /// are stored half as often. Real-time: safe; in the tick without room it moves its memory once,
  /// some 100 us.
  void take(const driver::TickRecord& tick) noexcept override;

  std::span<const Frame> frames() const noexcept { return {frames_.data(), frame_count_}; }
  /// Returns the points of all dents, in the frame of their object's mesh, m.
  std::span<const std::array<float, 3>> points() const noexcept {
    return {points_.data(), point_count_};
  }
  /// Returns the vertex of the object's mesh for each point (render::BodyPatch::Point::vertex).
  std::span<const std::int32_t> vertices() const noexcept {
    return {vertices_.data(), point_count_};
  }
  /// Returns the normals of the points (render::BodyPatch::Point::n), 32767 for 1.
  std::span<const std::array<std::int16_t, 3>> normals() const noexcept {
    return {normals_.data(), point_count_};
  }
  /// Returns the corners of all triangles: point indices relative to the dent's first point.
  std::span<const std::array<std::uint16_t, 3>> triangles() const noexcept {
    return {triangles_.data(), triangle_count_};
  }
  /// Returns the triangle of the object's mesh to which each of `triangles` belongs.
  std::span<const std::uint32_t> sources() const noexcept {
    return {sources_.data(), triangle_count_};
  }

 private:
  bool has_room(const render::BodyPatch& patch) const noexcept;
  void halve() noexcept;

  const DrawnDent& drawn_;
  std::uint64_t drawings_;
  std::uint64_t every_ = 1;  // Stride over the drawings that show a dent.
  std::uint64_t until_next_ = 0;
  std::vector<Frame> frames_;
  std::vector<std::array<float, 3>> points_;
  std::vector<std::int32_t> vertices_;
  std::vector<std::array<std::int16_t, 3>> normals_;
  std::vector<std::array<std::uint16_t, 3>> triangles_;
  std::vector<std::uint32_t> sources_;
  std::size_t frame_count_ = 0, point_count_ = 0, triangle_count_ = 0;
};

}  // namespace thimble::session
