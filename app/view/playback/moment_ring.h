#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "view/drawn_scene.h"

namespace thimble::view {

/// The drawn moments of the last minute of a run, for looking back while it continues. Only the
/// viewer keeps them; the run is not affected. Memory is bounded: if moments are large, fewer
/// seconds are kept. Real-time: never from the servo thread.
class MomentRing {
 public:
  static constexpr double kSeconds = 60;     ///< Duration that is kept, in the run's time.
  static constexpr double kStep = 1.0 / 30;  ///< Minimum time between two moments, s. [chosen]
  static constexpr std::size_t kBytesMax = 64'000'000;  ///< Maximum size of all moments. [chosen]
  /// Minimum time between two new shapes of an object, s: a shape is a whole mesh. [chosen]
  static constexpr double kShapeStep = 0.5;

  /// Keeps a moment if kStep has passed since the last. An older timestamp means a new run, so the
  /// ring is cleared.
  void keep(const DrawnMoment& moment);
  void clear();

  /// Sets `moment` to the newest one that is no later than `time` (s of the run), or to the oldest
  /// if there is none. Returns false, and changes nothing, if the ring is empty.
  bool show(double time, DrawnMoment& moment) const;

  /// Returns the time (s) of the moment `steps` after the one shown at `time`, clamped to the
  /// oldest and the newest. Precondition: not empty.
  double time_of_step(double time, int steps) const;

  /// Returns the times of the oldest and the newest moment, s. Precondition: not empty.
  double oldest() const { return kept_.front().time; }
  double newest() const { return kept_.back().time; }
  bool empty() const { return kept_.empty(); }
  std::size_t moments() const { return kept_.size(); }
  /// Returns the memory of the moments, bytes.
  std::size_t bytes() const { return bytes_; }

 private:
  /// A moment with only the used part of its dent.
  struct Kept {
    double time = 0;  // s
    driver::TickRecord tick;
    std::vector<render::BodyPose> poses;
    std::int16_t object = -1;
    bool complete = true;
    float share = 1;
    std::vector<render::BodyPatch::Point> points;
    std::vector<std::array<std::uint16_t, 3>> triangles;
    std::vector<std::int32_t> sources;
    std::vector<DrawnRod> arm;
    std::vector<DrawnArm> others;
    std::vector<std::shared_ptr<const render::TriangleMesh>> shapes;
    std::size_t bytes = 0;
  };
  static std::size_t size_of(const Kept& kept);
  void take_shapes(const DrawnMoment& moment, Kept& kept);
  void drop_oldest();
  std::size_t place_of(double time) const;

  std::deque<Kept> kept_;
  std::size_t bytes_ = 0;
  double shapes_time_ = -1e300;  // time of the last shapes, s
};

}  // namespace thimble::view
