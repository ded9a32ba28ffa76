#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "mesh/contact_mesh.h"
#include "thimble/driver/export.h"
#include "thimble/render/body/spring_scheme.h"
#include "thimble/render/contact_choice.h"

namespace thimble::scene {

// The diagrams that `--quality auto` chooses on, as the study measured them once. Times are those
// of the machine that the table names: they compare points with each other, and say nothing of the
// machine that runs. Made anew by `thimble study accuracy --table FILE`.

/// One way to touch a triangle mesh, cut to one fineness.
struct ContactPoint {
  render::TrackerChoice tracker;                   ///< How it is followed.
  std::optional<render::BlendingChoice> blending;  ///< Which normal; empty: as the tracker has it.
  std::optional<bool> curved_depth;                ///< Which depth; empty: as the tracker has it.
  double turn;                                     ///< typical_turn of the mesh, rad.
  double error;  ///< Worst of force, direction and jump, each over what can be felt of it.
  double ns;     ///< Of a tick, median.
};

/// One size of a dent's patch.
struct RingsPoint {
  int rings;
  double error;  ///< Of the force, over what can be felt.
  double ns;     ///< Of a tick with implicit Euler in one step, median.
};

/// One way to step a dent.
struct StepsPoint {
  render::SpringScheme integrator;
  int substeps;
  double error;  ///< Of the motion, over what can be felt.
  double cost;   ///< Of a tick, over that of implicit Euler in one step.
};

/// One stored set of diagrams.
struct QualityTable {
  int version;                ///< Grows whenever it is measured anew.
  std::string_view measured;  ///< On which machine, and by which build.
  std::span<const ContactPoint> contacts;
  std::span<const RingsPoint> rings;
  std::span<const StepsPoint> steps;
};

/// Returns the table that is built in. Real-time: safe.
THIMBLE_EXPORT const QualityTable& quality_table();

/// Returns the angle (rad) by which the faces of a mesh turn over an edge: that of nine edges in
/// ten, of those that are no creases; 0 if all are. It is about the edges' length over the radius
/// of curvature. Real-time: never from the servo thread.
THIMBLE_EXPORT double typical_turn(const render::ContactMesh& mesh);

}  // namespace thimble::scene
