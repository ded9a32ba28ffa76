#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "recording/replay_animation.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::view {

/// Records the permanent shapes of objects during a replay, at intervals. Real-time: never from the
/// servo thread.
class ShapeAnimation final : public session::ReplayAnimation {
 public:
  /// Minimum time between two shapes, ns. [chosen]
  static constexpr std::int64_t kStep_ns = 250'000'000;
  /// Maximum number of shapes of each object. If it is exceeded, every other shape is removed and
  /// the interval doubles. [chosen]
  static constexpr std::size_t kShapesMax = 128;

  using Mesh = std::shared_ptr<const render::TriangleMesh>;

  void begin(const scene::Scene& scene,
             std::shared_ptr<const scene::SceneObjects> objects) override;
  void take(const driver::TickRecord& tick) override;

  /// Returns the permanent shape of an object at a time, ns, in the object's first pose (B, m);
  /// null if it has none.
  Mesh shape_at(std::size_t object, std::int64_t time_ns) const;
  /// Returns whether any object has a permanent shape.
  bool shapes() const { return !shaped_.empty(); }
  /// Returns the time between two shapes, s.
  double step() const { return 1e-9 * static_cast<double>(step_ns_); }

 private:
  struct Shaped {
    std::size_t object;
    std::vector<Mesh> meshes;  // one for each time
  };
  void halve();

  std::vector<Shaped> shaped_;
  std::vector<std::int64_t> times_ns_;
  std::int64_t step_ns_ = kStep_ns;
  std::int64_t next_ns_ = INT64_MIN;
};

}  // namespace thimble::view
