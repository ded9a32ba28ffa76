#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "mesh/contact_mesh.h"
#include "thimble/driver/export.h"
#include "thimble/render/body/spring_scheme.h"
#include "thimble/render/contact_choice.h"

namespace thimble::scene {

// Diagrams used by `--quality auto`, measured once by the study. Times are those of the machine
// named in the table. They allow a comparison of points only, not a prediction for the running
// machine. Regenerate with `thimble study accuracy --table FILE`.

/// Contact settings for a triangle mesh of one resolution.
struct ContactPoint {
  render::TrackerChoice tracker;  ///< Tracker.
  /// Blending of the normal; empty: that of the tracker.
  std::optional<render::BlendingChoice> blending;
  std::optional<bool> curved_depth;  ///< Kind of depth; empty: that of the tracker.
  double turn;                       ///< typical_turn of the mesh, rad.
  /// Largest error of force, direction and jump, each relative to its limit of perception.
  double error;
  double ns;  ///< Median duration of a tick, ns.
};

/// Size of a dent's patch.
struct RingsPoint {
  int rings;
  double error;  ///< Error of the force relative to its limit of perception.
  double ns;     ///< Median duration of a tick with implicit Euler in one step, ns.
};

/// Integration of a dent.
struct StepsPoint {
  render::SpringScheme integrator;
  int substeps;
  double error;  ///< Error of the motion relative to its limit of perception.
  double cost;   ///< Duration of a tick relative to that of implicit Euler in one step.
};

/// Stored set of diagrams.
struct QualityTable {
  int version;                ///< Version; incremented with each new measurement.
  std::string_view measured;  ///< Machine and build of the measurement.
  std::span<const ContactPoint> contacts;
  std::span<const RingsPoint> rings;
  std::span<const StepsPoint> steps;
};

/// Returns the built-in table. Real-time: safe.
THIMBLE_EXPORT const QualityTable& quality_table();

/// Returns the typical angle (rad) between adjacent triangles of a mesh: the 90th percentile over
/// all edges except creases; 0 if all are creases. It is about the length of the edges over the
/// radius of curvature. Real-time: never from the servo thread.
THIMBLE_EXPORT double typical_turn(const render::ContactMesh& mesh);

}  // namespace thimble::scene
