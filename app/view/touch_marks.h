#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "view/drawn_scene.h"
#include "view/gl/solids.h"

namespace thimble::view {

/// A word at a place of the scene.
struct Label {
  Eigen::Vector3d p_W{0, 0, 0};     ///< m
  Eigen::Vector3d away_W{0, 0, 0};  ///< From the place towards where the word has room.
  std::string text;
  Colour colour{};
};

/// A flat four-cornered piece that can be seen through; W, m.
struct Pane {
  std::array<Eigen::Vector3d, 4> corners_W;
  Colour colour{};
};

/// All that is drawn beside the objects: what shows the touch.
struct TouchMarks {
  std::vector<Solid> solids;
  std::vector<Label> labels;
  std::vector<Pane> panes;
};

/// Returns how large a scene's objects are together (m): the diagonal of their box, in sane limits.
double size_of(const DrawnScene& scene);

/// Returns how long the arrow of a force (N) is drawn, m: its limit is as long as half the scene.
double arrow_length(double force, const DrawnScene& scene);

/// Which marks are wanted.
struct MarkChoice {
  bool arm = true;
  bool tip = true;
  bool force = true;
  bool contact = false;      ///< The normal at the touch, and the force along the surface.
  bool edge_planes = false;  ///< The active triangle, and the planes that bound its touch.
};

/// Shows tip, proxy, force and arm. `eye_distance` (m) sets the thickness of what has none by
/// itself. Real-time: never from the servo thread.
TouchMarks mark_touch(const DrawnScene& scene, const DrawnMoment& moment, double eye_distance,
                      const MarkChoice& choice);

}  // namespace thimble::view
