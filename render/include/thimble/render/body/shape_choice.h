#pragma once

#include <limits>
#include <optional>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

struct SnapSettings;

/// Settings of permanent deformation of an object (clay) [BP 4.3].
struct THIMBLE_EXPORT ClayChoice {
  double yield_force = 1;  ///< Force above which the base points move, N, >= 0.
  /// Largest speed of flow, m/s, > 0 [BP 4.3: the time variable made small].
  double flow_rate = std::numeric_limits<double>::infinity();
  /// Largest total displacement of a base point, m, >= 0 [BP 4.3: limiting to some degree their
  /// movement].
  double movement_limit = std::numeric_limits<double>::infinity();
  double radius = 5e-3;  ///< Radius of the print of a press, m, > 0.
  /// Edge length down to which triangles under a print are split, m; at least a sixteenth of the
  /// radius. 0: triangles are not split, and the print is as fine as the mesh.
  double edge = 0;
  /// True if displaced material forms a rim around the print, so that the volume is constant.
  bool keeps_volume = false;
  int triangles = 20000;  ///< Largest number of triangles to which the mesh grows by splitting.

  static constexpr int kTrianglesMax = 1000000;  ///< Upper limit of `triangles`.

  /// Reads the settings from a scene. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
  /// Fails if the settings are invalid. Real-time: never from the servo thread.
  driver::Result<void> check() const;
};

/// Settings of an object whose wall snaps [BP 4.3, the tin can].
struct THIMBLE_EXPORT SnapChoice {
  double force = 3;     ///< Force above which the wall snaps, N, > 0.
  double depth = 6e-3;  ///< Depth of the second stable shape, m, > 0.
  /// Radius of a panel that snaps as a whole, m, > 0; more than half the depth.
  double radius = 15e-3;
  double speed = 1;  ///< Largest speed of the snap, m/s, > 0.
  /// Largest number of panels in the second shape at the same time, 1 to kPanelsMax.
  int panels = 8;

  static constexpr int kPanelsMax = 16;  ///< Largest number of panels of an object.

  /// Reads the settings from a scene. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
  /// Fails if the settings are invalid. Real-time: never from the servo thread.
  driver::Result<void> check() const;
  /// Returns the settings of the truss with the limit load `force`.
  SnapSettings truss() const;
};

/// Deformation of the base points of an object. Empty members are not used.
struct ShapeChoice {
  std::optional<ClayChoice> clay{};  ///< Permanent deformation.
  std::optional<SnapChoice> snap{};  ///< Panels that snap.
  double step = 1e-3;                ///< Period of the loop, s, > 0.

  bool named() const { return clay || snap; }  ///< Returns whether any deformation is set.
};

}  // namespace thimble::render
