#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "body/shape/body_shape.h"
#include "report/html/shape_steps.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/session/tick_observer.h"

namespace thimble::report {

/// How the objects of a run that are shaped for good came to what they were left as, often enough
/// for a film of it. All memory is there and touched when it is made.
class ShapeTrace final : public session::TickObserver {
 public:
  /// Between two pictures, at least, ns. [chosen: a print deepens slowly; 20 a second look smooth]
  static constexpr std::int64_t kStep_ns = 50'000'000;
  /// Pictures, and moves of vertices of all of them: 2 MB. [chosen]
  static constexpr std::size_t kFramesMost = 4096;
  static constexpr std::size_t kMovesMost = 100'000;  ///< As above.

  /// An object that is shaped.
  struct Shaped {
    std::size_t object = 0;                    ///< Of the scene.
    const render::BodyShape* shape = nullptr;  ///< Must outlive the trace.
    std::size_t vertices = 0;                  ///< That its mesh has at first.
  };

  /// Looks at objects before the first tick. Real-time: never from the servo thread.
  explicit ShapeTrace(std::vector<Shaped> shaped);

  /// Keeps which vertices have moved, and where they are when it is time for a picture. Once there
  /// is no room for more, two pictures become one each, and from then on they are taken half as
  /// often. Real-time: safe; in the tick without room it moves its memory once, some 100 us.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Returns what led from picture to picture, in s from `begin_ns` on the loop's clock; `first`
  /// are the meshes of the shaped objects before the first tick, in their order. After the last
  /// tick. Real-time: never from the servo thread.
  std::vector<ShapeStep> steps(std::vector<render::TriangleMesh> first, std::int64_t begin_ns);

  /// Returns how many pictures there are.
  std::size_t frames() const noexcept { return frame_count_; }
  /// Returns the objects that it looks at.
  std::span<const Shaped> shaped() const noexcept { return shaped_; }

 private:
  /// A place of a vertex from then on; `vertex` counts through all shaped objects.
  struct Move {
    std::uint32_t vertex = 0;
    std::array<float, 3> place{};
  };
  struct Frame {
    std::int64_t time_ns = 0;
    std::size_t moves_end = 0;
    std::size_t splits_end = 0;
  };
  struct Split {
    std::size_t shaped = 0;
    render::EdgeSplit split;
  };

  void mark(std::uint32_t vertex) noexcept;
  void keep(std::int64_t time_ns) noexcept;
  void halve() noexcept;
  std::size_t owner(std::uint32_t vertex) const noexcept;

  std::vector<Shaped> shaped_;
  std::vector<std::uint32_t> first_;       // vertex of each, through all; one more at the end
  std::vector<std::size_t> vertices_now_;  // of each
  std::vector<std::uint8_t> marked_;       // of each vertex
  std::vector<std::uint32_t> waiting_;     // those marked
  std::size_t waiting_count_ = 0;
  std::vector<Frame> frames_;
  std::size_t frame_count_ = 0;
  std::vector<Move> moves_;
  std::size_t move_count_ = 0;
  std::vector<Split> splits_;
  std::size_t split_count_ = 0;
  std::int64_t step_ns_ = kStep_ns;
  std::int64_t next_ns_ = INT64_MIN;
  std::int64_t newest_ns_ = 0;
};

}  // namespace thimble::report
