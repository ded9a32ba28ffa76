#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "view/drawn_scene.h"

namespace thimble::view {

/// The last minute of a run as it was drawn, to look back while it goes on. The viewer keeps it by
/// itself; the run knows nothing of it. Memory is bounded: where moments are large, fewer seconds
/// are kept. Real-time: never from the servo thread.
class MomentRing {
 public:
  static constexpr double kSeconds = 60;     ///< That are kept, of the run's time.
  static constexpr double kStep = 1.0 / 30;  ///< Between two moments at least, s. [chosen]
  static constexpr std::size_t kBytesMost = 64'000'000;  ///< Of all moments. [chosen]
  /// Between two new shapes of an object at least, s: a shape is a whole mesh. [chosen]
  static constexpr double kShapeStep = 0.5;

  /// Keeps a moment if it is time for one. One that is older than the last begins anew: it is of
  /// another run.
  void keep(const DrawnMoment& moment);
  void clear();

  /// Brings `moment` to the newest that is no later than `time` (s of the run), to the oldest if
  /// there is none. Returns false, and changes nothing, if nothing is kept.
  bool show(double time, DrawnMoment& moment) const;

  /// Returns when the moment was that is `steps` after the one shown at `time`, s; that of the
  /// oldest or the newest if there is none. Precondition: not empty.
  double beside(double time, int steps) const;

  /// Returns the times of the oldest and the newest moment, s. Precondition: not empty.
  double oldest() const { return kept_.front().time; }
  double newest() const { return kept_.back().time; }
  bool empty() const { return kept_.empty(); }
  std::size_t moments() const { return kept_.size(); }
  /// Returns how much memory the moments take, bytes.
  std::size_t bytes() const { return bytes_; }

 private:
  /// A moment with no more of its dent than there is.
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
  double shapes_time_ = -1e300;  // when shapes were taken last, s
};

}  // namespace thimble::view
