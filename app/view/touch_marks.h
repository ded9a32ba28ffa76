#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "view/drawn_scene.h"
#include "view/gl/solids.h"

namespace thimble::view {

/// A text at a place of the scene.
struct Label {
  Eigen::Vector3d p_W{0, 0, 0};     ///< m
  Eigen::Vector3d away_W{0, 0, 0};  ///< Direction in which there is room for the text.
  std::string text;
  Colour colour{};
};

/// A flat translucent quadrilateral; W, m.
struct Pane {
  std::array<Eigen::Vector3d, 4> corners_W;
  Colour colour{};
};

/// Everything that is drawn in addition to the objects to show the touch.
struct TouchMarks {
  std::vector<Solid> solids;
  std::vector<Label> labels;
  std::vector<Pane> panes;
};

/// Returns the size of a scene's objects together (m): the diagonal of their box, clamped.
double size_of(const DrawnScene& scene);

/// Returns the length of the arrow of a force (N), m: the force limit is drawn as half the scene's
/// size.
double arrow_length(double force, const DrawnScene& scene);

/// The chosen marks.
struct MarkChoice {
  bool arm = true;
  bool tip = true;
  bool force = true;
  bool contact = false;      ///< The contact normal, and the tangential force.
  bool edge_planes = false;  ///< The active triangle, and the planes that bound its contact.
};

/// Returns the marks for tip, proxy, force and arm. `eye_distance` (m) sets the thickness of marks
/// without a physical size. Real-time: never from the servo thread.
TouchMarks mark_touch(const DrawnScene& scene, const DrawnMoment& moment, double eye_distance,
                      const MarkChoice& choice);

}  // namespace thimble::view
