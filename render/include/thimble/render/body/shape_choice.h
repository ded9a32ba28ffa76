#pragma once

#include <limits>
#include <optional>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

struct SnapSettings;

/// Sets how an object keeps what it gave way [BP 4.3].
struct THIMBLE_EXPORT ClayChoice {
  double yield_force = 1;  ///< N, >= 0: what presses harder moves the base points.
  /// m/s, > 0: how fast they flow at most [BP 4.3: the time variable made small].
  double flow_rate = std::numeric_limits<double>::infinity();
  /// m, >= 0: how far a base point may go from its first place in all [BP 4.3: limiting to some
  /// degree their movement].
  double movement_limit = std::numeric_limits<double>::infinity();
  double radius = 5e-3;  ///< m, > 0: of the print that a press leaves.
  /// m: triangles under a print are split until no edge is longer, a sixteenth of the radius at
  /// least; 0: never, and the print is as fine as the mesh.
  double edge = 0;
  /// Whether what is pressed away goes to a rim around the print, so that the volume stays.
  bool keeps_volume = false;
  int triangles = 20000;  ///< Up to how many triangles the mesh grows by that.

  static constexpr int kTrianglesMax = 1000000;  ///< Most triangles of a mesh that grows.

  /// Reads the settings of a scene. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
  /// Returns what about the settings is beyond all sense. Real-time: never from the servo thread.
  driver::Result<void> check() const;
};

/// Sets how the wall of an object snaps [BP 4.3, the tin can].
struct THIMBLE_EXPORT SnapChoice {
  double force = 3;       ///< N, > 0: past it the wall jumps.
  double depth = 6e-3;    ///< m, > 0: how far in its second shape lies.
  double radius = 15e-3;  ///< m, > 0: of the panel that goes in together; more than half the depth.
  double speed = 1;       ///< m/s, > 0: how fast it runs at most.
  int panels = 8;         ///< 1 to kPanelsMax: how many may be in at the same time.

  static constexpr int kPanelsMax = 16;  ///< Most panels of an object.

  /// Reads the settings of a scene. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
  /// Returns what about the settings is beyond all sense. Real-time: never from the servo thread.
  driver::Result<void> check() const;
  /// Returns the truss whose limit load is `force`.
  SnapSettings truss() const;
};

/// Sets how the base points of an object move by themselves; what is left empty does not happen.
struct ShapeChoice {
  std::optional<ClayChoice> clay{};  ///< Clay, if it is.
  std::optional<SnapChoice> snap{};  ///< Panels that snap, if any.
  double step = 1e-3;                ///< s, > 0: the loop's period

  bool named() const { return clay || snap; }  ///< Returns whether it is any.
};

}  // namespace thimble::render
