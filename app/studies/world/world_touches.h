#pragma once

#include <Eigen/Core>
#include <vector>

namespace thimble::studies {

/// One tick of a touch, in W.
struct WorldTick {
  Eigen::Vector3d p_WT{0, 0, 0};   ///< Tip, m.
  Eigen::Vector3d p_WP{0, 0, 0};   ///< Proxy, m; the tip if nothing is touched.
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Force on the hand, N.
};

/// One touch of two objects, as both laws give it.
struct ComparedTouch {
  std::vector<WorldTick> alone;     ///< Each object with its own proxy, forces added.
  std::vector<WorldTick> together;  ///< One proxy for all objects.
};

inline constexpr double kWorldStiffness = 800;  ///< N/m, as the scenes of the guide.

inline constexpr double kSeamDepth = 0.8e-3;  ///< m
inline constexpr double kSeamHalfWay = 4e-3;  ///< m of the slide on each side of the seam.
/// Slides a tip at a depth of kSeamDepth over a floor of two flush boxes that meet at x = 0; the
/// floor is z = 0. The first row is the first of the slide.
ComparedTouch slide_over_seam();

inline constexpr double kBlockHeight = 6e-3;  ///< m
/// Pulls a tip by a spring over a table, z = 0, against a block from x = 0 on. The rows begin above
/// the table.
ComparedTouch slide_against_block();

inline constexpr double kGrooveRadius = 4e-3;                ///< m, of the tip that is a ball.
inline constexpr double kGrooveHalfAngle = 0.5235987755983;  ///< rad, 30 degrees.
inline constexpr double kGrooveDepth = 12e-3;                ///< m
/// Presses a tip with a radius (0: a point) into a groove along y with its bottom at the origin, to
/// kGroovePress below the place where it rests. The tip ends beside the middle plane.
std::vector<WorldTick> press_into_groove(double tip_radius);
inline constexpr double kGroovePress = 2e-3;  ///< m

/// All touches of the study.
struct WorldTouches {
  ComparedTouch seam, block;
  std::vector<WorldTick> point, ball;  ///< In the groove.
};

}  // namespace thimble::studies
