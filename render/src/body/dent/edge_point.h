#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "thimble/render/body/dent_settings.h"

namespace thimble::render {

/// A point that splits an edge of the touched triangle [BP 4.2, Fig. 6]. Its base point is the
/// cursor's projection onto the edge; it hangs by a spring and a damper on the edge as that stands
/// now, and by others on the cursor.
///
///        c  cursor's displacement             s = 2 wa wb / (2 wa wb + wo)
///        |  K s / (1 - s)                     wa, wb: the cursor's weights at the edge's ends,
///        o  edge point: chord + y             wo: at the corner opposite of it
///        |  K (1 - s) / s
///     ---x--- chord: (1 - t) u_a + t u_b
///
/// On its own edge s = 1: it is where the cursor is, whatever it weighs. On the other two edges
/// s = 0: it lies on the edge, so that the surface is the same whether it is there or not, and
/// nothing jumps when the cursor crosses over and it goes. The 2 is the factor at which the dent
/// is most alike beside the cursor wherever that is (within 3 %; 4 % with 4, 6 % with 1). Edge
/// points load no vertex: they are light, as points in the middle of an edge without matter are.
class EdgePoint {
 public:
  /// What moves the edge point in one step.
  struct Pull {
    double share = 0;                 ///< s, 0 to 1
    double place = 0.5;               ///< t, of the base point between the ends, 0 to 1
    Eigen::Vector3d cursor{0, 0, 0};  ///< c, m
    Eigen::Vector3d from{0, 0, 0};    ///< u_a, m
    Eigen::Vector3d to{0, 0, 0};      ///< u_b, m
  };

  /// Lets it split the edge between two vertices, on the edge and at rest. Real-time: safe.
  void begin(std::int32_t from, std::int32_t to) noexcept;
  /// Returns whether it splits the edge between these vertices, in either direction.
  bool splits(std::int32_t a, std::int32_t b) const noexcept {
    return (a == from_ && b == to_) || (a == to_ && b == from_);
  }
  /// Goes over to the triangle on the other side, whose corners run the other way.
  void turn(std::int32_t from, std::int32_t to) noexcept {
    from_ = from;
    to_ = to;
  }

  /// Moves on by `step` s; `stiffness` (N/m) is that of a vertex. Unconditionally stable; NaN puts
  /// it onto the edge. Real-time: safe.
  void step(const Pull& pull, const DentSettings& settings, double stiffness) noexcept;

  /// Returns the displacement from the base point, m.
  const Eigen::Vector3d& u() const noexcept { return u_; }
  double place() const noexcept { return place_; }  ///< Returns the same, m.

 private:
  std::int32_t from_ = -1, to_ = -1;
  double place_ = 0.5;
  bool pulled_ = false;
  Eigen::Vector3d y_{0, 0, 0};  // off the chord, m
  Eigen::Vector3d v_{0, 0, 0};
  Eigen::Vector3d gap_{0, 0, 0};  // from the chord to the cursor, as of the last step
  Eigen::Vector3d u_{0, 0, 0};
};

}  // namespace thimble::render
