#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "recording/replay_film.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::view {

/// The film of a replay with the shapes that objects were left in for good, now and then.
/// Real-time: never from the servo thread.
class ShapeFilm final : public session::ReplayFilm {
 public:
  /// Between two shapes at least, ns. [chosen]
  static constexpr std::int64_t kStep_ns = 250'000'000;
  /// Shapes of each object: once there are more, every other goes and they are taken half as often.
  /// [chosen]
  static constexpr std::size_t kShapesMost = 128;

  using Mesh = std::shared_ptr<const render::TriangleMesh>;

  void begin(const scene::Scene& scene,
             std::shared_ptr<const scene::SceneObjects> objects) override;
  void take(const driver::TickRecord& tick) override;

  /// Returns what an object had been shaped to at a time, ns, where the object was at first (B, m);
  /// null if it has no shape to be left in.
  Mesh shape_at(std::size_t object, std::int64_t time_ns) const;
  /// Returns whether any object is shaped for good.
  bool shapes() const { return !shaped_.empty(); }
  /// Returns how far apart two shapes are, s.
  double step() const { return 1e-9 * static_cast<double>(step_ns_); }

 private:
  struct Shaped {
    std::size_t object;
    std::vector<Mesh> meshes;  // one for each of the times
  };
  void halve();

  std::vector<Shaped> shaped_;
  std::vector<std::int64_t> times_ns_;
  std::int64_t step_ns_ = kStep_ns;
  std::int64_t next_ns_ = INT64_MIN;
};

}  // namespace thimble::view
