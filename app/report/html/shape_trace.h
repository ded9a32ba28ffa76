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

/// Records how permanently deformed objects changed during a run, at a rate for animation. All
/// memory is allocated and touched by the constructor.
class ShapeTrace final : public session::TickObserver {
 public:
  /// Minimum time between two pictures, ns. [chosen: deformation is slow; 20 a second look smooth]
  static constexpr std::int64_t kStep_ns = 50'000'000;
  /// Maximum number of pictures, and of vertex moves in all of them: 2 MB. [chosen]
  static constexpr std::size_t kFramesMax = 4096;
  static constexpr std::size_t kMovesMax = 100'000;  ///< As above.

  /// A deformed object.
  struct Shaped {
    std::size_t object = 0;                    ///< Index in the scene.
    const render::BodyShape* shape = nullptr;  ///< Must outlive the trace.
    std::size_t vertices = 0;                  ///< Initial number of vertices.
  };

  /// Takes the objects before the first tick. Real-time: never from the servo thread.
  explicit ShapeTrace(std::vector<Shaped> shaped);

  /// Records which vertices have moved, and their positions when a picture is due. If the memory is
  /// full, every two pictures are merged, and the interval doubles. Real-time: safe; the tick that
  /// merges them moves the memory once, some 100 us.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Returns the changes from picture to picture, in s from `begin_ns` on the loop's clock. `first`
  /// are the meshes of the deformed objects before the first tick, in their order. Call after the
  /// last tick. Real-time: never from the servo thread.
  std::vector<ShapeStep> steps(std::vector<render::TriangleMesh> first, std::int64_t begin_ns);

  /// Returns the number of pictures.
  std::size_t frames() const noexcept { return frame_count_; }
  /// Returns the observed objects.
  std::span<const Shaped> shaped() const noexcept { return shaped_; }

 private:
  /// A new position of a vertex; `vertex` is numbered across all deformed objects.
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
  std::vector<std::uint32_t> first_;       // first vertex of each object across all objects, plus
                                           // one past the end
  std::vector<std::size_t> vertices_now_;  // current number of vertices of each object
  std::vector<std::uint8_t> marked_;       // mark of each vertex
  std::vector<std::uint32_t> waiting_;     // the marked vertices
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
