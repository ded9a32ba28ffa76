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

/// The dents of a run as they were drawn (session::DentRecord), as many as there is room for. All
/// memory is there and touched when it is made.
class THIMBLE_EXPORT DentTrace final : public session::TickObserver {
 public:
  /// Room for pictures, and for the points and triangles of all of them: 2.1 MB. [chosen]
  static constexpr std::size_t kFramesMost = 8192;
  static constexpr std::size_t kPointsMost = 40'000;     ///< As above.
  static constexpr std::size_t kTrianglesMost = 60'000;  ///< As above.

  /// One dent: a part of the points and of the triangles. Without triangles nothing is dented from
  /// then on.
  struct Frame {
    std::int64_t time_ns = 0;     ///< On the loop's clock.
    std::int16_t object = -1;     ///< Of the scene.
    std::uint32_t point = 0;      ///< Its first.
    std::uint32_t triangle = 0;   ///< Its first.
    std::uint16_t points = 0;     ///< How many it has.
    std::uint16_t triangles = 0;  ///< How many it has.
  };

  /// Keeps what is drawn into `drawn`, which an observer before this one brings up to each tick
  /// and which must outlive it. Real-time: never from the servo thread.
  explicit DentTrace(const DrawnDent& drawn);

  /// Keeps a dent that was drawn anew. Once there is no room for more, only every other picture
  /// stays, and from then on they are kept half as often.
  /// Real-time: safe; in the tick without room it moves its memory once, some 100 us.
  void take(const driver::TickRecord& tick) noexcept override;

  std::span<const Frame> frames() const noexcept { return {frames_.data(), frame_count_}; }
  /// Returns the points of all dents, in the frame of their object's mesh, m.
  std::span<const std::array<float, 3>> points() const noexcept {
    return {points_.data(), point_count_};
  }
  /// Returns which vertex of the object's mesh each of them is (render::BodyPatch::Point::vertex).
  std::span<const std::int32_t> vertices() const noexcept {
    return {vertices_.data(), point_count_};
  }
  /// Returns their normals (render::BodyPatch::Point::n), 32767 for 1.
  std::span<const std::array<std::int16_t, 3>> normals() const noexcept {
    return {normals_.data(), point_count_};
  }
  /// Returns the corners of all triangles: numbers of points, from the dent's first.
  std::span<const std::array<std::uint16_t, 3>> triangles() const noexcept {
    return {triangles_.data(), triangle_count_};
  }
  /// Returns which triangle of the object's mesh each of `triangles` stands for, or is a part of.
  std::span<const std::uint32_t> sources() const noexcept {
    return {sources_.data(), triangle_count_};
  }

 private:
  bool has_room(const render::BodyPatch& patch) const noexcept;
  void halve() noexcept;

  const DrawnDent& drawn_;
  std::uint64_t drawings_;
  std::uint64_t every_ = 1;  // of the drawings that show a dent
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
